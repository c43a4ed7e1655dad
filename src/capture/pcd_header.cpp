#include "pcd_header.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>

#include "scree/core/lower_case.hpp"

namespace scree {
namespace {

// Beyond these a header is garbled. The longest descriptor in PCL has 1980 values a point, and PCL
// counts points with 32 bits.
constexpr std::size_t kMostFields = 256, kMostCount = 4096;
constexpr std::size_t kMostPoints = std::size_t{1} << 31;

using Words = std::vector<std::string_view>;

Words split(std::string_view line) {
  Words words;
  constexpr std::string_view kSpace = " \t\r";
  for (std::size_t begin = 0;;) {
    begin = line.find_first_not_of(kSpace, begin);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
}

std::optional<std::size_t> number(std::string_view word) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// The lines of a header by their first word, and where the body begins.
struct Lines {
  std::map<std::string_view, Words> values;
  std::size_t body = 0;
};

Result<Lines> header_lines(std::string_view file) {
  Lines lines;
  // A header is a few hundred bytes; what has none of its words this far in is no PCD file.
  constexpr std::size_t kMostHeader = 1 << 16;
  const std::string_view head = file.substr(0, kMostHeader);
  std::size_t begin = file.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  while (begin < head.size()) {
    const std::size_t end = head.find('\n', begin);
    if (end == std::string_view::npos) break;
    Words words = split(head.substr(begin, end - begin));
    begin = end + 1;
    if (words.empty() || words[0].starts_with('#')) continue;
    constexpr std::array<std::string_view, 11> kKeys = {"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                        "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                        "VIEWPOINT", "POINTS", "DATA"};
    const auto* const found = std::ranges::find_if(
        kKeys, [&](auto each) { return lower_case(each) == lower_case(words[0]); });
    if (found == kKeys.end()) {
      if (lines.values.empty()) return fail("is not a PCD file");
      return fail("has an unknown line in its header");
    }
    const std::string_view key = *found;
    words.erase(words.begin());
    if (!lines.values.emplace(key, std::move(words)).second) {
      return fail(fmt::format("has two {} lines in its header", key));
    }
    if (key == "DATA") {
      lines.body = begin;
      return lines;
    }
  }
  return fail(lines.values.empty() ? "is not a PCD file" : "has no DATA line: its header is cut");
}

Result<std::size_t> single_number(const Lines& lines, std::string_view key, std::size_t low) {
  const auto found = lines.values.find(key);
  if (found == lines.values.end()) return fail(fmt::format("has no {} line in its header", key));
  const auto value = found->second.size() == 1 ? number(found->second[0]) : std::nullopt;
  if (!value || *value < low || *value > kMostPoints) {
    return fail(fmt::format("has a bad {} line in its header", key));
  }
  return *value;
}

/// Files of before version 0.7 call FIELDS COLUMNS, and need not say SIZE, TYPE and COUNT of single
/// floats.
Result<std::vector<PcdField>> read_fields(const Lines& lines) {
  const auto words_of = [&](std::string_view key) -> const Words* {
    const auto found = lines.values.find(key);
    return found == lines.values.end() ? nullptr : &found->second;
  };
  const Words* const names = words_of(lines.values.contains("FIELDS") ? "FIELDS" : "COLUMNS");
  if (names == nullptr || names->empty() || names->size() > kMostFields) {
    return fail("has no usable FIELDS line in its header");
  }
  for (const std::string_view key : {"SIZE", "TYPE", "COUNT"}) {
    const Words* const words = words_of(key);
    if (words != nullptr && words->size() != names->size()) {
      return fail(fmt::format("does not give one {} for each field", key));
    }
  }
  const auto word_of = [&](std::string_view key, std::size_t i, std::string_view otherwise) {
    const Words* const words = words_of(key);
    return words == nullptr ? otherwise : (*words)[i];
  };
  std::vector<PcdField> fields;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < names->size(); ++i) {
    const std::string_view type = word_of("TYPE", i, "F");
    const auto size = number(word_of("SIZE", i, "4"));
    const auto count = number(word_of("COUNT", i, "1"));
    const char kind = type.size() == 1 ? upper(type[0]) : '?';
    const bool whole = kind == 'I' || kind == 'U';
    const std::size_t bytes = size.value_or(0);
    const bool known =
        (bytes == 4 || bytes == 8) ? whole || kind == 'F' : whole && (bytes == 1 || bytes == 2);
    const std::size_t fewest = (*names)[i] == kPadding ? 0 : 1;
    if (!known || !count || *count < fewest || *count > kMostCount) {
      return fail(
          fmt::format("has a field {} of a bad type, size or count", (*names)[i].substr(0, 40)));
    }
    fields.push_back({std::string((*names)[i]), kind, bytes, *count, offset});
    offset += bytes * *count;
  }
  return fields;
}

/// Without WIDTH it is POINTS; without HEIGHT the cloud is one row.
Result<std::size_t> read_points(const Lines& lines) {
  const auto has = [&lines](std::string_view key) { return lines.values.contains(key); };
  if (has("POINTS") && !has("WIDTH") && !has("HEIGHT")) return single_number(lines, "POINTS", 0);
  const auto width = single_number(lines, "WIDTH", 0);
  if (!width) return width;
  const auto height = has("HEIGHT") ? single_number(lines, "HEIGHT", 0) : std::size_t{1};
  if (!height) return height;
  if (has("POINTS")) {
    const auto points = single_number(lines, "POINTS", 0);
    if (!points) return points;
    if (*points != *width * *height) return fail("has POINTS that are not WIDTH times HEIGHT");
  }
  return *width * *height;
}

/// Seven numbers, of which the first three are the place.
Result<Eigen::Vector3d> read_viewpoint(const Lines& lines) {
  const auto found = lines.values.find("VIEWPOINT");
  if (found == lines.values.end()) return Eigen::Vector3d::Zero();
  const Words& words = found->second;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < words.size() && i < 3; ++i) {
    const char* const end = words[i].data() + words[i].size();
    const auto parsed = std::from_chars(words[i].data(), end, place[static_cast<int>(i)]);
    if (parsed.ec != std::errc() || parsed.ptr != end) {
      return fail("has a bad VIEWPOINT line in its header");
    }
  }
  if (words.size() != 7 || !place.allFinite()) {
    return fail("has a bad VIEWPOINT line in its header");
  }
  return place;
}

/// What the body of a compressed file begins with.
struct PackedSizes {
  static constexpr std::size_t kBytes = 8;
  std::uint32_t packed = 0, unpacked = 0;
};

/// Zeros where the body is too short.
PackedSizes packed_sizes(std::string_view body) {
  PackedSizes sizes;
  if (body.size() < PackedSizes::kBytes) return sizes;
  std::memcpy(&sizes.packed, body.data(), sizeof sizes.packed);
  std::memcpy(&sizes.unpacked, body.data() + sizeof sizes.packed, sizeof sizes.unpacked);
  return sizes;
}

std::string bytes_missing(std::size_t needed, std::size_t there) {
  return fmt::format("is cut: {} bytes of points, of which {} are there", needed, there);
}

/// An error's sentence, or nothing when the body can be what the header says.
std::optional<std::string> mismatch(const PcdHeader& header, std::string_view body) {
  const std::size_t size = header.points * header.point_size;
  switch (header.data) {
    case PcdData::binary:
      if (body.size() < size) return bytes_missing(size, body.size());
      if (const std::size_t more = (body.size() - size) / header.point_size; more > 0) {
        return too_many(more);
      }
      return std::nullopt;
    case PcdData::binary_compressed: {
      const PackedSizes sizes = packed_sizes(body);
      if (body.size() < PackedSizes::kBytes) {
        return bytes_missing(PackedSizes::kBytes, body.size());
      }
      const std::size_t there = body.size() - PackedSizes::kBytes;
      if (sizes.packed > there) return bytes_missing(sizes.packed, there);
      // The format (LZF) turns three bytes into at most 264.
      if (sizes.unpacked != size || sizes.unpacked > 88 * std::size_t{sizes.packed}) {
        return "has compressed data of another size than its header says";
      }
      return std::nullopt;
    }
    case PcdData::ascii: {
      std::size_t values = 0;
      for (const PcdField& field : header.fields) values += field.count;
      // A value is a character and a space at least.
      if (header.points * values * 2 > body.size() + 1) {
        return fmt::format("is cut: too short for {} points", header.points);
      }
      return std::nullopt;
    }
  }
  return "has an unknown kind of data";
}

/// PCL leaves padding out of compressed files. Others write it.
void remove_padding(PcdHeader& header, std::string_view body) {
  if (packed_sizes(body).unpacked == header.points * header.point_size) return;
  std::erase_if(header.fields, [](const PcdField& field) { return field.name == kPadding; });
  header.point_size = 0;
  for (PcdField& field : header.fields) {
    field.offset = header.point_size;
    header.point_size += field.size * field.count;
  }
}

}  // namespace

