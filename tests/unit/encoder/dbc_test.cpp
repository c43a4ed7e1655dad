#include "scree/drivers/encoder/dbc.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <random>

#include "unit/temporary_folder.hpp"

namespace scree::encoder {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kDbc = R"(VERSION "2"
NS_ :
 CM_
BU_: A B
BO_ 464 WHEEL_SPEEDS: 8 VSA
 SG_ FRONT_LEFT : 7|15@0+ (0.01,0) [0|250] "kph" EON
 SG_ FRONT_RIGHT: 8|15@0- (1E-002,-40) [0|250] "km/h" EON

BO_ 2566869221 Drive: 8 Vector__XXX
 SG_ Ticks : 12|20@1- (1,0) [0|0] "" Vector__XXX
 SG_ Way : 32 | 32 @1+ ( +0.5 , 1.5 ) [0|0] "m" A,B
 SG_ Real : 0|32@1- (1,0) [0|0] "m/s" A
 SG_ Short : 0|16@1- (1,0) [0|0] "m/s" A
 SG_ Mode M : 0|4@1+ (1,0) [0|0] "" A
 SG_ Hidden m3 : 8|16@1+ (1,0) [0|0] "" A
 SG_ Both m2M : 8|16@1+ (1,0) [0|0] "" A
 SG_ Long : 0|65@1+ (1,0) [0|0] "" A
 SG_ Outside : 500|32@1+ (1,0) [0|0] "" A
 SG_ Flat : 0|8@1+ (0,0) [0|0] "" A
 SG_ Odd : 0;8@1+ (1,0)

CM_ SG_ 464 FRONT_LEFT "many lines,
BO_ 1 IN_A_COMMENT: 8 A
 SG_ Ghost : 0|8@1+ (1,0) [0|0] \"x\" A
to here";
BO_ 1 AFTER: 8 A
 SG_ Late : 0|8@1+ (1,0) [0|0] "" A
SIG_VALTYPE_ 2566869221 Real : 1;
SIG_VALTYPE_ 464 FRONT_LEFT : 0;
SIG_VALTYPE_ 2566869221 Short : 1;
)";

DbcSignal signal_of(std::string_view name) {
  const auto signal = find_signal(kDbc, name, "robot.dbc");
  EXPECT_TRUE(signal) << signal.error().message;
  return signal.value_or(DbcSignal{});
}

std::string error_of(std::string_view name, std::string_view dbc = kDbc) {
  const auto signal = find_signal(dbc, name, "robot.dbc");
  return signal ? "no error" : signal.error().message;
}

TEST(Dbc, ReadsASignal) {
  const DbcSignal left = signal_of("WHEEL_SPEEDS.FRONT_LEFT");
  EXPECT_EQ(left.id, 464U);
  EXPECT_FALSE(left.is_extended);
  EXPECT_EQ(left.start_bit, 7);
  EXPECT_EQ(left.length, 15);
  EXPECT_EQ(left.byte_order, ByteOrder::big_endian);
  EXPECT_FALSE(left.is_signed);
  EXPECT_EQ(left.factor, 0.01);
  EXPECT_EQ(left.offset, 0);
  EXPECT_EQ(left.unit, "kph");
  const DbcSignal right = signal_of("WHEEL_SPEEDS.FRONT_RIGHT");
  EXPECT_TRUE(right.is_signed);
  EXPECT_EQ(right.factor, 0.01);
  EXPECT_EQ(right.offset, -40);
  const DbcSignal way = signal_of("Drive.Way");
  EXPECT_EQ(way.id, 0x18FF50E5U);
  EXPECT_TRUE(way.is_extended);
  EXPECT_EQ(way.start_bit, 32);
  EXPECT_EQ(way.byte_order, ByteOrder::little_endian);
  EXPECT_EQ(way.factor, 0.5);
  EXPECT_EQ(way.offset, 1.5);
  EXPECT_EQ(signal_of("Drive.Mode").length, 4);
  EXPECT_EQ(signal_of("AFTER.Late").id, 1U);
}

TEST(Dbc, LineEndsOfDosChangeNothing) {
  std::string dos;
  for (const char c : kDbc) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const auto signal = find_signal(dos, "WHEEL_SPEEDS.FRONT_LEFT", "robot.dbc");
  ASSERT_TRUE(signal);
  EXPECT_EQ(signal->unit, "kph");
}

