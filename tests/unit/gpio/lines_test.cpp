#include "scree/drivers/gpio/lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace scree::gpio {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string error_of(std::string GpioSettings::*line, const char* name) {
  GpioSettings settings;
  settings.*line = name;
  const auto lines = Lines::open(settings);
  return lines ? "no error" : lines.error().message;
}

TEST(Lines, NoneIsOpenedThatIsNotNamed) {
  const auto lines = Lines::open({});
  ASSERT_TRUE(lines) << lines.error().message;
  EXPECT_FALSE(lines->pps || lines->stop || lines->heartbeat);
}

TEST(Lines, AMissingChipIsOneSentenceThatNamesTheKey) {
  EXPECT_THAT(error_of(&GpioSettings::pps, "nochip:4"),
              AllOf(HasSubstr("gpio.pps = \"nochip:4\""), HasSubstr("no GPIO chip nochip")));
  EXPECT_THAT(error_of(&GpioSettings::stop, "/dev/nochip:STOP"),
              AllOf(HasSubstr("gpio.stop"), HasSubstr("no GPIO chip /dev/nochip")));
  EXPECT_THAT(error_of(&GpioSettings::heartbeat, "nochip:4"), HasSubstr("gpio.heartbeat"));
  EXPECT_THAT(error_of(&GpioSettings::stop, "/dev/null:1"), HasSubstr("no GPIO chip /dev/null"));
}

TEST(Lines, ANameHasTwoParts) {
  for (const char* name : {"17", "gpiochip0", "gpiochip0:", ":17", ":"}) {
    EXPECT_THAT(error_of(&GpioSettings::stop, name), HasSubstr("must be CHIP:LINE")) << name;
  }
}

TEST(CheckName, OpensNothing) {
  for (const char* name : {"", "nochip:4", "/dev/nochip:HEARTBEAT"}) EXPECT_TRUE(check_name(name));
  EXPECT_EQ(check_name("17").error().message, "\"17\" must be CHIP:LINE, as gpiochip0:17 is");
}

TEST(CheckLines, SaysWhatOpenWouldSay) {
  EXPECT_TRUE(check_lines({}));
  for (const auto line : {&GpioSettings::pps, &GpioSettings::stop, &GpioSettings::heartbeat}) {
    GpioSettings settings;
    settings.*line = "nochip:4";
    EXPECT_EQ(check_lines(settings).error().message, error_of(line, "nochip:4"));
  }
}

TEST(HolderOf, SaysWhatIsWrongWithAName) {
  EXPECT_THAT(holder_of("nochip:4").error().message, HasSubstr("no GPIO chip nochip"));
  EXPECT_THAT(holder_of("17").error().message, HasSubstr("must be CHIP:LINE"));
}

TEST(EdgeHostNs, KnowsTheClockOfTheStamp) {
  constexpr std::int64_t kUp = 86'400'000'000'000, kHost = 1'598'601'600'000'000'000;
  constexpr std::int64_t kAge = 3'000'000;
  EXPECT_EQ(edge_host_ns(kUp - kAge, kUp, kHost), kHost - kAge);
  EXPECT_EQ(edge_host_ns(kHost - kAge, kUp, kHost), kHost - kAge);
}

}  // namespace
}  // namespace scree::gpio
