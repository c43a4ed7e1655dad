#include "simulator/mti.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scree/drivers/xsens/start_up.hpp"
#include "unit/xsens/message_builder.hpp"

namespace scree {
namespace {

using test::ByteVector;
using test::message;
using ::testing::IsEmpty;

TEST(SimulatedMti, IsStartedByTheDriver) {
  ImuSettings settings;
  settings.rate = 200;
  xsens::StartUp start(settings);
  SimulatedMti mti;
  start.begin(0);
  while (start.state() == xsens::StartUp::State::working) {
    const auto request = start.take_output();
    ASSERT_FALSE(request.empty()) << "it waits for an answer in vain";
    start.take(mti.take(request), 0);
  }
  EXPECT_EQ(start.state(), xsens::StartUp::State::measuring) << start.problem();
  EXPECT_EQ(start.note(), "");
  EXPECT_TRUE(mti.is_measuring());
}

TEST(SimulatedMti, HearsOnlyGoToConfigWhileItMeasures) {
  SimulatedMti mti;
  EXPECT_TRUE(mti.is_measuring());
  EXPECT_THAT(mti.take(message(0x00, {})), IsEmpty());
  EXPECT_EQ(mti.take(message(0x30, {})), message(0x31, {}));
  EXPECT_FALSE(mti.is_measuring());
  EXPECT_EQ(mti.take(message(0x18, {0x0A})), message(0x19, {}));
  EXPECT_EQ(mti.take(message(0xD0, {})), message(0x42, {4}));
  EXPECT_EQ(mti.take(message(0x40, {})), message(0x41, {}));
  EXPECT_TRUE(mti.is_measuring());
}

TEST(SimulatedMti, FindsRequestsAmongOtherBytes) {
  SimulatedMti mti;
  ByteVector bytes = {0xFA, 0x00, 0x55};
  const ByteVector request = message(0x30, {});
  bytes.insert(bytes.end(), request.begin(), request.end() - 1);
  EXPECT_THAT(mti.take(bytes), IsEmpty());
  EXPECT_EQ(mti.take(ByteVector{request.back()}), message(0x31, {}));
}

}  // namespace
}  // namespace scree
