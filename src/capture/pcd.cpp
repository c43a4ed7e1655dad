#include "scree/capture/pcd.hpp"

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <spdlog/fmt/fmt.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "pcd_header.hpp"

namespace scree {
namespace {

pcl::PCLPointField::PointFieldTypes pcl_type(const PcdField& field) {
  using Field = pcl::PCLPointField;
  if (field.type == 'F') return field.size == 4 ? Field::FLOAT32 : Field::FLOAT64;
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? Field::INT8 : Field::UINT8;
    case 2:
      return is_signed ? Field::INT16 : Field::UINT16;
    case 4:
      return is_signed ? Field::INT32 : Field::UINT32;
    default:
      return is_signed ? Field::INT64 : Field::UINT64;
  }
}

pcl::PCLPointCloud2 empty_blob(const PcdHeader& header) {
  pcl::PCLPointCloud2 blob;
  for (const PcdField& field : header.fields) {
    pcl::PCLPointField& pcl_field = blob.fields.emplace_back();
    pcl_field.name = field.name;
    pcl_field.offset = static_cast<pcl::uindex_t>(field.offset);
    pcl_field.datatype = static_cast<std::uint8_t>(pcl_type(field));
    pcl_field.count = static_cast<pcl::uindex_t>(field.count);
  }
  blob.height = 1;
  blob.width = static_cast<pcl::uindex_t>(header.points);
  blob.point_step = static_cast<pcl::uindex_t>(header.point_size);
  blob.row_step = static_cast<pcl::uindex_t>(header.points * header.point_size);
  blob.data.resize(header.points * header.point_size);
  return blob;
}

template <class T>
float value_as_float(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<float>(value);
}

using Reading = float (*)(const std::uint8_t*);

Reading reading_of(const PcdField& field) {
  if (field.type == 'F') return field.size == 4 ? value_as_float<float> : value_as_float<double>;
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? value_as_float<std::int8_t> : value_as_float<std::uint8_t>;
    case 2:
      return is_signed ? value_as_float<std::int16_t> : value_as_float<std::uint16_t>;
    case 4:
      return is_signed ? value_as_float<std::int32_t> : value_as_float<std::uint32_t>;
    default:
      return is_signed ? value_as_float<std::int64_t> : value_as_float<std::uint64_t>;
  }
}

void copy_field(const std::vector<std::uint8_t>& points, std::size_t point_size,
                const PcdField& field, FixedVector<float>& values) {
  const Reading reading = reading_of(field);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = reading(points.data() + i * point_size + field.offset);
  }
}

Result<std::string> read_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return fail("no such file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file, error)) return fail("cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

Result<PcdCloud> read_points(const std::string& bytes) {
  const auto header = parse_pcd_header(bytes);
  if (!header) return tl::make_unexpected(header.error());
  PcdCloud cloud{PointCloud(header->points), header->viewpoint};
  cloud.resize(header->points);
  if (header->points == 0) return cloud;

  // PCL explains itself on the terminal; our caller gets a sentence instead.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  pcl::PCLPointCloud2 blob = empty_blob(*header);
  pcl::PCDReader reader;
  constexpr int kVersion = 7;  // 0.7
  int failed = 0;
  if (header->data == PcdData::ascii) {
    std::istringstream body(bytes.substr(header->body));
    failed = reader.readBodyASCII(body, blob, kVersion);
  } else {
    const auto* body = reinterpret_cast<const unsigned char*>(bytes.data() + header->body);
    failed =
        reader.readBodyBinary(body, blob, kVersion, header->data == PcdData::binary_compressed, 0);
  }
  if (failed != 0 || blob.data.size() != header->points * header->point_size) {
    return fail("has points that cannot be read");
  }

  copy_field(blob.data, header->point_size, *header->find({"x"}), cloud.x);
  copy_field(blob.data, header->point_size, *header->find({"y"}), cloud.y);
  copy_field(blob.data, header->point_size, *header->find({"z"}), cloud.z);
  const PcdField* const reflectivity =
      header->find({"intensity", "intensities", "i", "reflectivity", "reflectance"});
  if (reflectivity != nullptr) {
    copy_field(blob.data, header->point_size, *reflectivity, cloud.reflectivity);
  } else {
    std::fill(cloud.reflectivity.begin(), cloud.reflectivity.end(), 0.0F);
  }
  return cloud;
}

}  // namespace

Result<PcdCloud> read_pcd(const std::filesystem::path& file) {
  std::string reason;
  try {
    const auto bytes = read_file(file);
    auto cloud = bytes ? read_points(*bytes) : Result<PcdCloud>(tl::make_unexpected(bytes.error()));
    if (cloud) return cloud;
    reason = cloud.error().message;
  } catch (const std::exception& error) {
    reason = fmt::format("cannot be read ({})", error.what());
  }
  return fail(fmt::format("{}: {}", file.string(), reason));
}

Result<void> write_pcd(const std::filesystem::path& file, const PointView& points) {
  PcdHeader header;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    header.fields.push_back({name, 'F', 4, 1, header.point_size});
    header.point_size += 4;
  }
  header.points = points.size();
  pcl::PCLPointCloud2 blob = empty_blob(header);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float values[] = {points.x[i], points.y[i], points.z[i], points.reflectivity[i]};
    std::memcpy(blob.data.data() + i * header.point_size, values, sizeof values);
  }
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  try {
    if (pcl::PCDWriter().writeBinary(file.string(), blob) == 0) return {};
  } catch (const std::exception&) {
    // PCL reports one failure as a number and another as an exception; both say as little.
  }
  return fail(fmt::format("cannot write {}", file.string()));
}

}  // namespace scree
