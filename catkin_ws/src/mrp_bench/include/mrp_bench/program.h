// SPDX-License-Identifier: BSD-3-Clause
// What the measured programs in C++ share. src/mrp_bench/running.py starts them.

#pragma once

#include <time.h>

#include <cstdint>
#include <iostream>
#include <utility>
#include <vector>

namespace mrp_bench
{
// Nanoseconds of a clock. CLOCK_MONOTONIC is the same in all processes of a machine, and nobody
// sets it; CLOCK_PROCESS_CPUTIME_ID is the processor time of this process.
inline int64_t now(clockid_t clock = CLOCK_MONOTONIC)
{
  timespec time;
  clock_gettime(clock, &time);
  return time.tv_sec * INT64_C(1000000000) + time.tv_nsec;
}

inline void sleepUntil(int64_t moment)
{
  const timespec time = {moment / 1000000000, moment % 1000000000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

// The messages that have arrived: the stamp of each, and the time of its arrival.
class Samples
{
public:
  explicit Samples(size_t count) : count_(count)
  {
    samples_.reserve(count);
  }

  void add(int64_t stamp, int64_t arrival)
  {
    if (samples_.empty())
    {
      cpu_ = -now(CLOCK_PROCESS_CPUTIME_ID);
    }
    samples_.emplace_back(stamp, arrival);
    if (full())
    {
      cpu_ += now(CLOCK_PROCESS_CPUTIME_ID);
    }
  }

  bool full() const
  {
    return samples_.size() >= count_;
  }

  // The processor time from the first message to the last.
  int64_t cpu() const
  {
    return cpu_;
  }

  void print() const
  {
    for (const auto& sample : samples_)
    {
      std::cout << sample.first << " " << sample.second << "\n";
    }
  }

private:
  size_t count_;
  std::vector<std::pair<int64_t, int64_t>> samples_;
  int64_t cpu_ = 0;
};

// Calls send(stamp) so many times, and so often per second; a rate of 0: as fast as it goes.
template <class Send>
void sendAll(int count, double rate, Send send)
{
  const int64_t start = now();
  for (int i = 0; i < count; ++i)
  {
    if (rate > 0)
    {
      sleepUntil(start + static_cast<int64_t>(i * 1e9 / rate));
    }
    send(now());
  }
}

// Blocks until stdin is closed: then the receivers have all messages.
inline void waitForReceivers()
{
  std::cin.get();
}
}  // namespace mrp_bench
