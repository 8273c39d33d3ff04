// SPDX-License-Identifier: BSD-3-Clause
// Says whether a roscpp node calls a callback of a subscriber. LD_PRELOAD puts it before roscpp,
// whose queues take each message out by ros::SubscriptionQueue::call(), for its callback. The first
// call makes the file that MRP_CHECK_CALLBACKS names, with a dot and the process's ID behind it.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

static bool make_file()
{
  const char* file = std::getenv("MRP_CHECK_CALLBACKS");
  if (file != nullptr)
  {
    const std::string path = std::string(file) + "." + std::to_string(getpid());
    close(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
  }
  return true;
}

extern "C" int _ZN3ros17SubscriptionQueue4callEv(void* queue)
{
  static const bool made = make_file();
  static const auto next =
      reinterpret_cast<int (*)(void*)>(dlsym(RTLD_NEXT, "_ZN3ros17SubscriptionQueue4callEv"));
  (void)made;
  return next(queue);
}
