// What a scenario asks for is what happens: speeds tail first, and a word for whatever a run does not give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::asked_for_test {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// One AGV at A, and B 12 m from there. The AGV looks to B and drives there at 1 s.
Json plain() {
  return Json::parse(R"({"version": 1, "name": "asked for", "seed": 1, "horizon_s": 60,
    "vehicle_types": [{"name": "t", "drive": {"speed_mps": 2}, "pick_s": 2}],
    "agvs": [{"name": "V0", "start": "A", "heading": [1, 0], "transports": [], "script":
      [{"at_s": 1, "action": "move", "segment": "ab"}]}],
    "layout": {"name": "t", "floor_low_m": [-20, -20], "floor_high_m": [20, 20],
      "stations": [{"name": "A", "position_m": [0, 0], "purposes": ["storage"]},
        {"name": "B", "position_m": [12, 0], "purposes": ["storage"]}],
      "segments": [{"name": "ab", "from": "A", "to": "B", "bidirectional": true}]}})");
}

// The same, with a load: it is picked at 1 s, and the AGV drives at 4 s.
Json with_load() {
  Json json = plain();
  json["agvs"][0]["transports"] = Json::parse(R"([{"from": "A", "to": "B", "release_s": 0}])");
  json["agvs"][0]["script"] =
      Json::parse(R"([{"at_s": 1, "action": "pick"}, {"at_s": 4, "action": "move", "segment": "ab"}])");
  return json;
}

Json tail_first(Json json, double forward_mps, double reverse_mps) {
  json["agvs"][0]["heading"] = {-1, 0};
  json["layout"]["segments"][0]["travel"] = "backward";
  json["vehicle_types"][0]["drive"]["speed_mps"] = forward_mps;
  json["vehicle_types"][0]["reverse_speed_mps"] = reverse_mps;
  return json;
}

class AskedFor : public test::ProgramTest {
 protected:
  Json told(const Json& scenario) const {
    write("s.json", scenario.dump());
    const auto done = run("simulate s.json --json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return Json::parse(done.out);
  }
  // "kind: body from first to last (value)" of each incident.
  std::vector<std::string> incidents(const Json& scenario) const {
    std::vector<std::string> lines;
    const Json all = told(scenario);
    for (const Json& incident : all["incidents"]) {
      const std::string body = incident["a"].is_null() ? "nobody" : incident["a"].get<std::string>();
      lines.push_back(incident["kind"].get<std::string>() + ": " + body + " from " + incident["first_s"].dump() +
                      " to " + incident["last_s"].dump() + " (" + incident["value"].dump() + ")");
    }
    return lines;
  }
  std::string warnings(const Json& scenario) const {
    write("s.json", scenario.dump());
    const auto done = run("check s.json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done.err;
  }
  // When the only drive of the run ends.
  double arrives_s(const Json& scenario) const {
    write("s.json", scenario.dump());
    run("simulate s.json --trace --trace-format json --trace-kind ends --trace-output t.json");
    double last_s = -1.0;
    std::istringstream lines(read(path("t.json")));
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('{')) last_s = Json::parse(line)["t_ns"].get<double>() * 1e-9;
    }
    return last_s;
  }
};

// 12 m from rest to rest, at 0.5 m/s2 up and 1 m/s2 down.
double drive_s(double speed_mps) {
  const double up_s = speed_mps / 0.5, down_s = speed_mps / 1.0;
  return up_s + down_s + (12.0 - 0.5 * speed_mps * (up_s + down_s)) / speed_mps;
}

TEST_F(AskedFor, AVehicleMayBeFasterBackward) {
  EXPECT_NEAR(arrives_s(tail_first(plain(), 1.0, 2.0)), 1.0 + drive_s(2.0), 1e-6);
  EXPECT_NEAR(arrives_s(tail_first(plain(), 2.0, 1.0)), 1.0 + drive_s(1.0), 1e-6);
  EXPECT_NEAR(arrives_s(tail_first(plain(), 1.0, 0.0)), 1.0 + drive_s(1.0), 1e-6) << "0: as forward";
  Json limited = tail_first(plain(), 1.0, 2.0);
  limited["layout"]["segments"][0]["speed_limit_mps"] = 0.5;
  EXPECT_NEAR(arrives_s(limited), 1.0 + drive_s(0.5), 1e-6) << "the lane has a limit for both ends";
}

