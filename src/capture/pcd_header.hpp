#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scree/core/byte_order_mark.hpp"
#include "scree/core/result.hpp"

namespace scree {

enum class PcdData : std::uint8_t { ascii, binary, binary_compressed };

/// The name of fields that hold nothing.
inline constexpr std::string_view kPadding = "_";

struct PcdField {
  std::string name;
  char type = 'F';       ///< I, U or F
  std::size_t size = 4;  ///< bytes of one value
  std::size_t count = 1;
  std::size_t offset = 0;  ///< in the point

  /// One number that is to be read: a float or double for a coordinate.
  bool is_coordinate() const { return type == 'F' && count == 1; }
};

/// The header of a PCD file, checked against the bytes that follow it.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t point_size = 0;  ///< bytes of one point
  PcdData data = PcdData::ascii;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  ///< metres
  std::size_t body = 0;                                 ///< where the data begins in the file

  /// The first field of one of these names, whatever their case.
  const PcdField* find(std::initializer_list<std::string_view> names) const;
};

/// Reads and checks the header at the beginning of `file`, the bytes of a whole file. When it
/// succeeds, x, y and z are there, and the body is as long as the header says. An ascii body is
/// long enough for the values that the header says.
Result<PcdHeader> parse_pcd_header(std::string_view file);

/// An error's sentence for points that follow those of the header: nobody knows what they are.
std::string too_many(std::size_t points);

}  // namespace scree
