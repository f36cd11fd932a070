#include "generators/scenario_file/radio_trace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fleetproof::radio_trace_test {
namespace {

using testing::HasSubstr;

const std::string kHeading = "sender,receiver,t_send_s,t_recv_s\n";

std::string error_of(const std::string& text) {
  try {
    parse_radio_trace(text, "r.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RadioTraceFile, ReadsWhatWasRecorded) {
  const RadioTrace trace = parse_radio_trace(
      "\xEF\xBB\xBF# measured in hall 3\r\n" + kHeading +
          "1,0,1700000000.250000001,1700000000.300000002\r\n\r\n0, 1, 1700000000.5, lost\n0,1,1700000000,\n" +
          "0,1,1700000000.25,1700000002\n",
      "r.csv");
  const AgvId a{0U}, b{1U};
  const RadioTrace expected{{a, b, Duration{0}, std::nullopt},
                            {a, b, Duration{250'000'000}, Duration{1'750'000'000}},
                            {a, b, Duration{500'000'000}, std::nullopt},
                            {b, a, Duration{250'000'001}, Duration{50'000'001}}};
  EXPECT_EQ(trace, expected);
}

TEST(RadioTraceFile, ErrorsNamePlaceColumnValueAndRemedy) {
  EXPECT_THAT(error_of(""), HasSubstr("r.csv: holds no message"));
  EXPECT_THAT(error_of(kHeading), HasSubstr("r.csv: holds no message"));
  EXPECT_THAT(error_of("0,1,2,3\n"),
              HasSubstr("r.csv:1: \"0,1,2,3\" is no heading; expected the line sender,receiver,t_send_s,t_recv_s"));
  EXPECT_THAT(error_of(kHeading + "0,1,2\n"), HasSubstr("r.csv:2: has 3 fields; expected four"));
  EXPECT_THAT(error_of(kHeading + "0,1,2,3,4\n"), HasSubstr("r.csv:2: has 5 fields"));
  EXPECT_THAT(error_of(kHeading + "\nagv-1,1,2,3\n"),
              HasSubstr("r.csv:3: sender is \"agv-1\"; an AGV is a whole number from 0 to 65535"));
  EXPECT_THAT(error_of(kHeading + "0,65536,2,3\n"), HasSubstr("r.csv:2: receiver is \"65536\""));
  EXPECT_THAT(error_of(kHeading + "0,-1,2,3\n"), HasSubstr("r.csv:2: receiver is \"-1\""));
  EXPECT_THAT(error_of(kHeading + "1,1,2,3\n"), HasSubstr("r.csv:2: receiver is \"1\"; no AGV sends to itself"));
  EXPECT_THAT(error_of(kHeading + "0,1,two,3\n"),
              HasSubstr("r.csv:2: t_send_s is \"two\"; a time is a number of seconds"));
  EXPECT_THAT(error_of(kHeading + "0,1,1e3,3\n"), HasSubstr("t_send_s is \"1e3\""));
  EXPECT_THAT(error_of(kHeading + "0,1,,3\n"), HasSubstr("t_send_s is \"\""));
  EXPECT_THAT(error_of(kHeading + "0,1,99999999999,3\n"), HasSubstr("t_send_s is \"99999999999\""));
  EXPECT_THAT(error_of(kHeading + "0,1,9000000000,\n"),
              HasSubstr("r.csv:2: t_send_s is \"9000000000\"; a time is a number of seconds"));
  EXPECT_THAT(error_of(kHeading + "0,1,9999999999.999999999,\n"), HasSubstr("t_send_s is \"9999999999.999999999\""));
  EXPECT_THAT(error_of(kHeading + "0,1,2000000000,\n\n0,1,0,\n"),
              HasSubstr("r.csv:2: t_send_s is more than 1e9 s after the first"));
  EXPECT_THAT(error_of(kHeading + "0,1,0,1000000001\n"),
              HasSubstr("r.csv:2: t_recv_s is \"1000000001\"; it is more than 1e9 s after t_send_s"));
  EXPECT_THAT(error_of(kHeading + "0,1,2,1.9\n"), HasSubstr("r.csv:2: t_recv_s is \"1.9\"; it is before t_send_s"));
  EXPECT_THAT(error_of(kHeading + "0,1,2,Lost\n"), HasSubstr("r.csv:2: t_recv_s is \"Lost\""));
  try {
    read_radio_trace("no-such-file.csv");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no-such-file.csv"));
  }
}

}  // namespace
}  // namespace fleetproof::radio_trace_test