TEST_F(AskedFor, ALoadSlowsBothDirections) {
  Json forward = with_load(), backward = tail_first(with_load(), 2.0, 1.0);
  for (Json* json : {&forward, &backward}) (*json)["vehicle_types"][0]["loaded"] = {{"speed_share", 0.5}};
  EXPECT_NEAR(arrives_s(forward), 4.0 + drive_s(1.0), 1e-6);
  EXPECT_NEAR(arrives_s(backward), 4.0 + drive_s(0.5), 1e-6);
}

TEST_F(AskedFor, AnObstacleThatNeverFindsRoomIsAnIncident) {
  Json json = plain();
  json["vehicle_types"][0]["drive"]["speed_mps"] = 1;
  json["obstacles"] = Json::parse(R"([{"name": "person", "length_m": 0.5, "width_m": 0.5, "position_m": [5, 0],
                                       "appears_s": 6, "leaves_s": 8}])");
  EXPECT_THAT(incidents(json), ElementsAre("obstacle-without-room: person from 6.0 to 8.0 (1)"));
  EXPECT_THAT(run("simulate s.json").out, HasSubstr("obstacle-without-room: person from 6.000 s to 8.000 s"));
  EXPECT_THAT(run("simulate s.json --trace").err, HasSubstr("no room: a body was in the place"));
  json["obstacles"][0]["leaves_s"] = 30;
  EXPECT_THAT(incidents(json), ElementsAre("obstacle-without-room: person from 6.0 to 9.0 (0)",
                                           "foreign-body: person from 9.0 to 30.0 (0)"))
      << "it came later";
  json["obstacles"][0]["appears_s"] = 61;
  json["obstacles"][0]["leaves_s"] = 70;
  EXPECT_THAT(incidents(json), ElementsAre("not-reached: person from 60.0 to 60.0 (1)"));
  EXPECT_THAT(warnings(json),
              HasSubstr("/obstacles/0/appears_s: \"person\" appears at 61 s, after the end of the run"));
}

TEST_F(AskedFor, ALoadThatCannotFallIsAnIncident) {
  Json json = with_load();
  json["vehicle_types"][0]["length_m"] = 1.81;
  json["faults"] = Json::parse(R"([{"kind": "load-drop", "agv": "V0", "at_s": 8, "lasts_s": 10}])");
  EXPECT_THAT(incidents(json), ElementsAre("load-did-not-fall: V0 from 8.0 to 8.0 (2)"));
  EXPECT_THAT(warnings(json), HasSubstr("/faults/0/ahead_m: the load would lie 0.095 m from \"V0\", which drops it"));
  EXPECT_THAT(run("simulate s.json").out, HasSubstr("no room: a body was in the place"));
  json["faults"][0]["ahead_m"] = -1.7;
  EXPECT_THAT(incidents(json), ElementsAre("fault-injected: V0 from 8.0 to 18.0 (3)",
                                           "foreign-body: load dropped by V0 from 8.0 to 18.0 (1)"));
  EXPECT_THAT(warnings(json), Not(HasSubstr("/faults")));
  json["faults"][0]["at_s"] = 2;
  EXPECT_THAT(incidents(json), ElementsAre("load-did-not-fall: V0 from 2.0 to 2.0 (1)")) << "before it has it";
  json["agvs"][0]["transports"] = Json::array();
  EXPECT_THAT(warnings(json), HasSubstr("/faults/0/agv: \"V0\" has no transports, so it never carries a load"));
}

