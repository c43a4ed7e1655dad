#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "pcd_header.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// The points' bytes, one point behind the other, each as the header says: ascii and
/// binary_compressed unpacked. What PCL's reader takes is taken. Any bytes are safe.
/// @param file the bytes of the whole file, whose header this is
Result<std::vector<std::uint8_t>> read_pcd_body(std::string_view file, const PcdHeader& header);

}  // namespace scree
