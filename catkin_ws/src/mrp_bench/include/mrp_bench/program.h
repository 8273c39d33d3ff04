// SPDX-License-Identifier: BSD-3-Clause
// What all measured programs have in common; src/mrp_bench/program.py is the same in Python, and
// src/mrp_bench/programs.py starts them.
//
// Each line of stdin is an order to the sender: "run SIZE RATE COUNT" sends COUNT messages of SIZE
// bytes, RATE per second (0: as fast as it goes); "end" sends the stamp 0, on which the receiver
// answers. An answer is a line "WORD NUMBER" and that many 64 bit numbers.

#pragma once

#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace mrp_bench
{
// Nanoseconds; the same clock in all processes of a machine, and nobody sets it.
inline int64_t now()
{
  timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * INT64_C(1000000000) + time.tv_nsec;
}

inline void sleepUntil(int64_t moment)
{
  const timespec time = {moment / 1000000000, moment % 1000000000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

// The arguments NAME=NUMBER of a program.
class Options
{
public:
  Options(int argc, char* argv[]) : arguments_(argv + 1, argv + argc)
  {
  }

  int number(const std::string& name, int value_if_not_there) const
  {
    for (const std::string& argument : arguments_)
    {
      if (argument.compare(0, name.size() + 1, name + "=") == 0)
      {
        return std::atoi(argument.c_str() + name.size() + 1);
      }
    }
    return value_if_not_there;
  }

private:
  std::vector<std::string> arguments_;
};

// Takes stdout for the answers alone: all else that is printed goes to stderr.
class Answers
{
public:
  Answers() : file_(dup(STDOUT_FILENO))
  {
    dup2(STDERR_FILENO, STDOUT_FILENO);
  }

  void write(const std::string& word, const std::vector<int64_t>& numbers = {})
  {
    const std::string line = word + " " + std::to_string(numbers.size()) + "\n";
    writeAll(line.data(), line.size());
    writeAll(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(int64_t));
  }

private:
  void writeAll(const char* data, size_t size)
  {
    while (size > 0)
    {
      const ssize_t written = ::write(file_, data, size);
      if (written <= 0)
      {
        std::exit(1);  // nobody reads any more
      }
      data += written;
      size -= written;
    }
  }

  int file_;
};

// What a receiver has: pairs of the stamp of a message, and the time at which it arrived.
class Samples
{
public:
  explicit Samples(Answers& answers) : answers_(answers)
  {
    samples_.reserve(1 << 20);
  }

  void add(int64_t stamp, int64_t arrival)
  {
    if (stamp != 0)
    {
      samples_.push_back(stamp);
      samples_.push_back(arrival);
      return;
    }
    answers_.write("received", samples_);
    samples_.clear();
  }

private:
  Answers& answers_;
  std::vector<int64_t> samples_;
};

// Does what stdin says, to its end. The sender has the functions resize(size), next(), which makes
// ready what does not belong to sending, and send(stamp).
template <class Sender>
void obey(Sender& sender, Answers& answers)
{
  std::string line;
  while (std::getline(std::cin, line))
  {
    std::istringstream words(line);
    std::string word;
    size_t size = 0;
    double rate = 0;
    int count = 0;
    words >> word >> size >> rate >> count;
    if (word == "end")
    {
      sender.next();
      sender.send(0);
      continue;
    }
    sender.resize(size);
    std::vector<int64_t> stamps;
    stamps.reserve(count);
    const int64_t start = now();
    for (int i = 0; i < count; ++i)
    {
      sender.next();
      if (rate > 0)
      {
        sleepUntil(start + static_cast<int64_t>(i * 1e9 / rate));
      }
      stamps.push_back(now());
      sender.send(stamps.back());
    }
    answers.write("sent", stamps);
  }
}
}  // namespace mrp_bench