TEST_F(AskedFor, AFaultOfWhatIsOutOfOrderIsAnIncident) {
  Json json = plain();
  json["faults"] = Json::parse(R"([{"kind": "restart", "agv": "V0", "at_s": 20, "lasts_s": 10},
                                   {"kind": "freeze", "agv": "V0", "at_s": 25, "lasts_s": 1},
                                   {"kind": "breakdown", "agv": "V0", "at_s": 60.5, "lasts_s": 1}])");
  EXPECT_THAT(incidents(json),
              ElementsAre("fault-injected: V0 from 20.0 to 30.0 (4)", "fault-without-effect: V0 from 25.0 to 25.0 (5)",
                          "not-reached: V0 from 60.0 to 60.0 (1)"));
  EXPECT_THAT(warnings(json), HasSubstr("/faults/2/at_s: the breakdown of \"V0\" comes at 60.5 s, after the end"));
}

TEST_F(AskedFor, ANamedFaultThatTheProgramDoesNotKnowIsAnIncident) {
  Json json = plain();
  json["agent"] = "scripted";
  json["faults"] = Json::parse(
      R"([{"kind": "named", "agv": "V0", "at_s": 20, "lasts_s": 10, "word": "dirty-scanner", "number": 2}])");
  EXPECT_THAT(incidents(json), ElementsAre("fault-without-effect: V0 from 20.0 to 20.0 (8)"));
  EXPECT_THAT(warnings(json), HasSubstr("/faults/0/word: the agent \"scripted\" does not know the fault "
                                        "\"dirty-scanner\", so it never strikes"));
  json["agent"] = "somebody-else";
  EXPECT_THAT(warnings(json), Not(HasSubstr("dirty-scanner"))) << "a plug-in is asked when the fault strikes";
  json["faults"][0]["kind"] = "restart";
  EXPECT_THAT(warnings(json), HasSubstr("/faults/0: a restart has no name, so word and number change nothing"));
  json["faults"][0]["kind"] = "named";
  json["faults"][0]["word"] = "";
  write("s.json", json.dump());
  const test::Finished refused = run("check s.json");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("/faults/0/word"));
}

TEST_F(AskedFor, ALoadOfAFaultWithoutOneIsTold) {
  Json json = plain();
  json["faults"] = Json::parse(R"([{"kind": "breakdown", "agv": "V0", "at_s": 20, "lasts_s": 1}])");
  EXPECT_THAT(warnings(json), IsEmpty());
  for (const char* field : {"length_m", "width_m", "ahead_m", "left_m"}) {
    Json given = json;
    given["faults"][0][field] = 2.5;
    EXPECT_THAT(warnings(given), HasSubstr("/faults/0: a breakdown has no load, so length_m, width_m")) << field;
  }
}

TEST_F(AskedFor, OrdersAndCallsBehindTheEndOfTheRunAreAnIncident) {
  Json json = plain();
  json["agvs"][0]["transports"] =
      Json::parse(R"([{"from": "A", "to": "B", "release_s": 60}, {"from": "A", "to": "B", "release_s": 60.5}])");
  json["agvs"][0]["script"].push_back(Json::parse(R"({"at_s": 61, "action": "park"})"));
  EXPECT_THAT(incidents(json), ElementsAre("not-reached: V0 from 60.0 to 60.0 (2)"));
  const std::string said = warnings(json);
  EXPECT_THAT(said, HasSubstr("/agvs/0/transports/1: 1 of 2 orders of \"V0\" comes after the end of the run"));
  EXPECT_THAT(said, HasSubstr("/agvs/0/script/1: 1 of 2 calls of the script of \"V0\" comes after the end of the run"));
}

TEST_F(AskedFor, ACallOfAScriptThatIsRefusedIsAnIncident) {
  Json json = plain();
  for (const double at_s : {2.0, 3.0})  // the first of them is the next action, for the second there is no room
    json["agvs"][0]["script"].push_back({{"at_s", at_s}, {"action", "move"}, {"segment", "ab"}});
  EXPECT_THAT(incidents(json), ElementsAre("call-not-made: V0 from 3.0 to 3.0 (2)"));
  json["agent"] = "scripted with drop every 5th message";
  EXPECT_THAT(warnings(json), IsEmpty());
  EXPECT_THAT(incidents(json), ElementsAre("call-not-made: V0 from 3.0 to 3.0 (2)")) << "with a fault around it, too";
  json["agent"] = "hull-lock";
  EXPECT_THAT(warnings(json), HasSubstr("/agvs/0/script: only the agent \"scripted\" plays a script"));
  EXPECT_THAT(incidents(json), ElementsAre("not-reached: V0 from 60.0 to 60.0 (3)")) << "nobody plays it";
}

