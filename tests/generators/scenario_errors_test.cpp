// What a person does wrong in a scenario file, and that nothing a machine does to it gets past an InputError.
#include <gtest/gtest.h>

#include <set>

#include "core/base/error.hpp"
#include "damage.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "independent_check.hpp"

namespace fleetproof::scenario_errors_test {
namespace {

const std::string& figure4() {
  static const std::string text = independent::file_text(independent::source_file("tests/scenarios/figure4.json"));
  return text;
}

void import(const std::string& text) { parse_scenario(text, "s.json"); }

std::string refusal(const std::string& text) { return independent::refusal(import, text); }

struct Slip {
  const char* from;
  const char* to;
  const char* says;  // the whole message, or its beginning

  friend void PrintTo(const Slip& slip, std::ostream* out) { *out << slip.to; }
};

const Slip kSlips[] = {
    {"\"version\": 1", "\"version\": 9",
     "s.json:2: /version: 9 is refused: this program reads scenario files of version 1"},
    {"  \"version\": 1,\n", "", "s.json:1: top level: \"version\" is missing; add it"},
    {"\"law\": {", "\"law\": {\"exempt_pairs\": [[\"pallet-agv\"]], ",
     "s.json:7: /law/exempt_pairs/0: [\"pallet-agv\"] is refused: a name is missing; a pair is two"},
    {"\"law\": {", "\"law\": {\"exempt_pairs\": [[\"pallet-agv\", \"palet-agv\"]], ",
     "s.json:7: /law/exempt_pairs/0: [\"pallet-agv\", \"palet-agv\"] is refused: \"palet-agv\" is no vehicle type of "
     "this fleet, nor \"obstacle\"; did you mean \"pallet-agv\"?"},
    {"\"law\": {", "\"law\": {\"exempt_pairs\": [[\"pallet-agv\", 4]], ",
     "s.json:7: /law/exempt_pairs/0/1: 4 is refused: expected"},
    {"\"seed\": 4", "\"seed\": -4", "s.json:4: /seed: -4 is refused: expected a whole number"},
    {"\"seed\": 4", "\"seed\": \"0xg\"",
     "s.json:4: /seed: \"0xg\" is refused: expected a whole number from 0 to 2^64 - 1, or"},
    {"\"seed\"", "\"sede\"", "s.json:4: top level: unknown key \"sede\"; did you mean \"seed\"?"},
    {"\"horizon_s\": 12", "\"horizon_s\": 0",
     "s.json:5: /horizon_s: 0 is refused: expected a number above 0, at most 10000000 s"},
    {"\"horizon_s\": 12", "\"horizon_s\": \"12\"", "s.json:5: /horizon_s: \"12\" is refused: expected a number"},
    {"\"horizon_s\": 12", "\"horizon_s\": 1e300",
     "s.json:5: /horizon_s: 1e+300 is refused: expected a number above 0, at most 10000000 s"},
    {"\"horizon_s\": 12", "\"horizon_s\": 12, \"horizon_ns\": 12",
     "s.json:5: /horizon_s: 12 is refused: the same duration is given as horizon_ns"},
    {"\"horizon_s\": 12", "\"horizon_ns\": 1.5", "s.json:5: /horizon_ns: 1.5 is refused: expected a whole number"},
    {"\"loss\": 0.4", "\"loss\": 40", "s.json:6: /radio/loss: 40 is refused: expected a number from 0 to 1"},
    {"\"constant\"", "\"konstant\"",
     "s.json:6: /radio/delay_model: \"konstant\" is refused: expected one of \"constant\", \"uniform\", "
     "\"heavy-tail\"; did you mean \"constant\"?"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"outage_shape\": 1",
     "s.json:6: /radio/outage_shape: 1 is refused: expected a number from 1.05 to 100"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"mean_outage_s\": 1e-6",
     "s.json:6: /radio/mean_outage_s: 1e-06 is refused: expected at least 0.001 s"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"outage_scope\": \"plaice\"",
     "s.json:6: /radio/outage_scope: \"plaice\" is refused: expected one of \"link\", \"direction\", \"place\"; did "
     "you mean \"place\"?"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"loss_good\": 0.95",
     "s.json:6: /radio/loss_good: 0.95 is refused: expected a number below loss_bad, which is 0.95"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"contention_window\": -1",
     "s.json:6: /radio/contention_window: -1 is refused: expected a whole number"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"contention_window\": 2000",
     "s.json:6: /radio/contention_window: 2000 is refused: expected a whole number from 0 to 1023"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"trace\": [[0, 1]]", "s.json:6: /radio/trace/0: "},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"trace\": [[0, 1, 7], [0, 1, 5]]", "s.json:6: /radio/trace/1: "},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"sources\": [{\"x_m\": 1}]", "s.json:6: /radio/sources/0: "},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"sources\": [{\"x_m\": 1, \"y_m\": 2, \"los\": 1}]",
     "s.json:6: /radio/sources/0: unknown key \"los\"; did you mean \"loss\"?"},
    {"\"loss\": 0.4", "\"loss\": 0.4, \"sources\": [{\"x_m\": 1, \"y_m\": 2, \"loss\": 1.5}]",
     "s.json:6: /radio/sources/0/loss: 1.5 is refused: expected a number from 0 to 1"},
    {"\"delay_s\"", "\"delay\"", "s.json:6: /radio: unknown key \"delay\"; did you mean \"delay_s\"?"},
    {"\"width_m\": 1", "\"width_m\": -1", "s.json:12: /vehicle_types/0/width_m: -1 is refused"},
    {"\"speed_mps\": 2", "\"speed_mps\": 0", "s.json:13: /vehicle_types/0/drive/speed_mps: 0 is refused"},
    {"{\"name\": \"B\", ", "{\"name\": \"A\", ", "s.json:18: /agvs/1/name: \"A\" is refused: the name \"A\" is taken"},
    {"{\"name\": \"B\", ", "{", "s.json:18: /agvs/1: \"name\" is missing; add it"},
    {"\"start\": \"10\"", "\"start\": \"11\"", "s.json:17: /agvs/0/start: \"11\" is refused: there is no such station"},
    {"\"heading\": [1, 0]", "\"heading\": [0, 0]",
     "s.json:17: /agvs/0/heading: [0, 0] is refused: a heading is a direction"},
    {"\"heading\": [1, 0]", "\"heading\": 90",
     "s.json:17: /agvs/0/heading: 90 is refused: expected two numbers [x, y]"},
    {"\"action\": \"move\"", "\"action\": \"fly\"",
     "s.json:17: /agvs/0/script/0/action: \"fly\" is refused: expected one of \"move\""},
    {"\"segment\": \"10-9\"", "\"segment\": \"9-10\"",
     "s.json:17: /agvs/0/script/0/segment: \"9-10\" is refused: there is no such segment; did you mean"},
    {"{\"at_s\": 2, ", "{", "s.json:17: /agvs/0/script/0: \"at_s\" is missing; add it"},
    {"\"at_s\": 2", "\"at_s\": -2", "s.json:17: /agvs/0/script/0/at_s: -2 is refused"},
    {"\"script\": [{", "\"script\": {", "s.json:17:"},
    {"\"position_m\": [0, 4]", "\"position_m\": [0]",
     "s.json:33: /layout/stations/5/position_m: [0] is refused: expected two numbers [x, y]"},
    {"\"from\": \"10\", \"to\": \"9\"", "\"from\": \"10\"", "s.json:40: /layout/segments/0: \"to\" is missing; add it"},
};

