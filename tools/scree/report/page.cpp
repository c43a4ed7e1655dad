#include "report/page.hpp"

#include <zlib.h>

#include <string_view>
#include <vector>

#include "commands.hpp"
#include "report/page_files.hpp"

namespace scree::cli {
namespace {

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[bits >> (18 - 6 * k) & 0x3F] : '=';
    }
  }
  return text;
}

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), Z_BEST_COMPRESSION) != Z_OK) {
    throw Failure("the report's data could not be compressed: too little memory");
  }
  packed.resize(size);
  return packed;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// The page with what stands for its parts replaced, from the first to the last.
std::string filled(const std::string& title, const std::string& data) {
  std::string page;
  std::string_view rest = page_files::page_html;
  const auto replace = [&](std::string_view place, std::string_view by) {
    const std::size_t at = rest.find(place);
    page.append(rest.substr(0, at)).append(by);
    rest.remove_prefix(at + place.size());
  };
  replace("{{title}}", escaped(title));
  replace("{{style}}", page_files::page_css);
  replace("{{data}}", data);
  replace("{{script}}", page_files::page_js);
  return page.append(rest);
}

}  // namespace

std::string report_page(const std::string& title, std::span<const std::uint8_t> data) {
  return filled(title, base64(deflated(data)));
}

std::string live_page() {
  return filled("Scree, live", "");
}

}  // namespace scree::cli