// The orders of the AGV are at B. It picks at A, drops there what it does not have, and picks twice at B.
TEST_F(AskedFor, ATransferOfAScriptWithoutALoadIsAnIncident) {
  Json json = plain();
  json["agvs"][0]["transports"] = Json::parse(R"([{"from": "B", "to": "A", "release_s": 0}])");
  json["agvs"][0]["script"] = Json::parse(R"([{"at_s": 1, "action": "pick"}, {"at_s": 4, "action": "drop"},
      {"at_s": 20, "action": "pick", "segment": "ab"}, {"at_s": 45, "action": "pick"}])");
  EXPECT_THAT(incidents(json),
              ElementsAre("call-without-effect: V0 from 3.0 to 3.0 (0)", "call-without-effect: V0 from 9.0 to 9.0 (1)",
                          "call-without-effect: V0 from 47.0 to 47.0 (3)"));
  EXPECT_THAT(run("simulate s.json").out,
              HasSubstr("call-without-effect: V0 from 3.000 s; a pick or drop of the scenario's script found no load"));
  json["agvs"][0]["script"] = Json::parse(R"([{"at_s": 1, "action": "move", "segment": "ab"},
      {"at_s": 20, "action": "pick"}, {"at_s": 25, "action": "drop", "segment": "ab"}])");
  EXPECT_THAT(incidents(json), IsEmpty()) << "each has its load";
}

// Two AGVs of hull-lock, which stand and talk.
Json talking(const char* fates) {
  Json json = plain();
  json["agent"] = "hull-lock";
  json["agvs"][0].erase("script");
  json["agvs"].push_back(json["agvs"][0]);
  json["agvs"][1]["name"] = "V1";
  json["agvs"][1]["start"] = "B";
  json["fates"] = Json::parse(fates);
  return json;
}

TEST_F(AskedFor, ADeliveryOfAMessageThatIsNeverSentIsAnIncident) {
  Json json = talking(R"([{"sender": "V0", "receiver": "V1", "sent_ns": 1, "lost": true},
      {"sender": "V0", "receiver": "V1", "sent_ns": 2000000001, "delay_s": 1},
      {"sender": "V1", "receiver": "V0", "sent_s": 70, "lost": true}])");
  EXPECT_THAT(incidents(json), ElementsAre("message-not-sent: V0 from 1e-09 to 2.000000001 (2)",
                                           "message-not-sent: V1 from 60.0 to 60.0 (1)"));
  EXPECT_THAT(run("simulate s.json --trace").err,
              HasSubstr("delivery to V1 of what is sent at 0.000000001 s: no such message was sent"));
  EXPECT_THAT(warnings(json), HasSubstr("/fates/2: 1 of 3 messages with a given delivery comes after the end"));
  json["fates"] = Json::parse(R"([{"sender": "V0", "receiver": "V1", "sent_ns": 0, "lost": true}])");
  EXPECT_THAT(incidents(json), IsEmpty()) << "hull-lock says where it stands at its start";
  json["radio"] = {{"range_m", 5}};
  EXPECT_THAT(incidents(json), ElementsAre("message-not-sent: V0 from 0.0 to 0.0 (1)")) << "out of range";
  json["agent"] = "scripted";
  EXPECT_THAT(warnings(json), HasSubstr("/fates: the agent \"scripted\" sends no messages"));
}

TEST_F(AskedFor, AKindOfMessagesThatNobodySendsIsAnIncident) {
  Json json = talking("[]");
  json["radio"] = {{"loss", 0.3}, {"spared_kinds", {"STATE", "STATES", "SATTE"}}};
  EXPECT_THAT(incidents(json), ElementsAre("message-not-sent: nobody from 60.0 to 60.0 (2)"));
  EXPECT_THAT(run("simulate s.json --trace").err, HasSubstr("spared kind SATTE: no message was described so"));
  json["radio"]["spared_kinds"] = {"STATE"};
  EXPECT_THAT(incidents(json), IsEmpty());
}