TEST(Dbc, SaysWhyASignalCannotBeUsed) {
  EXPECT_THAT(error_of("Drive.Hidden"), HasSubstr("multiplexed"));
  EXPECT_THAT(error_of("Drive.Both"), HasSubstr("multiplexed"));
  EXPECT_THAT(error_of("Drive.Short"), HasSubstr("has 16 bits, and is to be a floating-point"));
  EXPECT_THAT(error_of("Drive.Long"), HasSubstr("64 bits"));
  EXPECT_THAT(error_of("Drive.Outside"), HasSubstr("outside of any frame"));
  EXPECT_THAT(error_of("Drive.Flat"), HasSubstr("factor"));
  EXPECT_THAT(error_of("Drive.Odd"), HasSubstr("cannot be read"));
  for (const char* name : {"", ".", "Drive", "Drive.", ".Way"}) {
    EXPECT_THAT(error_of(name), HasSubstr("MESSAGE.SIGNAL")) << name;
  }
}

TEST(Dbc, ReadsRangeValuesAndSelector) {
  constexpr std::string_view kMore =
      "BO_ 288 W: 8 X\n SG_ Mode M : 0|4@1+ (1,0) [0|15] \"\" X\n"
      " SG_ V m3 : 8|8@1+ (0.01,0) [0|2.5] \"m/s\" X\n SG_ U m4 : 8|8@1+ (1,0) [0|x] \"\" X\n"
      " SG_ R m5 : 8|8@1+ (1,0) [0|1] \"\" X\n"
      "VAL_ 288 V 255 \"SNA\" 254 \"Sensor error\" 3 \"default\" 4 \"no error\" ;\nVAL_ 288 U 1 "
      "\"NA\" ;\n"
      "SG_MUL_VAL_ 288 V Mode 3-3;\nSG_MUL_VAL_ 288 R Mode 5-5, 7-9;\n";
  const auto signal = find_signal(kMore, "W.V", "robot.dbc");
  ASSERT_TRUE(signal) << signal.error().message;
  EXPECT_EQ(signal->low, 0);
  EXPECT_EQ(signal->high, 2.5);
  EXPECT_EQ(signal->unavailable, (std::vector<std::int64_t>{255, 254}));
  ASSERT_TRUE(signal->selector);
  EXPECT_EQ(signal->selector->length, 4);
  EXPECT_EQ(signal->selector->value, 3);
  const auto without = find_signal(kMore, "W.U", "robot.dbc");
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_EQ(without->low, without->high) << "what is no range says nothing";
  EXPECT_THAT(error_of("W.R", kMore), HasSubstr("ranges of values"));
}

TEST(Dbc, NamesWhatIsNearAMistypedName) {
  EXPECT_THAT(error_of("WHEEL_SPEEDS.FRONT_LEFD"),
              AllOf(HasSubstr("robot.dbc: message WHEEL_SPEEDS has no signal FRONT_LEFD"),
                    HasSubstr("the nearest are FRONT_LEFT, FRONT_RIGHT")));
  EXPECT_THAT(error_of("wheel_speed.FRONT_LEFT"),
              AllOf(HasSubstr("no message wheel_speed"), HasSubstr("are WHEEL_SPEEDS, ")));
  EXPECT_THAT(error_of("IN_A_COMMENT.Ghost"),
              AllOf(HasSubstr("no message"), Not(HasSubstr("Ghost"))));
  EXPECT_THAT(error_of("A.B", "not a file of that kind"), HasSubstr("no DBC file"));
  EXPECT_THAT(error_of("A.B", "VERSION \"\"\n\nNS_ :\n"), HasSubstr("no DBC file"));
}

TEST(Dbc, ATextThatBreaksOffNamesTheLineAndWhatItLacks) {
  const std::string_view line = " SG_ S : 0|8@1+ (1,0) [0|0] \"m/s\"";
  for (const auto& [length, lacks] : {std::pair{9, "a number"},
                                      {12, "a '@'"},
                                      {19, "a number"},
                                      {20, "a ')'"},
                                      {31, "a text in quotes"}}) {
    const std::string text = "BO_ 416 M: 8 X\n\n" + std::string(line.substr(0, length));
    EXPECT_THAT(error_of("M.S", std::string_view(text)),
                AllOf(HasSubstr("robot.dbc:3: M.S cannot be read, it lacks "), HasSubstr(lacks)));
  }
  EXPECT_THAT(
      error_of("M.S", "BO_ 1 M: 8 X\nBO_ 2 Other-Name: 8 X\n SG_ S : 0|8@1+ (1,0) [0|0] \"\""),
      HasSubstr("robot.dbc:2: the line cannot be read, it lacks a ':'"))
      << "its signals are not those of the message before";
  for (const char* quotes : {"", " \"km/h\"", " \"km/h", "\n\"\"\n\""}) {
    const std::string text =
        "VERSION \"\"\nCM_ \"from C:\\\";\nBO_ 1 M: 8 X\n" + std::string(quotes) + "\n";
    EXPECT_THAT(error_of("M.S", std::string_view(text)),
                HasSubstr("robot.dbc:2: the text in quotes that begins here has no end"));
  }
}

