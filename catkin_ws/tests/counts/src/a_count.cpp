// SPDX-License-Identifier: BSD-3-Clause
// Prints a message of the package's own type. The twin of print_count.py.

#include <iostream>

#include <counts/Count.h>

int main()
{
  counts::Count count;
  count.counter = 7;
  std::cout << count;
}
