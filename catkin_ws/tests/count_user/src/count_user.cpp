// SPDX-License-Identifier: BSD-3-Clause
// Prints a message of a type that another package generates. The twin of count_user.py.

#include <iostream>

#include <mrp_labs/Count.h>

int main()
{
  mrp_labs::Count count;
  count.counter = 7;
  count.language = "any";
  std::cout << "counter: " << count.counter << "\nlanguage: " << count.language
            << "\nmd5sum: " << ros::message_traits::md5sum(count) << std::endl;
  return 0;
}