TEST_F(AskedFor, AFieldThatCountsOnlyBesideAnotherOneIsTold) {
  const auto told_of = [&](const char* table, const char* fields) {
    Json json = plain();
    json[table] = Json::parse(fields);
    return warnings(json);
  };
  EXPECT_THAT(told_of("radio", R"({"loss_bad": 0.5})"), HasSubstr("/radio/mean_outage_s: 0 s: there are no outages"));
  EXPECT_THAT(told_of("radio", R"({"mean_outage_s": 1, "loss_bad": 0.5})"), IsEmpty());
  EXPECT_THAT(told_of("radio", R"({"mean_outage_s": 1, "outage_shape": 2})"), HasSubstr("/radio/outage_shape: it"));
  EXPECT_THAT(told_of("radio", R"({"delay_tail_shape": 2})"), HasSubstr("/radio/delay_model: it is not"));
  EXPECT_THAT(told_of("radio", R"({"delay_model": "heavy-tail", "delay_tail_shape": 2})"), IsEmpty());
  EXPECT_THAT(told_of("radio", R"({"roaming_max_s": 3})"), HasSubstr("/radio/roaming_at_crossing: no AGV changes"));
  EXPECT_THAT(told_of("radio", R"({"roaming_at_crossing": true, "roaming_max_s": 3, "ap_spacing_m": 9})"), IsEmpty());
  EXPECT_THAT(told_of("radio", R"({"roaming_gap_s": 3})"), HasSubstr("/radio/roaming_border_m: 0 m: borders have no"));
  EXPECT_THAT(told_of("radio", R"({"ap_spacing_m": 9})"), HasSubstr("/radio/ap_spacing_m: it counts only if"));
  EXPECT_THAT(told_of("radio", R"({"mean_outage_s": 1, "outage_scope": "place", "ap_spacing_m": 9})"), IsEmpty());
  EXPECT_THAT(told_of("radio", R"({"contention_window": 7})"), HasSubstr("/radio/contention_window: it counts only"));
  EXPECT_THAT(told_of("law", R"({"exempt_radius_m": 2})"), HasSubstr("/law/exempt_purposes: none: exempt_radius_m"));
  EXPECT_THAT(told_of("law", R"({"exempt_purposes": "storage"})"), HasSubstr("/law/exempt_radius_m: 0 m: exempt"));
  EXPECT_THAT(told_of("scanner", R"({"on": false, "range_m": 3})"), HasSubstr("/scanner/on: the scanners are off"));
  EXPECT_THAT(told_of("operator", R"({"on": false, "battery": 0.5})"), HasSubstr("/operator/on: the operator is off"));
  EXPECT_THAT(told_of("operator", R"({"battery": 0.5})"), HasSubstr("/operator/on: the operator is off"));
  EXPECT_THAT(told_of("operator", R"({"on": true, "battery": 0.5})"), IsEmpty());
}

// A run in which nothing is denied has no such word.
TEST_F(AskedFor, WhatIsGivenIsNoIncident) {
  EXPECT_THAT(incidents(plain()), IsEmpty());
  EXPECT_THAT(warnings(plain()), IsEmpty());
}

TEST_F(AskedFor, AnObstacleInAnotherOneIsTold) {
  Json json = plain();
  json["obstacles"] = Json::parse(R"([{"name": "shelf", "length_m": 1, "width_m": 1, "position_m": [5, 5]},
      {"name": "person", "length_m": 0.5, "width_m": 0.5, "position_m": [5, 5.5], "appears_s": 6}])");
  EXPECT_THAT(warnings(json), HasSubstr("/obstacles/1/position_m: \"person\" would stand 0 m from obstacle \"shelf\""));
  json["obstacles"][0]["leaves_s"] = 30;
  EXPECT_THAT(warnings(json), IsEmpty()) << "then there is room";
}

}  // namespace
}  // namespace fleetproof::asked_for_test
