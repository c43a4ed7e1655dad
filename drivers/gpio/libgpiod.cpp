#include "libgpiod.hpp"

#include <gpiod.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "scree/core/nanoseconds.hpp"

namespace scree::gpio {

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

namespace {

constexpr const char* kConsumer = "scree";

std::optional<unsigned> number_of(const std::string& line) {
  unsigned number = 0;
  const char* const end = line.data() + line.size();
  const auto [stop, error] = std::from_chars(line.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

bool is_forbidden(int error) {
  return error == EACCES || error == EPERM;
}

tl::unexpected<Error> no_chip(const std::string& name, int error) {
  if (is_forbidden(error)) {
    return fail("no right to open GPIO chip " + name + " (is this user in the group gpio?)");
  }
  return fail("there is no GPIO chip " + name + " (`gpiodetect` lists them)");
}

tl::unexpected<Error> no_line(const std::string& chip, const std::string& line) {
  return fail("GPIO chip " + chip + " has no line " + line + " (`gpioinfo` lists them)");
}

tl::unexpected<Error> refused(int error) {
  if (error == EBUSY) return fail("another program holds the line (`gpioinfo` names it)");
  return fail(std::string("the line cannot be had: ") + std::strerror(error));
}

}  // namespace

#ifdef GPIOD_LINE_BULK_MAX_LINES  // version 1

struct HeldLine {
  Chip chip;
  gpiod_line* line;
};

namespace {

gpiod_line* find_line(const Chip& chip, const std::string& line) {
  const auto number = number_of(line);
  return number ? gpiod_chip_get_line(chip.get(), *number)
                : gpiod_chip_find_line(chip.get(), line.c_str());
}

}  // namespace

Result<std::string> holder_of(const std::string& chip_name, const std::string& line_name) {
  const Chip chip(gpiod_chip_open_lookup(chip_name.c_str()));
  if (!chip) return no_chip(chip_name, errno);
  gpiod_line* const line = find_line(chip, line_name);
  if (line == nullptr) return no_line(chip_name, line_name);
  if (!gpiod_line_is_used(line)) return std::string();
  const char* const holder = gpiod_line_consumer(line);
  return std::string(holder == nullptr ? "the kernel" : holder);
}

Result<void> check_line(const std::string& chip_name, const std::string& line_name) {
  const Chip chip(gpiod_chip_open_lookup(chip_name.c_str()));
  if (!chip) return is_forbidden(errno) ? Result<void>() : no_chip(chip_name, errno);
  return find_line(chip, line_name) != nullptr ? Result<void>() : no_line(chip_name, line_name);
}

Result<LineHandle> request(const LineRequest& wanted) {
  Chip chip(gpiod_chip_open_lookup(wanted.chip.c_str()));
  if (!chip) return no_chip(wanted.chip, errno);
  gpiod_line* const line = find_line(chip, wanted.line);
  if (line == nullptr) return no_line(wanted.chip, wanted.line);
  const int flags = wanted.is_active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  const int failed =
      wanted.is_output
          ? gpiod_line_request_output_flags(line, kConsumer, flags, wanted.is_on ? 1 : 0)
          : gpiod_line_request_rising_edge_events_flags(line, kConsumer, flags);
  if (failed != 0) return refused(errno);
  return LineHandle(new HeldLine{std::move(chip), line});
}

bool set(HeldLine& line, bool is_on) {
  return gpiod_line_set_value(line.line, is_on ? 1 : 0) == 0;
}

int descriptor_of(const HeldLine& line) {
  return gpiod_line_event_get_fd(line.line);
}

std::optional<std::int64_t> read_edge(HeldLine& line) {
  const timespec at_once{};
  gpiod_line_event event{};
  if (gpiod_line_event_wait(line.line, &at_once) != 1) return std::nullopt;
  if (gpiod_line_event_read(line.line, &event) != 0) return std::nullopt;
  return to_ns(event.ts);
}

#else  // version 2

template <class T, void (*kFree)(T*)>
struct Free {
  void operator()(T* object) const { kFree(object); }
};
template <class T, void (*kFree)(T*)>
using Owned = std::unique_ptr<T, Free<T, kFree> >;
using Info = Owned<gpiod_chip_info, gpiod_chip_info_free>;
using LineInfo = Owned<gpiod_line_info, gpiod_line_info_free>;
using LineSettings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Owned<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Owned<gpiod_request_config, gpiod_request_config_free>;
using Request = Owned<gpiod_line_request, gpiod_line_request_release>;
using Events = Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free>;

namespace {

/// By path, by name, else by label.
Chip open_chip(const std::string& name) {
  namespace fs = std::filesystem;
  const std::string path = name.find('/') == std::string::npos ? "/dev/" + name : name;
  if (Chip chip(gpiod_chip_open(path.c_str())); chip) return chip;
  const int reason = errno;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev", ignored)) {
    if (!gpiod_is_gpiochip_device(entry.path().c_str())) continue;
    Chip chip(gpiod_chip_open(entry.path().c_str()));
    const Info info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    if (info && name == gpiod_chip_info_get_label(info.get())) return chip;
  }
  errno = reason;
  return nullptr;
}

std::optional<unsigned> find_line(const Chip& chip, const std::string& line) {
  const auto given = number_of(line);
  const int found = given ? static_cast<int>(*given)
                          : gpiod_chip_get_line_offset_from_name(chip.get(), line.c_str());
  const Info info(gpiod_chip_get_info(chip.get()));
  if (found < 0 || !info ||
      static_cast<std::size_t>(found) >= gpiod_chip_info_get_num_lines(info.get())) {
    return std::nullopt;
  }
  return static_cast<unsigned>(found);
}

}  // namespace

Result<std::string> holder_of(const std::string& chip_name, const std::string& line_name) {
  const Chip chip = open_chip(chip_name);
  if (!chip) return no_chip(chip_name, errno);
  const auto number = find_line(chip, line_name);
  if (!number) return no_line(chip_name, line_name);
  const LineInfo line(gpiod_chip_get_line_info(chip.get(), *number));
  if (!line || !gpiod_line_info_is_used(line.get())) return std::string();
  const char* const holder = gpiod_line_info_get_consumer(line.get());
  return std::string(holder == nullptr ? "the kernel" : holder);
}

Result<void> check_line(const std::string& chip_name, const std::string& line_name) {
  const Chip chip = open_chip(chip_name);
  if (!chip) return is_forbidden(errno) ? Result<void>() : no_chip(chip_name, errno);
  return find_line(chip, line_name) ? Result<void>() : no_line(chip_name, line_name);
}

struct HeldLine {
  Chip chip;
  Request request;
  unsigned number;
  Events events;
};

Result<LineHandle> request(const LineRequest& wanted) {
  Chip chip = open_chip(wanted.chip);
  if (!chip) return no_chip(wanted.chip, errno);
  const auto found = find_line(chip, wanted.line);
  if (!found) return no_line(wanted.chip, wanted.line);
  const unsigned number = *found;

  const LineSettings settings(gpiod_line_settings_new());
  const LineConfig lines(gpiod_line_config_new());
  const RequestConfig config(gpiod_request_config_new());
  Events events(gpiod_edge_event_buffer_new(1));
  if (!settings || !lines || !config || !events) return refused(ENOMEM);
  gpiod_line_settings_set_active_low(settings.get(), wanted.is_active_low);
  if (wanted.is_output) {
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_output_value(
        settings.get(), wanted.is_on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  } else {
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_RISING);
  }
  gpiod_request_config_set_consumer(config.get(), kConsumer);
  if (gpiod_line_config_add_line_settings(lines.get(), &number, 1, settings.get()) != 0) {
    return refused(errno);
  }
  Request request(gpiod_chip_request_lines(chip.get(), config.get(), lines.get()));
  if (!request) return refused(errno);
  return LineHandle(new HeldLine{std::move(chip), std::move(request), number, std::move(events)});
}

bool set(HeldLine& line, bool is_on) {
  return gpiod_line_request_set_value(
             line.request.get(), line.number,
             is_on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
}

int descriptor_of(const HeldLine& line) {
  return gpiod_line_request_get_fd(line.request.get());
}

std::optional<std::int64_t> read_edge(HeldLine& line) {
  gpiod_line_request* const request = line.request.get();
  if (gpiod_line_request_wait_edge_events(request, 0) != 1) return std::nullopt;
  if (gpiod_line_request_read_edge_events(request, line.events.get(), 1) != 1) return std::nullopt;
  return static_cast<std::int64_t>(
      gpiod_edge_event_get_timestamp_ns(gpiod_edge_event_buffer_get_event(line.events.get(), 0)));
}

#endif

void ReleaseLine::operator()(HeldLine* line) const {
  delete line;
}

}  // namespace scree::gpio
