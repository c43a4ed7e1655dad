#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace scree {

/// Does work(0) to work(count - 1) in as many threads as there are processors, in no certain order.
/// What work throws first ends it all and is thrown on.
/// @param make_work makes the work of one thread
/// @param progress called after each with the number done, one call at a time
template <class MakeWork>
void in_parallel(std::size_t count, const MakeWork& make_work,
                 const std::function<void(std::size_t)>& progress) {
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      auto work = make_work();
      for (std::size_t i = next++; i < count; i = next++) {
        work(i);
        const std::scoped_lock lock(mutex);
        progress(++done);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t processors = std::max(std::thread::hardware_concurrency(), 1U);
    for (std::size_t i = 0; i < std::min(processors, count); ++i) threads.emplace_back(run);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace scree
