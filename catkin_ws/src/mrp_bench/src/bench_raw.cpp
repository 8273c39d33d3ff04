// SPDX-License-Identifier: BSD-3-Clause
// The limit: messages in ROS's framing (a length of four bytes, then the message) over one TCP
// connection, with nothing in between. Arguments: send=PORT or receive=1.

#include <arpa/inet.h>
#include <mrp_bench/program.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <vector>

using mrp_bench::Answers;

namespace
{
const size_t LENGTH_SIZE = 4;
const size_t STAMP_SIZE = 8;

[[noreturn]] void fail(const char* what)
{
  perror(what);
  std::exit(1);
}

sockaddr_in loopback(int port)
{
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

class RawSender
{
public:
  explicit RawSender(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0))
  {
    const sockaddr_in address = loopback(port);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    {
      fail("connect");
    }
    const int yes = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
    resize(STAMP_SIZE);
  }

  void resize(size_t size)
  {
    frame_.assign(LENGTH_SIZE + size, 0);
    const uint32_t length = size;
    memcpy(frame_.data(), &length, LENGTH_SIZE);
  }

  void next()
  {
  }

  void send(int64_t stamp)
  {
    memcpy(frame_.data() + LENGTH_SIZE, &stamp, STAMP_SIZE);
    for (size_t sent = 0; sent < frame_.size();)
    {
      const ssize_t written = write(socket_, frame_.data() + sent, frame_.size() - sent);
      if (written <= 0)
      {
        fail("write");
      }
      sent += written;
    }
  }

private:
  int socket_;
  std::vector<char> frame_;
};

void receive(Answers& answers)
{
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(0);
  socklen_t address_size = sizeof(address);
  if (bind(listener, reinterpret_cast<sockaddr*>(&address), address_size) != 0 ||
      listen(listener, 1) != 0 ||
      getsockname(listener, reinterpret_cast<sockaddr*>(&address), &address_size) != 0)
  {
    fail("listen");
  }
  answers.write("port", {ntohs(address.sin_port)});
  const int connection = accept(listener, nullptr, nullptr);

  mrp_bench::Samples samples(answers);
  std::vector<char> buffer(1 << 16);
  size_t filled = 0;
  while (true)
  {
    const ssize_t received = read(connection, buffer.data() + filled, buffer.size() - filled);
    if (received <= 0)
    {
      return;
    }
    const int64_t arrival = mrp_bench::now();
    filled += received;
    size_t begin = 0;
    while (filled - begin >= LENGTH_SIZE)
    {
      uint32_t length;
      memcpy(&length, buffer.data() + begin, LENGTH_SIZE);
      const size_t end = begin + LENGTH_SIZE + length;
      if (end > filled)
      {
        buffer.resize(std::max(buffer.size(), LENGTH_SIZE + length));
        break;
      }
      int64_t stamp;
      memcpy(&stamp, buffer.data() + begin + LENGTH_SIZE, STAMP_SIZE);
      samples.add(stamp, arrival);
      begin = end;
    }
    std::copy(buffer.begin() + begin, buffer.begin() + filled, buffer.begin());
    filled -= begin;
  }
}
}  // namespace

int main(int argc, char* argv[])
{
  const mrp_bench::Options options(argc, argv);
  Answers answers;
  if (options.number("receive", 0) != 0)
  {
    receive(answers);
    return 0;
  }
  RawSender sender(options.number("send", 0));
  answers.write("ready");
  mrp_bench::obey(sender, answers);
  return 0;
}