class ScenarioSlip : public testing::TestWithParam<Slip> {};

TEST_P(ScenarioSlip, IsExplained) {
  const auto [from, to, says] = GetParam();
  auto text = figure4();
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, std::string(from).size(), to);
  const auto message = refusal(text);
  EXPECT_TRUE(message.starts_with(says)) << message << "\nexpected: " << says;
}

INSTANTIATE_TEST_SUITE_P(All, ScenarioSlip, testing::ValuesIn(kSlips),
                         [](const auto& test) { return "slip" + std::to_string(test.index); });

TEST(ScenarioErrors, EmptyFleetAndWrongTopLevel) {
  auto text = figure4();
  const auto begin = text.find("  \"agvs\": ["), end = text.find("  \"layout\"");
  EXPECT_EQ(refusal(text.replace(begin, end - begin, "  \"agvs\": [],\n")),
            "s.json:16: /agvs: [] is refused: a scenario needs at least one AGV");
  EXPECT_EQ(refusal("[]"), "s.json:1: top level: [] is refused: expected an object { ... }");
  EXPECT_THROW(read_scenario("/nowhere/s.json"), InputError);
}

TEST(ScenarioErrors, EveryPrefixIsRefusedWithoutACrash) {
  const auto& text = figure4();
  const auto whole = text.find_last_of('}') + 1;
  for (std::size_t cut = 0; cut < whole; cut += 7) EXPECT_NE(refusal(text.substr(0, cut)), "accepted") << cut;
}

TEST(ScenarioErrors, RandomDamageIsReadOrRefused) {
  independent::bear_damage(import, figure4(), 3000, "0123456789-.eE\"[]{},:\\ \ntnsau\x80\xff");
}

}  // namespace
}  // namespace fleetproof::scenario_errors_test
