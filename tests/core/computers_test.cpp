// Participants without a body: who hears them, what they may not do, what goes wrong with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "core/outcome/trace_records.hpp"
#include "laws/laws.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::computers_test {
namespace {

// AGVs at these stations of a row, and computers that are connected everywhere.
Scenario with_computers(std::vector<std::uint32_t> starts, std::size_t computers, double horizon_s = 20.0) {
  Scenario scenario = test::row_of_tens(std::move(starts), horizon_s);
  for (std::size_t i = 0; i < computers; ++i) scenario.computers.push_back({.name = "c" + std::to_string(i)});
  return scenario;
}

// Under the default laws.
Outcome judged(const Scenario& scenario, const test::Handler& handler) {
  const auto laws = make_default_laws(scenario, {});
  test::current_handler = &handler;
  Outcome outcome = simulate(scenario, test::handler_software(scenario), laws);
  test::current_handler = nullptr;
  return outcome;
}

// Who received what from whom, and when; by receiver, sender and first byte of the message.
using Heard = std::map<std::tuple<std::uint32_t, std::uint32_t, char>, std::int64_t>;

// At its start, `sender` sends each of these messages to that receiver, or to all.
Heard heard(const Scenario& scenario, std::uint32_t sender, std::vector<std::pair<char, std::uint32_t>> messages) {
  Heard heard;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == sender) {
      for (const auto& [byte, receiver] : messages) {
        const int32_t sent =
            receiver == FP_NONE ? host.send_broadcast(c, &byte, 1) : host.send_unicast(c, &byte, 1, receiver);
        EXPECT_EQ(sent, FP_OK);
      }
    }
    fp_message message{};
    message.struct_size = sizeof message;
    while (e.kind == FP_EVENT_MESSAGE && host.get_message(c, &message) == FP_OK)
      heard[{b.self, message.sender, *static_cast<const char*>(message.bytes)}] = e.now_ns;
  };
  const Outcome outcome = test::simulate_with(scenario, handler);
  EXPECT_FALSE(outcome.crash || outcome.hang || outcome.engine_error) << outcome.message;
  return heard;
}

TEST(Computers, HearAndAreHeardLikeAgvs) {
  Scenario scenario = with_computers({0, 3}, 1);
  scenario.radio.delay_s = 0.5;
  EXPECT_EQ(heard(scenario, 0, {{'a', FP_NONE}}), (Heard{{{1, 0, 'a'}, 500'000'000}, {{2, 0, 'a'}, 500'000'000}}));
  EXPECT_EQ(heard(scenario, 1, {{'b', 2}}), (Heard{{{2, 1, 'b'}, 500'000'000}}));
  EXPECT_EQ(heard(scenario, 2, {{'c', FP_NONE}, {'d', 1}}),
            (Heard{{{0, 2, 'c'}, 500'000'000}, {{1, 2, 'c'}, 500'000'000}, {{1, 2, 'd'}, 500'000'000}}));
}

TEST(Computers, AWireBetweenThemLosesNothingAndHasADelayOfItsOwn) {
  Scenario scenario = with_computers({0, 3}, 3);
  scenario.radio.loss = 1.0;
  scenario.radio.delay_s = 2.0;
  scenario.wire.takes_s = 0.25;
  const Heard by_wire{{{3, 2, 'w'}, 250'000'000}, {{4, 2, 'w'}, 250'000'000}};
  EXPECT_EQ(heard(scenario, 2, {{'w', FP_NONE}}), by_wire) << "the AGVs hear nothing";
  EXPECT_EQ(heard(scenario, 2, {{'w', 3}, {'w', 4}, {'w', 0}}), by_wire);
  EXPECT_EQ(heard(scenario, 0, {{'w', FP_NONE}}), Heard{}) << "an AGV has no wire";
}