TEST(Dbc, FloatingPointSignalsAreRead) {
  EXPECT_TRUE(signal_of("Drive.Real").is_float);
  EXPECT_FALSE(signal_of("WHEEL_SPEEDS.FRONT_LEFT").is_float);
}

TEST(Dbc, LongNamesAreThoseThatEveryToolShows) {
  constexpr std::string_view kLong =
      "BO_ 2 SHORT_0001: 8 X\n SG_ S_0003 : 8|8@1- (1,0) [0|0] \"\" X\n"
      "BO_ 3 SHORT_0002: 8 X\n SG_ S_0003 : 16|8@1- (1,0) [0|0] \"\" X\n"
      "BA_ \"SystemMessageLongSymbol\" BO_ 2 \"MessageOfMoreThan32Characters\";\n"
      "BA_ \"SystemSignalLongSymbol\" SG_ 2 S_0003 \"SignalOfMoreThan32Characters\";\n";
  for (const char* name : {"MessageOfMoreThan32Characters.SignalOfMoreThan32Characters",
                           "SHORT_0001.S_0003", "SHORT_0001.SignalOfMoreThan32Characters"}) {
    const auto signal = find_signal(kLong, name, "robot.dbc");
    ASSERT_TRUE(signal) << signal.error().message;
    EXPECT_EQ(signal->start_bit, 8);
  }
  EXPECT_THAT(error_of("SHORT_0001.Nothing", kLong),
              HasSubstr("the nearest are SignalOfMoreThan32Characters"));
  EXPECT_EQ(find_signal(kLong, "SHORT_0002.S_0003", "robot.dbc")->start_bit, 16);
}

TEST(Dbc, TextsOfOtherProgramsAreReadOrNamed) {
  const std::string line = " SG_ Speed_\xC3\xBC : 0|16@1+ (0.01,0) [0|655] \"km/h\" X";
  const std::string other = " SG_ Other : 16|16@1+ (1,0) [0|1] \"say SG_ no\" X";
  const auto found = find_signal(
      "\xEF\xBB\xBF"
      "BO_ 1 M: 8 X" +
          other + line + " BO_ 2 N: 8 X" + other + "\n",
      "M.Speed_\xC3\xBC", "robot.dbc");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->unit, "km/h");
  EXPECT_EQ(found->id, 1U);
  EXPECT_THAT(error_of("M.S", std::string_view("\xFF\xFE"
                                               "B\0O\0",
                                               6)),
              HasSubstr("save it as UTF-8"));
}

TEST(Dbc, AnyBytesAreSafe) {
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    std::string text(kDbc);
    for (int i = 0; i < 30; ++i) text[random() % text.size()] = static_cast<char>(random());
    text.resize(random() % text.size());
    const auto signal = find_signal(text, "Drive.Way", "robot.dbc");
    if (signal) {
      EXPECT_LE(signal->length, 64);
    }
  }
}

EncoderSettings settings_for(const std::string& signal, EncoderKind kind, double scale) {
  EncoderSettings settings;
  settings.dbc = "robot.dbc";
  settings.signal = signal;
  settings.kind = kind;
  settings.scale = scale;
  return settings;
}

TEST(WithDbc, FillsInTheSettings) {
  const TemporaryFolder folder;
  folder.write("robot.dbc", kDbc);
  const auto filled =
      with_dbc(settings_for("Drive.Way", EncoderKind::counter, 1.01), folder / "robot.toml");
  ASSERT_TRUE(filled) << filled.error().message;
  EXPECT_EQ(filled->can_id, 0x18FF50E5);
  EXPECT_TRUE(filled->has_extended_id());
  EXPECT_EQ(filled->start_bit, 32);
  EXPECT_EQ(filled->length, 32);
  EXPECT_FALSE(filled->is_signed);
  EXPECT_EQ(filled->factor, 0.5);
  EXPECT_EQ(filled->offset, 1.5);
  EXPECT_EQ(filled->scale, 1.01);
  const EncoderSettings without;
  EXPECT_EQ(with_dbc(without, "/nonexistent/robot.toml")->can_id, without.can_id);
}

