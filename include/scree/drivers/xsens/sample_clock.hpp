#pragma once

#include <cstdint>
#include <optional>

#include "scree/clock/device_clock.hpp"
#include "scree/drivers/xsens/measurement.hpp"

namespace scree::xsens {

/// How a message came.
struct Arrival {
  std::int64_t arrival_ns;   ///< of the read's last byte, host time
  std::size_t size;          ///< of the message on the wire, bytes
  std::size_t bytes_behind;  ///< of the same read, after the message
};

/// Host times of an MTi's samples: from the best device time that its messages carry.
///
/// | what they carry      | device time                                                          |
/// |----------------------|----------------------------------------------------------------------|
/// | SampleTimeFine       | its ticks of 0.1 ms                                                  |
/// | else UTC             | its nanoseconds                                                      |
/// | else packet counter  | samples counted, at the usual rate nearest to the measured one       |
/// | else, or rate unusual| none: the time of arrival                                            |
///
/// SampleTimeCoarse counts whole seconds and times no sample. A message is complete at the device
/// when its last byte is on the line, so its length at the line's bit rate is added to its device
/// time; and where less than another message lies behind it in the same read, the stamp of the read
/// is later than its own end by that much. Once a better device time was seen, messages without it
/// are stamped by arrival, and the worse one is taken up when the better is gone for a second.
class SampleClock {
public:
  explicit SampleClock(int baud);

  struct Stamp {
    std::int64_t t_ns = 0;        ///< of the sample, host time
    std::int64_t elapsed_ns = 0;  ///< device time since the last sample; 0 unknown
    bool started_over = false;    ///< times before and after do not compare
  };
  /// Takes the next sample. @param step 1, more where samples were lost before it
  Stamp stamp(const Measurement& sample, std::int64_t step, const Arrival& arrival);
  /// Host time of a message that is no sample and may be older than the last one.
  std::int64_t host_time(const Measurement& message, const Arrival& arrival) const;

  /// The clock of the device time in use; not started where messages are stamped by arrival.
  const DeviceClock& clock() const { return clock_; }
  /// Summed over all device times taken up so far; see DeviceClock.
  std::uint64_t device_restarts() const { return restarts_before_ + clock_.device_restarts(); }
  std::uint64_t host_steps() const { return steps_before_ + clock_.host_steps(); }

private:
  enum class Source : std::uint8_t { arrival, counter, utc, fine };
  static Source best_source(const Measurement& message, bool is_counted);
  std::optional<std::int64_t> device_time(const Measurement& message, Source source) const;
  void take_up(Source source);
  void count(std::int64_t step, std::int64_t arrival_ns);

  double byte_ns_;
  Source source_ = Source::arrival;
  DeviceClock clock_;
  bool started_ = false;  ///< clock_ was updated
  std::int64_t last_device_ns_ = 0;
  std::int64_t source_seen_ns_ = 0;  ///< arrival of the last message that had the source
  std::uint64_t restarts_before_ = 0, steps_before_ = 0;

  // Samples counted, to find their rate; their period, once it is known.
  std::int64_t samples_ = 0, counted_since_ns_ = 0, counted_ns_ = 0;
  std::int64_t period_ns_ = 0;
};

}  // namespace scree::xsens