std::string too_many(std::size_t points) {
  return fmt::format("has {} points more than its header says: mend WIDTH, HEIGHT and POINTS",
                     points);
}

const PcdField* PcdHeader::find(std::initializer_list<std::string_view> names) const {
  for (const PcdField& field : fields) {
    if (std::find(names.begin(), names.end(), lower_case(field.name)) != names.end()) return &field;
  }
  return nullptr;
}

Result<PcdHeader> parse_pcd_header(std::string_view file) {
  const auto lines = header_lines(file);
  if (!lines) return tl::make_unexpected(lines.error());
  auto fields = read_fields(*lines);
  if (!fields) return tl::make_unexpected(fields.error());
  const auto points = read_points(*lines);
  if (!points) return tl::make_unexpected(points.error());
  const auto viewpoint = read_viewpoint(*lines);
  if (!viewpoint) return tl::make_unexpected(viewpoint.error());

  PcdHeader header;
  header.viewpoint = *viewpoint;
  header.fields = std::move(*fields);
  header.point_size =
      header.fields.back().offset + header.fields.back().size * header.fields.back().count;
  header.points = *points;
  header.body = lines->body;
  if (header.points > kMostPoints) return fail("has more points than can be");

  const Words& data = lines->values.at("DATA");
  const std::string kind = data.size() == 1 ? lower_case(data[0]) : "";
  if (kind == "ascii") {
    header.data = PcdData::ascii;
  } else if (kind == "binary") {
    header.data = PcdData::binary;
  } else if (kind == "binary_compressed") {
    header.data = PcdData::binary_compressed;
    remove_padding(header, file.substr(header.body));
  } else {
    return fail("has DATA that is neither ascii, binary nor binary_compressed");
  }
  for (const std::string_view name : {"x", "y", "z"}) {
    const PcdField* const field = header.find({name});
    if (field == nullptr) return fail(fmt::format("has no field {}", name));
    if (!field->is_coordinate())
      return fail(fmt::format("has a field {} that is not one float", name));
  }
  if (header.points == 0) return header;
  if (const auto reason = mismatch(header, file.substr(header.body))) return fail(*reason);
  return header;
}

}  // namespace scree