TEST(WithDbc, UnitsAreComparedWithoutCaseAndBlanks) {
  const TemporaryFolder folder;
  for (const char* unit : {"KPH", "Kph", "Km/h", "km / h", "[km/h]", "km/hr", "kilometers per hour",
                           "kmph", "(km/h)", "kph.", "km-h", "kmh-1", "km.h-1", "km·h-1", "km/h\t",
                           "kilometres per hour", "kilometer pro stunde"}) {
    folder.write("robot.dbc",
                 fmt::format("BO_ 1 M: 8 X\n SG_ S : 0|16@1+ (0.01,0) [0|1] \"{}\" X\n", unit));
    const auto filled = with_dbc(settings_for("M.S", EncoderKind::speed, 1), folder / "robot.toml");
    ASSERT_FALSE(filled) << unit;
    EXPECT_THAT(filled.error().message, HasSubstr("is 0.277778 m/s"));
  }
}

/// Whether a signal's unit and encoder.scale go together.
bool fits(EncoderKind kind, const char* unit, double scale) {
  const TemporaryFolder folder;
  folder.write("robot.dbc",
               fmt::format("BO_ 1 M: 8 X\n SG_ S : 0|16@1+ (1,0) [0|1] \"{}\" X\n", unit));
  return with_dbc(settings_for("M.S", kind, scale), folder / "robot.toml").has_value();
}

TEST(WithDbc, AScaleThatCannotBeForTheUnitIsRefused) {
  const auto is_taken = [](const char* unit, double scale) {
    return fits(EncoderKind::speed, unit, scale);
  };
  for (const char* unit :
       {"mi/h", "knots", "ft/s", "m/min", "rpm", "U/min", "deg/s", "kts", "fps", "inch/s", "um/s",
        "r/min", "min-1", "°/s", "0.1 km/h", "pulses/s", "m/s^2", "furlongs"}) {
    EXPECT_FALSE(is_taken(unit, 1)) << unit;
  }
  EXPECT_TRUE(is_taken("meters / second", 1));
  for (const char* unit : {"m s-1", "metres/s", "metre per second", "m/sekunde", "", "-", "1"}) {
    EXPECT_TRUE(is_taken(unit, 1)) << unit;
  }
  EXPECT_TRUE(is_taken("furlongs", 201)) << "nobody knows";
  EXPECT_TRUE(is_taken("rpm", 0.02)) << "a wheel of 1.2 m around";
  EXPECT_TRUE(is_taken("rpm", 0.0004)) << "its motor";
}

TEST(WithDbc, AScaleThatCannotBeForTheUnitOfACounterIsRefused) {
  const auto is_taken = [](const char* unit, double scale) {
    return fits(EncoderKind::counter, unit, scale);
  };
  for (const char* unit : {"inch", "ft", "mi", "deg", "°", "mm", "ticks", "m/s"}) {
    EXPECT_FALSE(is_taken(unit, 1)) << unit;
  }
  EXPECT_TRUE(is_taken("m", 1));
  EXPECT_TRUE(is_taken("rev", 1)) << "a wheel of 1 m around";
  EXPECT_TRUE(is_taken("inch", 0.0254));
  EXPECT_TRUE(is_taken("ticks", 0.00078));
}

TEST(WithDbc, AFloatingPointNumberCanOnlyBeASpeed) {
  const TemporaryFolder folder;
  folder.write("robot.dbc", kDbc);
  const auto speed =
      with_dbc(settings_for("Drive.Real", EncoderKind::speed, 1), folder / "robot.toml");
  ASSERT_TRUE(speed) << speed.error().message;
  EXPECT_TRUE(speed->is_float);
  EXPECT_THAT(with_dbc(settings_for("Drive.Real", EncoderKind::counter, 1), folder / "robot.toml")
                  .error()
                  .message,
              HasSubstr("only a speed can be one"));
}

TEST(WithDbc, TheNullAddressOfJ1939StandsForAnySource) {
  const TemporaryFolder folder;
  folder.write("robot.dbc", "BO_ 2566832126 EBC2: 8 X\n SG_ S : 0|16@1+ (1,0) [0|1] \"m/s\" X\n");
  const auto filled =
      with_dbc(settings_for("EBC2.S", EncoderKind::speed, 1), folder / "robot.toml");
  ASSERT_TRUE(filled) << filled.error().message;
  EXPECT_TRUE(filled->any_source);
  EXPECT_EQ(0x18FEBFFE & filled->id_mask(), 0x0CFEBF0B & filled->id_mask());
  EXPECT_NE(0x18FEBFFE & filled->id_mask(), 0x18FEC00B & filled->id_mask());
}

TEST(WithDbc, AMissingFileIsOneSentence) {
  const auto filled =
      with_dbc(settings_for("A.B", EncoderKind::counter, 1), "/nonexistent/robot.toml");
  ASSERT_FALSE(filled);
  EXPECT_THAT(filled.error().message, HasSubstr("robot.dbc"));
}

}  // namespace
}  // namespace scree::encoder
