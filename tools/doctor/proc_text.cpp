#include "doctor/proc_text.hpp"

#include <sched.h>

#include <bit>
#include <charconv>

namespace scree {
namespace {

constexpr std::string_view kBlank = " \t";

/// Takes off the first word; empty where there is none.
std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlank));
  text.remove_prefix(word.size());
  return word;
}

template <class T>
std::optional<T> number(std::string_view word, int base = 10) {
  T value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<UdpSocket> socket_of(std::string_view line) {
  take_word(line);  // "1234:", the slot
  const std::string_view local = take_word(line);
  const std::size_t colon = local.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto address = number<std::uint32_t>(local.substr(0, colon), 16);
  const auto port = number<std::uint16_t>(local.substr(colon + 1), 16);
  constexpr int kBetweenLocalAndInode = 7;
  for (int i = 0; i < kBetweenLocalAndInode; ++i) take_word(line);
  const auto inode = number<std::uint64_t>(take_word(line));
  if (!address || !port || !inode) return std::nullopt;
  // The kernel prints the address as it lies in memory.
  static_assert(std::endian::native == std::endian::little);
  return UdpSocket{__builtin_bswap32(*address), *port, *inode};
}

}  // namespace

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

std::vector<UdpSocket> parse_udp_sockets(std::string_view text) {
  std::vector<UdpSocket> sockets;
  while (!text.empty()) {
    if (const auto socket = socket_of(take_line(text))) sockets.push_back(*socket);
  }
  return sockets;
}

std::optional<std::uint64_t> parse_limit(std::string_view text, std::string_view name) {
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (!line.starts_with(name)) continue;
    line.remove_prefix(name.size());
    const std::string_view soft = take_word(line);
    return soft == "unlimited" ? kUnlimited : number<std::uint64_t>(soft);
  }
  return std::nullopt;
}

std::string_view status_value(std::string_view text, std::string_view name) {
  while (!text.empty()) {
    std::string_view line = take_line(text);
    if (!line.starts_with(name) || !line.substr(name.size()).starts_with(':')) continue;
    line.remove_prefix(name.size() + 1);
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    return line;
  }
  return {};
}

bool has_capability(std::string_view text, int capability) {
  const auto all = number<std::uint64_t>(status_value(text, "CapEff"), 16);
  return all && (*all >> capability & 1) != 0;
}

bool is_real_time(std::string_view text) {
  // The name, in parentheses, may hold anything; the policy is the 39th field behind it.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string_view::npos) return false;
  text.remove_prefix(name_end + 1);
  constexpr int kPolicy = 39;
  for (int i = 1; i < kPolicy; ++i) take_word(text);
  const auto policy = number<int>(take_word(text));
  return policy && (*policy == SCHED_FIFO || *policy == SCHED_RR);
}

}  // namespace scree
