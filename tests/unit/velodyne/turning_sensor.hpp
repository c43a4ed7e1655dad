#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "packet_builder.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"

namespace scree::velodyne {

inline constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

/// What is kept of a sweep.
struct Seen {
  std::int64_t begin_ns, end_ns;
  std::size_t points;
  std::uint32_t packets;
  bool is_whole, ends_turn, started_over;
  std::uint64_t turn;
};

/// A VLP-16 that turns evenly and sees a wall 5 m away, and the stream that listens to it.
class TurningSensor {
public:
  explicit TurningSensor(const LidarSettings& settings = {}, int parts = 1)
      : stream_(std::make_unique<LidarStream>(
            settings, [this](Sweep& sweep) { see(sweep); }, LidarStream::OnPacket(), parts)) {}

  ReturnMode mode = ReturnMode::strongest;
  Product product = Product::vlp16;
  double turns_per_second = 10;
  std::int64_t stamp_at_start_ns = 100 * kSecond;
  std::int64_t delay_ns = 100'000;
  std::vector<Seen> seen;

  PacketBuilder packet() const {
    PacketBuilder packet;
    packet.mode(mode).product(product).all_shots(2500, 30);
    const int pairs = mode == ReturnMode::dual ? 2 : 1;
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const auto at = elapsed_ns_ + static_cast<std::int64_t>(block) / pairs * kBlockNs;
      const double turns = turns_per_second * static_cast<double>(at) * 1e-9;
      packet.azimuth(block, static_cast<int>(36000 * (turns - std::floor(turns))) % kFullTurn);
    }
    packet.timestamp(
        static_cast<std::uint32_t>((stamp_at_start_ns + elapsed_ns_) / 1000 % kHourUs));
    return packet;
  }
  std::int64_t duration() const { return packet_duration_ns(mode); }
  void skip() { elapsed_ns_ += duration(); }
  void send() { send(packet()); }
  void send(const PacketBuilder& packet) {
    stream_->take(packet.bytes(), kEpoch + elapsed_ns_ + duration() + delay_ns);
    skip();
  }
  void send_for(double seconds) {
    for (const auto end = elapsed_ns_ + static_cast<std::int64_t>(seconds * 1e9);
         elapsed_ns_ < end;) {
      send();
    }
  }
  /// Packets of a sensor that stands with its azimuth about zero, now before it and now behind.
  void send_wavering_at_zero(int packets) {
    std::mt19937 random(4);
    for (int i = 0; i < packets; ++i) {
      PacketBuilder wavering = packet();
      for (std::size_t block = 0; block < kBlocks; ++block) {
        wavering.azimuth(block, random() % 2 == 0 ? 35999 : 1);
      }
      send(wavering);
    }
  }
  LidarStream& stream() { return *stream_; }
  const LidarCounters& counters() const { return stream_->counters(); }
  std::uint64_t refused(Refusal reason) const {
    return counters().refused[static_cast<std::size_t>(reason)];
  }
  std::int64_t elapsed_ns() const { return elapsed_ns_; }

private:
  void see(const Sweep& sweep) {
    seen.push_back({sweep.end_ns + (sweep.points.empty() ? 0 : sweep.time_ns[0]), sweep.end_ns,
                    sweep.points.size(), sweep.packets, sweep.is_whole, sweep.ends_turn,
                    sweep.started_over, sweep.turn});
    for (std::size_t i = 1; i < sweep.time_ns.size(); ++i) {
      EXPECT_GE(sweep.time_ns[i], sweep.time_ns[i - 1]);
    }
    if (!sweep.time_ns.empty()) {
      EXPECT_EQ(sweep.time_ns.back(), 0);
    }
  }

  std::int64_t elapsed_ns_ = 0;
  std::unique_ptr<LidarStream> stream_;
};

}  // namespace scree::velodyne
