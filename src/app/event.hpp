#pragma once

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <system_error>

#include "scree/core/descriptor.hpp"

namespace scree {

/// Wakes one thread from any other. A wake-up that comes before the wait is not lost.
class Event {
public:
  /// @throw std::system_error where this process may not have another descriptor
  Event() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (event_.is_open()) return;
    throw std::system_error(errno, std::generic_category(),
                            "cannot open what wakes a thread (`ulimit -n`)");
  }

  void wake() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t size = write(event_.get(), &one, sizeof one);
  }
  /// Returns when woken, true, or when the time is over.
  bool wait(std::chrono::milliseconds longest) {
    pollfd event{event_.get(), POLLIN, 0};
    if (poll(&event, 1, static_cast<int>(longest.count())) <= 0) return false;
    std::uint64_t wakes;
    return read(event_.get(), &wakes, sizeof wakes) == sizeof wakes;
  }
  /// For a thread that polls other descriptors too: readable once woken.
  int descriptor() const { return event_.get(); }

private:
  Descriptor event_;
};

}  // namespace scree
