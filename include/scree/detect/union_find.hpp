#pragma once

#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Whom a set is named after in a union-find structure, where a root is its own parent. Halves the
/// path on its way.
inline std::uint32_t root_of(FixedVector<std::uint32_t>& parents, std::uint32_t member) {
  while (parents[member] != member) member = parents[member] = parents[parents[member]];
  return member;
}

}  // namespace scree
