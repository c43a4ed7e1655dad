#pragma once

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>

#include "scree/core/descriptor.hpp"

namespace scree {

/// Wakes one thread from any other. A wake-up that comes before the wait is not lost.
class Event {
public:
  Event() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

  void wake() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t size = write(event_.get(), &one, sizeof one);
  }
  /// Returns when woken or when the time is over.
  void wait(std::chrono::milliseconds longest) {
    pollfd event{event_.get(), POLLIN, 0};
    if (poll(&event, 1, static_cast<int>(longest.count())) <= 0) return;
    std::uint64_t wakes;
    [[maybe_unused]] const ssize_t size = read(event_.get(), &wakes, sizeof wakes);
  }
  /// For a thread that polls other descriptors too: readable once woken.
  int descriptor() const { return event_.get(); }

private:
  Descriptor event_;
};

}  // namespace scree
