#include "scree/capture/pcd.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include "pcd_body.hpp"
#include "pcd_header.hpp"
#include "scree/capture/capture.hpp"
#include "scree/core/lower_case.hpp"
#include "scree/core/read_file.hpp"

namespace scree {
namespace {

template <class T>
double value_of(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

using Reading = double (*)(const std::uint8_t*);

Reading reading_of(const PcdField& field) {
  if (field.type == 'F') return field.size == 4 ? value_of<float> : value_of<double>;
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? value_of<std::int8_t> : value_of<std::uint8_t>;
    case 2:
      return is_signed ? value_of<std::int16_t> : value_of<std::uint16_t>;
    case 4:
      return is_signed ? value_of<std::int32_t> : value_of<std::uint32_t>;
    default:
      return is_signed ? value_of<std::int64_t> : value_of<std::uint64_t>;
  }
}

/// The values of one field, point by point.
class FieldColumn {
public:
  FieldColumn(const std::vector<std::uint8_t>& points, const PcdHeader& header,
              const PcdField& field)
      : reading_(reading_of(field)),
        bytes_(points.data() + field.offset),
        point_size_(header.point_size),
        size_(header.points) {}

  double operator[](std::size_t i) const { return reading_(bytes_ + i * point_size_); }

  void copy_to(FixedVector<float>& values, double origin = 0) const {
    for (std::size_t i = 0; i < size_; ++i) values[i] = static_cast<float>((*this)[i] - origin);
  }

private:
  Reading reading_;
  const std::uint8_t* bytes_;
  std::size_t point_size_, size_;
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Whole metres near the middle of a cloud that lies far off, as one in UTM coordinates or at an
/// altitude: there a float has not the digits, nor a raster the cells. Else zero.
/// Places without a return, as organized clouds have, are at 0 0 0 or nowhere: they do not count.
Eigen::Vector3d origin_for(const std::array<FieldColumn, 3>& coordinates, std::size_t size) {
  constexpr double kFar = 100;  // metres
  std::array<std::vector<double>, 3> seen;
  for (std::size_t i = 0; i < size; ++i) {
    const Eigen::Vector3d point(coordinates[0][i], coordinates[1][i], coordinates[2][i]);
    if (!point.allFinite() || point == Eigen::Vector3d::Zero()) continue;
    for (std::size_t axis = 0; axis < seen.size(); ++axis) {
      seen[axis].push_back(point[static_cast<Eigen::Index>(axis)]);
    }
  }
  if (seen[0].empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d middle(median(seen[0]), median(seen[1]), median(seen[2]));
  if (middle.cwiseAbs().maxCoeff() <= kFar) return Eigen::Vector3d::Zero();
  return middle.array().round();
}

Result<PcdCloud> read_points(const std::string& bytes) {
  const auto header = parse_pcd_header(bytes);
  if (!header) return tl::make_unexpected(header.error());
  PcdCloud cloud{PointCloud(header->points), header->viewpoint.cast<float>()};
  cloud.resize(header->points);
  if (header->points == 0) return cloud;
  const auto points = read_pcd_body(bytes, *header);
  if (!points) return tl::make_unexpected(points.error());

  const auto column = [&](const PcdField& field) { return FieldColumn(*points, *header, field); };
  const std::array<FieldColumn, 3> coordinates = {
      column(*header->find({"x"})), column(*header->find({"y"})), column(*header->find({"z"}))};
  cloud.origin = origin_for(coordinates, header->points);
  cloud.viewpoint = (header->viewpoint - cloud.origin).cast<float>();
  coordinates[0].copy_to(cloud.x, cloud.origin.x());
  coordinates[1].copy_to(cloud.y, cloud.origin.y());
  coordinates[2].copy_to(cloud.z, cloud.origin.z());
  const PcdField* const reflectivity =
      header->find({"intensity", "intensities", "i", "reflectivity", "reflectance"});
  if (reflectivity != nullptr) {
    column(*reflectivity).copy_to(cloud.reflectivity);
  } else {
    std::fill(cloud.reflectivity.begin(), cloud.reflectivity.end(), 0.0F);
  }
  return cloud;
}

}  // namespace

bool is_pcd(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 16> head{};
  stream.read(head.data(), head.size());
  std::string_view text(head.data(), static_cast<std::size_t>(stream.gcount()));
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::string begin = lower_case(text);
  const bool is_pointer = begin.starts_with("version https");  // of Git LFS
  return begin.starts_with("# .pcd") || begin.starts_with("fields") ||
         (begin.starts_with("version") && !is_pointer);
}

Result<PcdCloud> read_pcd(const std::filesystem::path& file) {
  const auto bytes = read_file(file, std::numeric_limits<std::uintmax_t>::max());
  if (!bytes) return tl::make_unexpected(bytes.error());
  std::string reason;
  try {
    auto cloud = read_points(*bytes);
    if (cloud) return cloud;
    reason = cloud.error().message;
    if (const std::string kind = is_pcd(file) ? "" : other_kind(file); !kind.empty()) reason = kind;
  } catch (const std::exception& error) {
    reason = fmt::format("cannot be read ({})", error.what());
  }
  return fail(fmt::format("{}: {}", file.string(), reason));
}

Result<void> write_pcd(const std::filesystem::path& file, const PointView& points) {
  std::ofstream stream(file, std::ios::binary);
  stream << fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\n"
      "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float values[] = {points.x[i], points.y[i], points.z[i], points.reflectivity[i]};
    stream.write(reinterpret_cast<const char*>(values), sizeof values);
  }
  stream.close();
  if (!stream) return fail(fmt::format("cannot write {}: the disk may be full", file.string()));
  return {};
}

}  // namespace scree
