#pragma once

#include <cstddef>

namespace scree::test {

/// Allocations by operator new since the program's start, all threads; link allocation_counter.cpp.
std::size_t allocations();

}  // namespace scree::test