TEST(Computers, AWireNeedsNoAir) {
  Scenario scenario = with_computers({0, 3}, 2);
  scenario.wire.takes_s = 0.25;
  scenario.radio.contention.interference = true;
  scenario.radio.air_time_s = 1.0;
  EXPECT_EQ(heard(scenario, 2, {{'w', 3}}), (Heard{{{3, 2, 'w'}, 250'000'000}}));
  EXPECT_GE(heard(scenario, 2, {{'w', 0}}).at({0, 2, 'w'}), 2'000'000'000) << "by radio it waits for a slot of 1 s";
}

TEST(Computers, AnAntennaHasAPlaceAndARange) {
  Scenario scenario = with_computers({0, 3}, 2);  // at x = 0 and 30 m
  scenario.radio.range_m = 15.0;
  scenario.computers[0].at_m = Vec2(5.0, 5.0);
  EXPECT_EQ(heard(scenario, 2, {{'a', FP_NONE}}).size(), 2U) << "the near AGV, and the other computer";
  EXPECT_EQ(heard(scenario, 2, {{'a', 1}}), Heard{}) << "the far AGV";
  EXPECT_TRUE(heard(scenario, 0, {{'a', FP_NONE}}).contains({2, 0, 'a'}));
  EXPECT_FALSE(heard(scenario, 1, {{'a', FP_NONE}}).contains({2, 1, 'a'}));
  EXPECT_TRUE(heard(scenario, 1, {{'a', FP_NONE}}).contains({3, 1, 'a'})) << "this one is connected everywhere";
  EXPECT_EQ(heard(scenario, 3, {{'a', FP_NONE}}).size(), 3U);
}

TEST(Computers, OutOfRangeCountsEachWhoDoesNotHear) {
  Scenario scenario = with_computers({0, 3}, 2);
  scenario.radio.range_m = 15.0;
  scenario.computers[0].at_m = Vec2(100.0, 0.0);
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_START) host.send_broadcast(c, "x", 1);
  };
  // Each AGV misses the other one and c0; c0 misses both AGVs; c1 misses nobody.
  EXPECT_EQ(test::simulate_with(scenario, handler).counters.out_of_range, 6U);
}

TEST(Computers, NeitherDriveNorPerceive) {
  const Scenario scenario = with_computers({0}, 1);
  std::vector<std::int32_t> results;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_START || b.role != FP_COMPUTER) return;
    fp_pose pose{};
    double level = 0.0;
    std::uint32_t word = 0;
    results = {host.move(c, 0),
               host.pick(c, FP_HERE),
               host.drop(c, FP_HERE),
               host.park(c, FP_HERE),
               host.charge(c, FP_HERE),
               host.pick_load(c, 0, 0),
               host.stop(c),
               host.go_on(c),
               host.get_position(c, &pose),
               host.get_battery_level(c, &level),
               host.is_loaded(c, &word),
               host.get_load(c, &word),
               host.get_action(c, &word),
               host.safe_mode(c, 1),
               host.waiting_for(c, 0)};
    EXPECT_EQ(host.set_timer(c, 1, 5'000'000'000), FP_OK);
    EXPECT_EQ(host.sometimes(c, "probe"), FP_OK);
    EXPECT_EQ(host.declare_cost_ns(c, 0), FP_OK);
  };
  const Outcome outcome = test::simulate_with(scenario, handler);
  EXPECT_EQ(results, std::vector<std::int32_t>(15, FP_INVALID));
  EXPECT_FALSE(outcome.crash || outcome.engine_error) << outcome.message;
}

TEST(Computers, NobodyWaitsForOneOrBelievesItSomewhere) {
  const Scenario scenario = with_computers({0}, 1);
  test::Recorder trace;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_START || b.role != FP_AGV) return;
    const fp_pose pose{1.0, 2.0, 1.0, 0.0};
    EXPECT_EQ(host.waiting_for(c, 1), FP_INVALID);
    host.believe(c, 1, &pose, 0);
  };
  test::simulate_with(scenario, handler, &trace);
  EXPECT_TRUE(trace.of(TraceKind::Belief).empty());
}

TEST(Computers, HaveAClockOfTheirOwn) {
  Scenario scenario = with_computers({0}, 1);
  scenario.computers[0].clock_offset_s = 3.0;
  scenario.computers[0].clock_drift_ppm = 100'000.0;
  std::vector<std::int64_t> shown;
  test::Recorder trace;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.role != FP_COMPUTER) return;
    shown.push_back(e.now_ns);
    if (e.kind == FP_EVENT_START) host.set_timer(c, 0, 14'000'000'000);
  };
  test::simulate_with(scenario, handler, &trace);
  EXPECT_EQ(shown, (std::vector<std::int64_t>{3'000'000'000, 14'000'000'000}));
  ASSERT_EQ(trace.of(TraceKind::TimerWentOff).size(), 1U);
  EXPECT_EQ(trace.of(TraceKind::TimerWentOff)[0].at, at_seconds(10.0));
}

