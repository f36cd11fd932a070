#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "core/agents/agent_type.hpp"
#include "core/agents/agents.h"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/fake_warehouse.hpp"

namespace fleetproof::agents::agent_catalogue_test {
namespace {

TEST(ReferenceAgents, AreCompleteAndSpeakThisVersion) {
  std::set<std::string> names;
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_reference_agent(i); ++i) {
    const fp_agent_type& type = *agent;
    EXPECT_EQ(type.struct_size, sizeof(fp_agent_type));
    EXPECT_EQ(type.abi_major, FP_ABI_MAJOR);
    EXPECT_TRUE(type.create != nullptr && type.on_event != nullptr && type.destroy != nullptr);
    EXPECT_FALSE(std::string(type.description).empty());
    EXPECT_TRUE(names.insert(type.name).second) << type.name;
  }
  for (const char* known : {"scripted", "hull-lock", "timeout-grant", "reckless"}) EXPECT_TRUE(names.contains(known));
}

// ---- the largest plant

std::string why_not;
std::int32_t note_why(fp_controller*, const char* why) {
  why_not = why;
  return FP_OK;
}

// An agent that starts is not made: its map is none.
bool refuses(const fp_agent_type& type, std::uint32_t stations, std::uint32_t lanes, std::uint32_t agvs,
             std::uint32_t minor = FP_ABI_MINOR) {
  fp_host host{};
  host.struct_size = sizeof host;
  host.abi_minor = minor;
  if (minor >= 4) host.cannot_start = note_why;
  fp_map map{};
  map.station_count = stations, map.lane_count = lanes;
  fp_briefing briefing{};
  briefing.map = &map;
  briefing.fleet_count = agvs;
  why_not.clear();
  return type.create(&host, nullptr, &briefing) == nullptr;
}

TEST(ReferenceAgents, SayInWhichPlantsTheyCannotStart) {
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_reference_agent(i); ++i) {
    const std::uint32_t most = fp_reference_agent_limit(agent);
    if (agent == &kScripted || agent == &kReckless) {
      EXPECT_EQ(most, FP_NONE) << agent->name;
      continue;
    }
    ASSERT_EQ(most, 65535U) << agent->name;
    EXPECT_TRUE(refuses(*agent, most + 1, 1, 1));
    EXPECT_EQ(why_not, "there are 65536 stations, and a message can name 65535 of each");
    EXPECT_TRUE(refuses(*agent, 1, most + 1, 1));
    EXPECT_EQ(why_not, "there are 65536 drives, and a message can name 65535 of each");
    EXPECT_TRUE(refuses(*agent, 1, most + 5, most + 1));
    EXPECT_EQ(why_not, "there are 65540 drives and 65536 AGVs, and a message can name 65535 of each");
    EXPECT_TRUE(refuses(*agent, 1, most + 1, 1, 3)) << "a host that cannot be told";
    EXPECT_EQ(why_not, "");
  }
}

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(FLEETPROOF_SOURCE_DIR "/core/agents/faulty/" + file).rdbuf();
  EXPECT_FALSE(text.str().empty()) << file;
  return text.str();
}

TEST(FaultyAgents, NameTheirFaultInTheirTableAndOnThePage) {
  const std::string page = text_of("README.md"), table = text_of("faulty_agents.cpp");
  std::uint32_t agents = 0;
  for (; const fp_agent_type* agent = fp_faulty_agent(agents); ++agents) {
    const std::string name = agent->name;
    EXPECT_THAT(page, ::testing::HasSubstr("| `" + name + "` |"));
    // The fault, in one or two lines, directly above the entry.
    EXPECT_THAT(table,
                ::testing::ContainsRegex(
                    "// FAULT: [^\n]+\n( +// [^\n]+\n)? +(lock|server|follower)_with<[^\n]*>\\(\n? *\"" + name + "\""));
  }
  EXPECT_GE(agents, 34U);
}

TEST(Scripted, CallsAtItsInstantsInTheirOrder) {
  testing::DrawnMap drawn;
  const auto a = drawn.station(0, 0), b = drawn.station(4, 0);
  const auto segment = drawn.segment(a, b);
  const fp_scripted_call script[] = {{20'000'000'000, FP_CALL_DROP, FP_HERE},
                                     {2'000'000'000, FP_CALL_MOVE, segment},
                                     {10'000'000'000, FP_CALL_PICK, segment}};
  const testing::TestFleet fleet(drawn.map(), 1);
  testing::FakeWarehouse warehouse(drawn, fleet, {a}, kScripted, {}, 1);
  warehouse.script(0, script);
  warehouse.run(60.0);
  const std::vector<std::pair<double, std::uint32_t>> expected = {
      {2.0, FP_CALL_MOVE}, {10.0, FP_CALL_PICK}, {20.0, FP_CALL_DROP}};
  EXPECT_EQ(warehouse.calls(), expected);
}

TEST(Reckless, DrivesItsTransportsByTheQuickestWay) {
  testing::DrawnMap drawn;
  const auto a = drawn.station(0, 0), b = drawn.station(4, 0), c = drawn.station(8, 0), detour = drawn.station(4, 9);
  drawn.segment(a, detour), drawn.segment(detour, c), drawn.segment(a, b), drawn.segment(b, c);
  const testing::TestFleet fleet(drawn.map(), 1);
  testing::FakeWarehouse warehouse(drawn, fleet, {a}, kReckless, {}, 1);
  warehouse.order(0, 1.0, a, c);
  warehouse.order(0, 1.0, b, a);
  warehouse.run(120.0);
  EXPECT_EQ(warehouse.drops(), 2U);
  std::vector<std::uint32_t> calls;
  for (const auto& call : warehouse.calls()) calls.push_back(call.second);
  EXPECT_EQ(calls, (std::vector<std::uint32_t>{FP_CALL_PICK, FP_CALL_MOVE, FP_CALL_DROP, FP_CALL_PICK, FP_CALL_DROP}));
}

}  // namespace
}  // namespace fleetproof::agents::agent_catalogue_test
