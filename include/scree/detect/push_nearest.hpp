#pragma once

#include <algorithm>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Adds an element; where there is no room, in place of the farthest one if that lies farther off.
/// @param distance of an element, in whatever unit
/// @return whether all have found room
template <class T, class Distance>
bool push_nearest(FixedVector<T>& all, const T& added, const Distance& distance) {
  if (all.push_back(added)) return true;
  T* const farthest = std::ranges::max_element(all, {}, distance);
  if (farthest != all.end() && distance(added) < distance(*farthest)) *farthest = added;
  return false;
}

}  // namespace scree
