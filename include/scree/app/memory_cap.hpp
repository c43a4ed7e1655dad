#pragma once

#include <sys/resource.h>

#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>

#include "scree/core/result.hpp"

namespace scree {

/// Bytes of address space that this process has now.
std::uint64_t memory_taken();
/// Bytes that it may still take: what the computer has left, and its limit (`ulimit -v`).
std::uint64_t memory_left();

/// As long as it lives, whoever asks for more memory than memory_left() gets std::bad_alloc.
/// Without it Linux gives what it has not got, and kills some program when the memory is used.
class MemoryCap {
public:
  MemoryCap();
  MemoryCap(const MemoryCap&) = delete;
  MemoryCap& operator=(const MemoryCap&) = delete;
  ~MemoryCap();

  /// What to say when std::bad_alloc came.
  std::string sentence() const;

private:
  rlimit before_{};
  std::uint64_t left_;
};

/// What `make` returns, a Result, or one sentence where there is not enough memory for it. The
/// limit is the whole process's: no other thread may do the same.
template <class Make>
auto within_memory(const Make& make) -> decltype(make()) {
  const MemoryCap cap;
  try {
    return make();
  } catch (const std::bad_alloc&) {
    return fail(cap.sentence());
  } catch (const std::length_error&) {  // more than can be addressed
    return fail(cap.sentence());
  }
}

}  // namespace scree
