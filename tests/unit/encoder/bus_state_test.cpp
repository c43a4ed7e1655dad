#include "scree/drivers/encoder/bus_state.hpp"

#include <gtest/gtest.h>

#include <cerrno>

namespace scree::encoder {
namespace {

/// An error frame as the kernel makes it (linux/can/error.h).
CanFrame error(std::uint32_t kinds, std::uint8_t controller = 0) {
  CanFrame frame;
  frame.is_error = true;
  frame.id = kinds;
  frame.size = 8;
  frame.data[1] = controller;
  return frame;
}

TEST(BusMonitor, FollowsTheControllerToBusOffAndBack) {
  BusMonitor monitor;
  EXPECT_EQ(monitor.state(), BusState::silent);
  monitor.take(CanFrame());
  EXPECT_EQ(monitor.state(), BusState::active);
  monitor.take(error(0x4, 0x08));  // too many errors when sending: warning
  EXPECT_EQ(monitor.state(), BusState::warning);
  monitor.take(CanFrame());
  EXPECT_EQ(monitor.state(), BusState::warning);
  monitor.take(error(0x4, 0x10));  // passive, receiving
  EXPECT_EQ(monitor.state(), BusState::passive);
  monitor.take(error(0x40));
  EXPECT_EQ(monitor.state(), BusState::bus_off);
  monitor.take(error(0x100));
  EXPECT_EQ(monitor.state(), BusState::active);
  monitor.take(error(0x4, 0x20));
  monitor.take(error(0x4, 0x40));  // active again
  EXPECT_EQ(monitor.state(), BusState::active);
  EXPECT_EQ(monitor.counters().bus_off, 1U);
  EXPECT_EQ(monitor.counters().restarts, 1U);
  EXPECT_EQ(monitor.counters().frames, 2U);
  EXPECT_EQ(monitor.counters().error_frames, 6U);
}

TEST(BusMonitor, AFrameEndsBusOffThatNobodyReportedTheEndOf) {
  BusMonitor monitor;
  monitor.take(error(0x40));
  monitor.take(CanFrame());
  EXPECT_EQ(monitor.state(), BusState::active);
}

TEST(BusMonitor, CountsKindsOfErrors) {
  BusMonitor monitor;
  monitor.take(error(0x2 | 0x8));
  monitor.take(error(0x20));
  monitor.take(error(0x4, 0x01));
  CanFrame cut = error(0x4, 0x01);
  cut.size = 0;
  monitor.take(cut);
  EXPECT_EQ(monitor.counters().lost_arbitrations, 1U);
  EXPECT_EQ(monitor.counters().protocol_errors, 1U);
  EXPECT_EQ(monitor.counters().missing_acknowledges, 1U);
  EXPECT_EQ(monitor.counters().overflows, 1U);
  EXPECT_EQ(monitor.state(), BusState::silent);
}

TEST(BusMonitor, KnowsAnInterfaceThatIsDownFromOneThatIsGone) {
  BusMonitor monitor;
  monitor.failed(ENETDOWN);
  EXPECT_EQ(monitor.state(), BusState::down);
  monitor.is_up();
  EXPECT_EQ(monitor.state(), BusState::silent);
  monitor.failed(ENODEV);
  EXPECT_EQ(monitor.state(), BusState::absent);
  monitor.is_up();
  monitor.take(CanFrame());
  monitor.is_up();
  EXPECT_EQ(monitor.state(), BusState::active);
  EXPECT_EQ(monitor.counters().downs, 1U);
  EXPECT_EQ(monitor.counters().removals, 1U);
}

TEST(BusMonitor, EveryStateHasANameAndAllButActiveAdvice) {
  for (std::size_t i = 0; i < kBusStates; ++i) {
    EXPECT_FALSE(kBusStateNames[i].empty());
    EXPECT_EQ(kBusStateAdvice[i].empty(), static_cast<BusState>(i) == BusState::active);
  }
}

}  // namespace
}  // namespace scree::encoder