// What becomes of messages from `sender` to `receiver`, one every 0.1 s; and what it draws.
std::vector<std::uint64_t> fates(const Scenario& scenario, EntityId sender, EntityId receiver) {
  std::vector<std::uint64_t> fates;
  test::Recorder trace;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != sender.value) return;
    if (e.kind == FP_EVENT_START) fates.push_back(host.random(c, 7, 7));
    host.send_unicast(c, &e.now_ns, sizeof e.now_ns, receiver.value);
    host.set_timer(c, 0, e.now_ns + 100'000'000);
  };
  test::simulate_with(scenario, handler, &trace);
  for (const TraceRecord& record : trace.records) {
    if (record.entity == receiver && traced::describes<traced::Reception>(record.kind)) {
      fates.push_back(static_cast<std::uint64_t>(record.kind));
      fates.push_back(static_cast<std::uint64_t>(to_ns(record.at)));
    }
  }
  EXPECT_GT(fates.size(), 100U);
  return fates;
}

Scenario hard(Scenario scenario) {
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 0.3;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.radio.asymmetry = 0.5;
  scenario.radio.outages.mean_outage_s = 1.0;
  return scenario;
}

TEST(Computers, TheFateOfTheirMessagesDoesNotDependOnTheSizeOfTheFleet) {
  const Scenario small = hard(with_computers({0}, 2)), large = hard(with_computers({0, 1, 2, 3}, 2));
  EXPECT_EQ(fates(small, EntityId{1U}, AgvId{0U}), fates(large, EntityId{4U}, AgvId{0U}));
  EXPECT_EQ(fates(small, AgvId{0U}, EntityId{2U}), fates(large, AgvId{0U}, EntityId{5U}));
}

TEST(Computers, OneThatIsLeftKeepsItsDraws) {
  const Scenario both = hard(with_computers({0}, 2));
  Scenario second = both;
  second.computers.erase(second.computers.begin());
  EXPECT_NE(fates(second, EntityId{1U}, AgvId{0U}), fates(both, EntityId{2U}, AgvId{0U}));
  second.computers[0].draws_as = 1;
  EXPECT_EQ(fates(second, EntityId{1U}, AgvId{0U}), fates(both, EntityId{2U}, AgvId{0U}));
}

TEST(Computers, ChangeNothingForAgvsThatDoNotTalkToThem) {
  const Scenario without = hard(with_computers({0, 3}, 0)), with = hard(with_computers({0, 3}, 3));
  EXPECT_EQ(fates(without, AgvId{0U}, AgvId{1U}), fates(with, AgvId{0U}, AgvId{1U}));
}

TEST(Computers, DoNotRoam) {
  Scenario scenario = with_computers({1}, 1);
  scenario.radio.places.ap_spacing_m = 20.0;
  scenario.radio.places.roaming_border_m = 1.0;
  scenario.radio.places.roaming_min_s = scenario.radio.places.roaming_max_s = 5.0;
  scenario.radio.places.roaming_gap_s = 0.5;  // who stands at a border is nearly always deaf
  const auto lost = [&] {
    const auto all = fates(scenario, EntityId{1U}, AgvId{0U});
    return std::ranges::count(all, static_cast<std::uint64_t>(TraceKind::LostInOutage));
  };
  EXPECT_GT(lost(), 100) << "the AGV stands at a border, at x = 10 m";
  scenario.agvs[0].start = StationId{0U};
  scenario.computers[0].at_m = Vec2(10.0, 0.0);
  EXPECT_EQ(lost(), 0) << "the antenna hangs there, on a cable";
}

struct Life {
  std::vector<std::pair<std::int64_t, std::uint32_t>> starts;  // when, and with which boot number
  std::vector<std::int64_t> heard_ns;
  Outcome outcome;
};

// A computer that an AGV calls every second.
Life life_of_computer(const Scenario& scenario) {
  Life life;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.role == FP_AGV) {
      host.send_unicast(c, "?", 1, 1);
      host.set_timer(c, 0, e.now_ns + 1'000'000'000);
      return;
    }
    if (e.kind == FP_EVENT_START) life.starts.emplace_back(e.now_ns, b.boot);
    fp_message message{};
    message.struct_size = sizeof message;
    while (host.get_message(c, &message) == FP_OK) life.heard_ns.push_back(e.now_ns);
  };
  life.outcome = judged(scenario, handler);
  return life;
}

Fault of_computer(Fault::Kind kind, double at_s, double lasts_s) {
  Fault fault = test::fault(kind, at_s, lasts_s);
  fault.agv = EntityId{1U};
  return fault;
}

