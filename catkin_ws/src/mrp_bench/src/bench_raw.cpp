// SPDX-License-Identifier: BSD-3-Clause
// The limit: messages in ROS's framing (a length of four bytes, then the message) over one TCP
// connection, with nothing in between. Arguments: "send" or "receive", the connection's file
// descriptor, the size of a message in bytes, the rate, and the number of messages.

#include <mrp_bench/program.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

namespace
{
const size_t LENGTH_SIZE = 4;

void send(int connection, size_t size, double rate, int count)
{
  std::vector<char> frame(LENGTH_SIZE + size);
  const uint32_t length = size;
  memcpy(frame.data(), &length, LENGTH_SIZE);
  const int64_t cpu = mrp_bench::now(CLOCK_PROCESS_CPUTIME_ID);
  mrp_bench::sendAll(count, rate,
                     [&](int64_t stamp)
                     {
                       memcpy(frame.data() + LENGTH_SIZE, &stamp, sizeof(stamp));
                       for (size_t sent = 0; sent < frame.size();)
                       {
                         const ssize_t written =
                             write(connection, frame.data() + sent, frame.size() - sent);
                         if (written <= 0)
                         {
                           perror("write");
                           std::exit(1);
                         }
                         sent += written;
                       }
                     });
  mrp_bench::waitForReceivers();
  std::cout << mrp_bench::now(CLOCK_PROCESS_CPUTIME_ID) - cpu << std::endl;
}

void receive(int connection, size_t size, int count)
{
  mrp_bench::Samples samples(count);
  const size_t frame_size = LENGTH_SIZE + size;
  std::vector<char> buffer(std::max<size_t>(frame_size, 1 << 16));
  size_t filled = 0;
  while (!samples.full())
  {
    const ssize_t received = read(connection, buffer.data() + filled, buffer.size() - filled);
    if (received <= 0)
    {
      perror("read");
      std::exit(1);
    }
    const int64_t arrival = mrp_bench::now();
    filled += received;
    size_t begin = 0;
    for (; filled - begin >= frame_size; begin += frame_size)
    {
      int64_t stamp;
      memcpy(&stamp, buffer.data() + begin + LENGTH_SIZE, sizeof(stamp));
      samples.add(stamp, arrival);
    }
    memmove(buffer.data(), buffer.data() + begin, filled - begin);
    filled -= begin;
  }
  std::cout << samples.cpu() << "\n";
  samples.print();
}
}  // namespace

int main(int argc, char* argv[])
{
  if (argc != 6)
  {
    return 2;
  }
  const int connection = std::atoi(argv[2]);
  const size_t size = std::atoi(argv[3]);
  const int count = std::atoi(argv[5]);
  if (std::string(argv[1]) == "send")
  {
    send(connection, size, std::atof(argv[4]), count);
  }
  else
  {
    receive(connection, size, count);
  }
  return 0;
}
