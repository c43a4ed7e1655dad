#include "scree/drivers/encoder/encoder_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include "simulator/encoder.hpp"
#include "simulator/robot.hpp"
#include "unit/allocation_counter.hpp"

namespace scree::encoder {
namespace {

CanFrame frame_of(std::int64_t t_ns, std::uint32_t id, std::uint8_t count) {
  CanFrame frame;
  frame.t_ns = t_ns;
  frame.id = id;
  frame.size = 8;
  frame.data[0] = count;
  return frame;
}

std::uint64_t refused(const EncoderStream& stream, Refusal reason) {
  return stream.counters().refused[static_cast<std::size_t>(reason)];
}

TEST(EncoderStream, TakesItsFramesAndCountsTheOthers) {
  std::vector<EncoderSample> samples;
  EncoderStream stream({}, [&](const EncoderSample& sample) { samples.push_back(sample); });
  stream.take(frame_of(1'000'000'000, 0x1A0, 10));
  stream.take(frame_of(1'005'000'000, 0x1A1, 99));
  CanFrame extended = frame_of(1'006'000'000, 0x1A0, 99);
  extended.is_extended = true;
  stream.take(extended);
  stream.take(frame_of(1'010'000'000, 0x1A0, 12));
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].t_ns, 1'000'000'000);
  EXPECT_EQ(samples[0].raw, 10);
  EXPECT_DOUBLE_EQ(samples[0].value, 0.00157);
  EXPECT_EQ(samples[0].distance, 0);
  EXPECT_DOUBLE_EQ(samples[1].distance, 2 * 0.000157);
  EXPECT_EQ(stream.counters().other, 2U);
  EXPECT_EQ(stream.counters().accepted, 2U);
  EXPECT_EQ(stream.counters().all_refused(), 0U);
}

TEST(EncoderStream, OfAParameterGroupFromAnySourceTheFirstIsTaken) {
  EncoderSettings settings;
  settings.can_id = 0x18FEBFFE;
  settings.any_source = true;
  EncoderStream stream(settings, {});
  std::int64_t t_ns = 0;
  for (const std::uint32_t id : {0x18FEC00BU, 0x0CFEBF0BU, 0x18FEBF22U, 0x0CFEBF0BU}) {
    CanFrame frame = frame_of(t_ns += 10'000'000, id, 1);
    frame.is_extended = true;
    stream.take(frame);
  }
  EXPECT_EQ(stream.counters().accepted, 2U);
  EXPECT_EQ(stream.counters().other, 2U);
}

TEST(EncoderStream, CountsFramesThatAreNearlyTheEncoders) {
  EncoderSettings settings;
  settings.can_id = 0x18FEBF0B;
  EncoderStream stream(settings, {});
  CanFrame frame = frame_of(0, 0x18FEBF17, 1);
  frame.is_extended = true;
  stream.take(frame);
  EXPECT_EQ(stream.counters().other_source, 1U);
  EXPECT_EQ(stream.counters().last_other_source, 0x18FEBF17U);

  EncoderStream standard({}, {});
  frame.id = 0x1A0;
  standard.take(frame);
  EXPECT_EQ(standard.counters().other_form, 1U);
  EXPECT_EQ(standard.counters().other, 1U);
}

TEST(EncoderStream, AMultiplexedSignalIsInTheFramesThatSelectIt) {
  EncoderSettings settings;
  settings.start_bit = 8;
  settings.length = 16;
  settings.selector = {{.start_bit = 4, .length = 4}, 3};
  EncoderStream stream(settings, {});
  CanFrame frame = frame_of(10'000'000, 0x1A0, 0x30);
  stream.take(frame);
  frame = frame_of(20'000'000, 0x1A0, 0x20);
  stream.take(frame);
  frame = frame_of(30'000'000, 0x1A0, 0x30);
  frame.size = 0;
  stream.take(frame);
  EXPECT_EQ(stream.counters().accepted, 1U);
  EXPECT_EQ(stream.counters().other, 1U);
  EXPECT_EQ(refused(stream, Refusal::size), 1U);
}

TEST(EncoderStream, RefusesValuesThatStandForNone) {
  EncoderSettings settings;
  settings.kind = EncoderKind::speed;
  settings.is_signed = false;
  settings.length = 8;
  settings.scale = 0.01;
  settings.lowest = 0;
  settings.highest = 250;
  settings.unavailable = {77};
  EncoderStream stream(settings, {});
  std::int64_t t_ns = 0;
  for (const std::uint8_t raw : std::initializer_list<std::uint8_t>{10, 77, 255, 251, 250, 10}) {
    stream.take(frame_of(t_ns += 10'000'000, 0x1A0, raw));
  }
  EXPECT_EQ(refused(stream, Refusal::unavailable), 3U);

  settings.highest = std::numeric_limits<double>::infinity();
  EncoderStream unbounded(settings, {});
  unbounded.take(frame_of(t_ns, 0x1A0, 255));
  EXPECT_EQ(unbounded.counters().accepted, 1U) << "a counter's highest value is one";
}

TEST(EncoderStream, ASpeedMayBeAFloatingPointNumber) {
  EncoderSettings settings;
  settings.kind = EncoderKind::speed;
  settings.is_float = true;
  settings.scale = 0.5;
  std::vector<EncoderSample> samples;
  EncoderStream stream(settings, [&](const EncoderSample& sample) { samples.push_back(sample); });
  std::int64_t t_ns = 0;
  for (const float speed : {1.5F, std::nanf(""), HUGE_VALF, -1e30F, 1.5F}) {
    CanFrame frame = frame_of(t_ns += 10'000'000, 0x1A0, 0);
    std::memcpy(frame.data.data(), &speed, sizeof speed);
    stream.take(frame);
  }
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].value, 0.75);
  EXPECT_EQ(refused(stream, Refusal::implausible), 3U);
}

TEST(EncoderStream, AnIdentifierAbove7FFIsExtended) {
  EncoderSettings settings;
  settings.can_id = 0x18FF50E5;
  EncoderStream stream(settings, {});
  CanFrame frame = frame_of(1, 0x18FF50E5, 1);
  stream.take(frame);
  EXPECT_EQ(stream.counters().accepted, 0U);
  frame.is_extended = true;
  stream.take(frame);
  EXPECT_EQ(stream.counters().accepted, 1U);
}

TEST(EncoderStream, CountsRefusalsByReason) {
  int readings = 0;
  EncoderStream stream({}, {}, [&](const Reading&) { ++readings; });
  CanFrame error = frame_of(1, 0x40, 0);
  error.is_error = true;
  stream.take(error);
  CanFrame remote = frame_of(2, 0x1A0, 0);
  remote.is_remote = true;
  stream.take(remote);
  CanFrame cut = frame_of(3, 0x1A0, 0);
  cut.size = 3;
  stream.take(cut);
  EXPECT_EQ(readings, 0);
  stream.take(frame_of(4, 0x1A0, 0));
  stream.take(frame_of(4, 0x1A0, 0));
  CanFrame jump = frame_of(10'000'000, 0x1A0, 0);
  jump.data[3] = 0x40;
  stream.take(jump);
  EXPECT_EQ(readings, 3);
  for (const Refusal reason : {Refusal::error_frame, Refusal::remote, Refusal::size, Refusal::time,
                               Refusal::implausible}) {
    EXPECT_EQ(refused(stream, reason), 1U) << kRefusalNames[static_cast<std::size_t>(reason)];
  }
  EXPECT_EQ(stream.counters().accepted, 1U);
  EXPECT_EQ(stream.counters().all_refused(), 5U);
}

TEST(EncoderStream, ReadsAnFdFrame) {
  EncoderSettings settings;
  settings.start_bit = 480;
  EncoderStream stream(settings,
                       [](const EncoderSample& sample) { EXPECT_EQ(sample.raw, 0x1234); });
  CanFrame frame = frame_of(1, 0x1A0, 0);
  frame.size = 64;
  frame.data[60] = 0x34;
  frame.data[61] = 0x12;
  stream.take(frame);
  EXPECT_EQ(stream.counters().accepted, 1U);
}

/// The simulator's encoder, in every layout that it draws, on a robot that drives a circle.
TEST(EncoderStream, MeasuresTheSimulatorsWay) {
  std::vector<Pose> knots;
  for (int i = 0; i <= 8000; ++i) {
    const double angle = 0.0025 * i / 3;
    knots.push_back(
        {{3 * std::sin(angle), 3 - 3 * std::cos(angle), 0}, from_roll_pitch_yaw(0, 0, angle)});
  }
  const Motion motion(std::move(knots), 0, 2'500'000);
  std::set<std::tuple<int, int>> layouts;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const EncoderSettings layout = draw_robot(seed).encoder;
    layouts.insert({layout.start_bit, layout.length});
    SimulatedEncoder encoder(motion, layout, {.scale_error = 0, .slope_slip = 0}, 5);
    EncoderSample last;
    EncoderStream stream(layout, [&](const EncoderSample& sample) { last = sample; });
    encoder.frame(0);
    double before_first = 0;
    for (std::int64_t t = 10'000'000; t <= 20'000'000'000; t += 10'000'000) {
      const CanData data = encoder.frame(t);
      if (before_first == 0) before_first = encoder.turned();
      CanFrame frame = frame_of(t, static_cast<std::uint32_t>(layout.can_id), 0);
      frame.is_extended = layout.has_extended_id();
      std::copy(data.begin(), data.end(), frame.data.begin());
      stream.take(frame);
    }
    EXPECT_EQ(stream.counters().all_refused(), 0U);
    EXPECT_NEAR(last.distance, encoder.turned() - before_first, 0.01) << seed;
    EXPECT_GT(last.distance, 19.9);
  }
  EXPECT_EQ(layouts.size(), 6U);
}

TEST(EncoderStream, AllocatesNothing) {
  double distance = 0;
  EncoderStream stream({}, [&](const EncoderSample& sample) { distance = sample.distance; });
  const std::size_t before = test::allocations();
  for (int i = 0; i < 1000; ++i) {
    stream.take(frame_of(std::int64_t{i} * 10'000'000, 0x1A0,
                         static_cast<std::uint8_t>(i % 7 == 0 ? i : i / 9)));
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_NE(distance, 0);
}

}  // namespace
}  // namespace scree::encoder