TEST(ComputerFaults, ARestartLosesTheInboxAndStartsAnew) {
  for (const Fault::Kind kind : {Fault::Kind::Restart, Fault::Kind::PowerFailure}) {
    Scenario scenario = with_computers({0}, 1, 6.0);
    scenario.radio.delay_s = 0.1;
    scenario.faults = {of_computer(kind, 1.5, 2.0)};
    const Life life = life_of_computer(scenario);
    EXPECT_EQ(life.starts, (std::vector<std::pair<std::int64_t, std::uint32_t>>{{0, 0}, {3'500'000'000, 1}}));
    EXPECT_EQ(life.heard_ns, (std::vector<std::int64_t>{100'000'000, 1'100'000'000, 4'100'000'000, 5'100'000'000}));
    EXPECT_EQ(life.outcome.counters.faults, 1U);
    EXPECT_FALSE(life.outcome.engine_error) << life.outcome.message;
  }
}

TEST(ComputerFaults, AFreezeDelaysWhatItHears) {
  Scenario scenario = with_computers({0}, 1, 6.0);
  scenario.radio.delay_s = 0.1;
  scenario.faults = {of_computer(Fault::Kind::Freeze, 1.5, 2.0)};
  const Life life = life_of_computer(scenario);
  EXPECT_EQ(life.starts.size(), 1U);
  EXPECT_EQ(life.heard_ns, (std::vector<std::int64_t>{100'000'000, 1'100'000'000, 3'500'000'000, 3'500'000'000,
                                                      4'100'000'000, 5'100'000'000}));
}

TEST(ComputerFaults, OneThatFindsItAwayIsAnIncident) {
  Scenario scenario = with_computers({0}, 1, 6.0);
  scenario.faults = {of_computer(Fault::Kind::Restart, 1.0, 3.0), of_computer(Fault::Kind::PowerFailure, 2.0, 3.0)};
  const Outcome outcome = life_of_computer(scenario).outcome;
  EXPECT_EQ(outcome.counters.faults, 1U);
  ASSERT_EQ(outcome.incidents.size(), 2U);
  EXPECT_EQ(outcome.incidents[0].kind, IncidentKind::FaultInjected);
  EXPECT_EQ(outcome.incidents[1].kind, IncidentKind::FaultWithoutEffect);
  EXPECT_EQ(outcome.incidents[1].a, EntityId{1U});
}

// A fleet that waits for its server is not accused while a fault keeps the server from its work.
TEST(ComputerFaults, ExcuseTheFleet) {
  Scenario scenario = with_computers({0}, 1, 100.0);
  scenario.stuck_after = seconds(20.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{3U}, seconds(1.0)}};
  const auto accused = [&] {
    const Outcome outcome = life_of_computer(scenario).outcome;
    return std::ranges::count_if(outcome.incidents, [](const Incident& incident) {
      return incident.kind == IncidentKind::Deadlock || incident.kind == IncidentKind::Livelock ||
             incident.kind == IncidentKind::Starvation || incident.kind == IncidentKind::StandstillInContract;
    });
  };
  EXPECT_GT(accused(), 0);
  scenario.faults = {of_computer(Fault::Kind::Freeze, 0.5, 200.0)};
  EXPECT_EQ(accused(), 0);
}

bool accuses_safe_mode(const Outcome& outcome) {
  return std::ranges::count(outcome.incidents, IncidentKind::SafeModeInContract, &Incident::kind) > 0;
}

TEST(Computers, LinksToThemAreLinksOfNormalOperation) {
  Scenario scenario = with_computers({0}, 1, 100.0);
  scenario.law.reaction_s = 5.0;
  const auto accused = [&](double delay_s) {
    scenario.radio.delay_s = delay_s;
    const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (b.role == FP_AGV && e.kind == FP_EVENT_START) host.safe_mode(c, 1);
      if (b.role == FP_COMPUTER) {
        host.send_broadcast(c, &e.now_ns, sizeof e.now_ns);
        host.set_timer(c, 0, e.now_ns + 500'000'000);
      }
    };
    return accuses_safe_mode(judged(scenario, handler));
  };
  EXPECT_TRUE(accused(1.0)) << "the server is heard well, so that the AGV stands without a reason";
  EXPECT_FALSE(accused(3.0)) << "no other AGV is there: the link to the server is out of the contract";
}

// The AGV reports twice a second, and the server says nothing.
TEST(Computers, LinksFromAgvsToThemCountToo) {
  Scenario scenario = with_computers({0}, 1, 100.0);
  scenario.law.reaction_s = 5.0;
  const auto accused = [&](double delay_s) {
    scenario.radio.delay_s = delay_s;
    const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (b.role != FP_AGV) return;
      if (e.kind == FP_EVENT_START) host.safe_mode(c, 1);
      host.send_unicast(c, &e.now_ns, sizeof e.now_ns, 1);
      host.set_timer(c, 0, e.now_ns + 500'000'000);
    };
    return accuses_safe_mode(judged(scenario, handler));
  };
  EXPECT_TRUE(accused(1.0));
  EXPECT_FALSE(accused(3.0));
}

// A thousand messages a second on the wire are nothing on the radio.
TEST(Computers, AWireIsNoPartOfTheRadiosBooks) {
  Scenario scenario = with_computers({0}, 2, 20.0);
  scenario.radio.air_time_s = 0.01;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 1) return;
    host.send_unicast(c, &e.now_ns, sizeof e.now_ns, 2);
    host.set_timer(c, 0, e.now_ns + 1'000'000);
  };
  const Outcome outcome = judged(scenario, handler);
  EXPECT_EQ(outcome.counters.messages_sent, 20'001U);
  EXPECT_EQ(outcome.counters.receptions, 0U);
  EXPECT_EQ(outcome.counters.received, 0U);
  EXPECT_EQ(outcome.counters.under_way, 0U);
  EXPECT_TRUE(outcome.incidents.empty());
}

// Of two computers with antennas that are far apart, what one sends by radio drowns nothing at the other.
TEST(Computers, AWireDoesNotDrownTheRadio) {
  Scenario scenario = with_computers({0}, 2, 20.0);
  scenario.computers[0].at_m = Vec2(5.0, 0.0);
  scenario.computers[1].at_m = Vec2(5000.0, 0.0);
  scenario.radio.range_m = 100.0;
  scenario.radio.contention.interference = true;
  scenario.radio.contention.contention_window = 1;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 1) return;
    host.send_unicast(c, &e.now_ns, sizeof e.now_ns, b.self == 0 ? 1 : 0);
    host.set_timer(c, 0, e.now_ns + 5'000'000);
  };
  const Outcome outcome = test::simulate_with(scenario, handler);
  EXPECT_GT(outcome.counters.received, 1000U);
  EXPECT_EQ(outcome.counters.lost_by_interference, 0U);
}

TEST(Computers, ARecordedRunPlaysTheSame) {
  Scenario scenario = hard(with_computers({0, 3}, 2));
  scenario.faults = {of_computer(Fault::Kind::Freeze, 3.0, 2.0)};
  scenario.faults[0].agv = EntityId{3U};
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    fp_message message{};
    message.struct_size = sizeof message;
    while (host.get_message(c, &message) == FP_OK) host.log(c, "heard");
    if (e.kind == FP_EVENT_MESSAGE) return;
    host.send_broadcast(c, &e.now_ns, sizeof e.now_ns);
    host.set_timer(c, b.self, e.now_ns + 300'000'000);
    if (b.role == FP_COMPUTER) host.move(c, 0);
  };
  const auto run = [&](const RunWatch& watch) {
    test::ToldRun told;
    test::Listener listener(told.trace);
    test::current_handler = &handler;
    told.outcome = simulate(scenario, test::handler_software(scenario), {}, &listener, watch);
    test::current_handler = nullptr;
    return told;
  };
  CallTape tape;
  RunWatch record, play;
  record.record = &tape;
  const test::ToldRun recorded = run(record);
  const std::string bytes = tape.take();
  play.play = bytes;
  test::expect_same(run({}), recorded);
  const RoleSoftware untouchable{&test::untouchable_agent()};
  test::ToldRun played;
  test::Listener listener(played.trace);
  played.outcome = simulate(scenario, {untouchable, {untouchable, untouchable}}, {}, &listener, play);
  test::expect_same(played, recorded);
}

TEST(Computers, NeedAProgramThatServesThem) {
  const Scenario scenario = with_computers({0}, 1);
  fp_agent_type on_board_only = test::handler_agent();
  on_board_only.flags = FP_DETERMINISTIC;
  EXPECT_THROW(simulate(scenario, {{&test::handler_agent()}, {{&on_board_only}}}, {}), InputError);
  on_board_only.flags |= FP_SERVES_COMPUTERS;
  on_board_only.abi_minor = 4;  // the flag meant nothing then
  EXPECT_THROW(simulate(scenario, {{&test::handler_agent()}, {{&on_board_only}}}, {}), InputError);
  EXPECT_THROW(simulate(scenario, test::handler_agent(), {}), InputError) << "the computer has none";
}

}  // namespace
}  // namespace fleetproof::computers_test
