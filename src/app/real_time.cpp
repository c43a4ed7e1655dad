#include "real_time.hpp"

#include <pthread.h>
#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

namespace scree {
namespace {

// Above ordinary threads, below those of the kernel that serve interrupts (50).
constexpr int kPriority = 40;

}  // namespace

void make_stacks_small() {
  constexpr std::size_t kStack = std::size_t{1} << 20U;
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return;
  pthread_attr_setstacksize(&attributes, kStack);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

void run_first(std::initializer_list<std::thread*> threads) {
  const sched_param priority{.sched_priority = kPriority};
  for (std::thread* thread : threads) {
    if (!thread->joinable()) continue;
    if (pthread_setschedparam(thread->native_handle(), SCHED_FIFO, &priority) == 0) continue;
    spdlog::info(
        "the sensors' threads run as other programs do, a busy computer delays them: there is no "
        "right to real-time priority {} (RLIMIT_RTPRIO)",
        kPriority);
    return;
  }
}

void lock_memory() {
  if (mlockall(MCL_CURRENT) == 0) return;
  spdlog::info("memory is not locked, pages may be swapped out: {} (RLIMIT_MEMLOCK)",
               std::strerror(errno));
}

}  // namespace scree
