// Transports that no AGV is given: who is told of them, who may pick their loads, what a withdrawal does.
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "core/outcome/trace_records.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "laws/laws.hpp"
#include "tests/core/helped.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/reference_agent.hpp"

namespace fleetproof::open_orders_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t kServer = 2;

// AGVs at stations 0 and 3, a server, and an open transport from station 0 to station 1.
Scenario with_server(double horizon_s = 60.0) {
  Scenario scenario = test::row_of_tens({0, 3}, horizon_s);
  scenario.computers = {{.name = "server"}};
  scenario.open_orders = {{StationId{0U}, StationId{1U}, seconds(1.0)}};
  return scenario;
}

TransportOrder withdrawn(TransportOrder order, double at_s) {
  order.withdrawn = seconds(at_s);
  return order;
}

// What participants are told of transports: "2 at 1 s: order 0 from 0".
struct Ears {
  std::vector<std::string> told;

  void hear(const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_ORDER && e.kind != FP_EVENT_WITHDRAWN) return;
    const std::string what = e.kind == FP_EVENT_ORDER ? "order" : "withdrawn";
    std::string line = std::to_string(b.self) + " at " + std::to_string(e.now_ns / 1'000'000'000) + " s: " + what +
                       " " + std::to_string(e.order_id);
    if (e.kind == FP_EVENT_ORDER) line += " from " + std::to_string(e.from);
    told.push_back(line);
  }
};

struct Seen {
  Ears ears;
  Outcome outcome;
  test::Recorder trace;
};

// Under the default laws.
Seen run(const Scenario& scenario, const test::Handler& handler = {}) {
  Seen seen;
  const test::Handler hears = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    seen.ears.hear(b, e);
    if (handler) handler(host, c, b, e);
  };
  const auto laws = make_default_laws(scenario, {});
  test::current_handler = &hears;
  seen.outcome = simulate(scenario, test::handler_software(scenario), laws, &seen.trace);
  test::current_handler = nullptr;
  EXPECT_FALSE(seen.outcome.engine_error || seen.outcome.crash) << seen.outcome.message;
  return seen;
}

// Each AGV makes one call after the other: the first at its start, the next ones when an action has ended.
using Call = std::function<void(const fp_host&, fp_controller*)>;
test::Handler in_turn(std::vector<std::vector<Call>> calls, std::int64_t start_ns = 2'000'000'000) {
  auto next = std::make_shared<std::vector<std::size_t>>(calls.size(), 0);
  return [=](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self >= calls.size()) return;
    if (e.kind == FP_EVENT_START) host.set_timer(c, 1, start_ns);
    std::size_t& at = (*next)[b.self];
    if ((e.kind == FP_EVENT_TIMER || e.kind == FP_EVENT_ACTION_DONE) && at < calls[b.self].size())
      calls[b.self][at++](host, c);
  };
}
Call pick(std::uint32_t segment = FP_HERE) {
  return [=](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.pick(c, segment), FP_OK); };
}
Call pick_load(std::uint32_t order, std::int32_t answer = FP_OK, std::uint32_t segment = FP_HERE) {
  return [=](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.pick_load(c, segment, order), answer); };
}
Call drop(std::uint32_t segment) {
  return [=](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.drop(c, segment), FP_OK); };
}
Call move(std::uint32_t segment) {
  return [=](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.move(c, segment), FP_OK); };
}
Call holds(std::uint32_t order) {
  return [=](const fp_host& host, fp_controller* c) {
    std::uint32_t on_board = 77;
    EXPECT_EQ(host.get_load(c, &on_board), FP_OK);
    EXPECT_EQ(on_board, order);
  };
}

std::vector<IncidentKind> accused(const Outcome& outcome) {
  std::vector<IncidentKind> kinds;
  for (const Incident& incident : outcome.incidents) {
    if (accuses(incident.kind)) kinds.push_back(incident.kind);
  }
  return kinds;
}

TEST(OpenOrders, AreToldToEveryComputerAndToNoAgv) {
  Scenario scenario = with_server();
  scenario.computers.push_back({.name = "other"});
  EXPECT_THAT(run(scenario).ears.told, ElementsAre("2 at 1 s: order 0 from 0", "3 at 1 s: order 0 from 0"));
}

TEST(OpenOrders, AreToldToEveryAgvWithoutComputers) {
  Scenario scenario = with_server();
  scenario.computers.clear();
  EXPECT_THAT(run(scenario).ears.told, ElementsAre("0 at 1 s: order 0 from 0", "1 at 1 s: order 0 from 0"));
}

TEST(OpenOrders, AreNumberedBehindTheAssignedOnes) {
  Scenario scenario = with_server();
  scenario.agvs[1].transports = {{StationId{2U}, StationId{3U}, seconds(5.0)}};
  EXPECT_THAT(run(scenario).ears.told, ElementsAre("2 at 1 s: order 1 from 0", "1 at 5 s: order 0 from 2"));
}

TEST(OpenOrders, ABriefingSaysWhetherThereAreAny) {
  Scenario scenario = with_server();
  for (const std::uint32_t wanted : {FP_ORDERS_OPEN, FP_ORDERS_ASSIGNED}) {
    run(scenario,
        [&](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event&) { EXPECT_EQ(b.orders, wanted); });
    scenario.open_orders.clear();
  }
}

TEST(OpenOrders, WhicheverAgvStandsThereMayPick) {
  for (const auto& first : {pick(), pick_load(0)}) {
    const Seen seen = run(with_server(), in_turn({{first, holds(0)}, {}}));
    const auto moves = seen.trace.of(TraceKind::LoadMoves);
    ASSERT_EQ(moves.size(), 2U);
    EXPECT_FALSE(moves[0].entity.valid()) << "no AGV has it yet";
    EXPECT_EQ(moves[1].entity, AgvId{0U});
  }
  Scenario other = with_server();
  other.open_orders[0].from = StationId{3U};
  EXPECT_EQ(run(other, in_turn({{}, {pick()}})).trace.of(TraceKind::LoadMoves).at(1).entity, AgvId{1U});
}

TEST(OpenOrders, OneThatNobodyWasToldOfYetIsInvalid) {
  run(with_server(), in_turn({{pick_load(0, FP_INVALID), pick_load(1, FP_INVALID)}, {}}, 500'000'000));
}

TEST(OpenOrders, OneWhoseLoadIsElsewhereIsRefused) { run(with_server(), in_turn({{}, {pick_load(0, FP_REFUSED)}})); }

TEST(OpenOrders, APickTakesTheOwnLoadsFirstAndThenTheOldestOpenOne) {
  Scenario scenario = with_server();
  scenario.open_orders = {{StationId{0U}, StationId{2U}, seconds(1.5)}, {StationId{0U}, StationId{2U}, seconds(1.0)}};
  EXPECT_EQ(run(scenario, in_turn({{pick(), holds(1)}, {}})).outcome.counters.transports_released, 2U);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, seconds(1.8)}};
  run(scenario, in_turn({{pick(), holds(0)}, {}}));
}

TEST(OpenOrders, ADeliveryIsDoneByWhoPicked) {
  const Seen seen = run(with_server(), in_turn({{pick(), drop(0)}, {}}));
  ASSERT_EQ(seen.trace.of(TraceKind::TransportDone).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::TransportDone)[0].entity, AgvId{0U});
  EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
  EXPECT_THAT(accused(seen.outcome), IsEmpty());
}

// AGV 0 brings the load to station 2, which is wrong. AGV 1 fetches it there and brings it to station 1.
TEST(OpenOrders, OneThatIsPutDownElsewhereIsOpenAgain) {
  std::vector<std::int32_t> answers;
  const auto by_either = in_turn({{pick(), move(0), drop(1), move(1), move(0)}, {}});
  const auto handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    by_either(host, c, b, e);
    if (b.self != 1) return;
    if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 60'000'000'000);
    if (e.kind == FP_EVENT_TIMER) answers.push_back(host.pick_load(c, 2, 0));
    std::uint32_t loaded = 0;
    if (e.kind == FP_EVENT_ACTION_DONE && host.is_loaded(c, &loaded) == FP_OK && loaded == 1)
      answers.push_back(host.drop(c, 1));
  };
  const Seen seen = run(with_server(150.0), handler);
  EXPECT_THAT(answers, ElementsAre(FP_OK, FP_OK));
  ASSERT_EQ(seen.trace.of(TraceKind::TransportDone).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::TransportDone)[0].entity, AgvId{1U});
  ASSERT_THAT(accused(seen.outcome), ElementsAre(IncidentKind::LoadAtWrongStation));
  EXPECT_EQ(seen.outcome.incidents[0].a, AgvId{0U}) << "that put it down there";
}

TEST(OpenOrders, ARestartedComputerIsToldWhatIsNotDone) {
  Scenario scenario = with_server(100.0);
  scenario.open_orders = {{StationId{0U}, StationId{1U}, seconds(1.0)},
                          {StationId{3U}, StationId{2U}, seconds(2.0)},
                          withdrawn({StationId{3U}, StationId{2U}, seconds(3.0)}, 4.0)};
  scenario.faults = {test::fault(Fault::Kind::Restart, 40.0, 1.0)};
  scenario.faults[0].agv = EntityId{kServer};
  const Seen seen = run(scenario, in_turn({{pick(), drop(0)}, {pick_load(1)}}, 2'500'000'000));
  EXPECT_THAT(seen.ears.told,
              ElementsAre("2 at 1 s: order 0 from 0", "2 at 2 s: order 1 from 3", "2 at 3 s: order 2 from 3",
                          "2 at 4 s: withdrawn 2", "2 at 41 s: order 1 from 3"))
      << "0 is delivered, 2 is withdrawn, 1 is on board of AGV 1";
}

TEST(OpenOrders, ARestartedAgvIsToldOnlyWithoutComputers) {
  Scenario scenario = with_server(100.0);
  scenario.open_orders.push_back({StationId{3U}, StationId{2U}, seconds(1.0)});
  scenario.faults = {test::fault(Fault::Kind::Restart, 20.0, 1.0)};
  const auto told_again = [&] {
    std::vector<std::string> told = run(scenario, in_turn({{pick_load(0)}, {}})).ears.told;
    std::erase_if(told, [](const std::string& line) { return line.find(" at 21 s") == std::string::npos; });
    return told;
  };
  EXPECT_THAT(told_again(), IsEmpty());
  scenario.computers.clear();
  EXPECT_THAT(told_again(), ElementsAre("0 at 21 s: order 0 from 0", "0 at 21 s: order 1 from 3"));
}

TEST(OpenOrders, AFaultMayNameOne) {
  Scenario scenario = with_server(100.0);
  Fault drop_of_load = test::fault(Fault::Kind::LoadDrop, 7.0, 5.0);
  drop_of_load.agv = {};
  drop_of_load.transport = 0;
  scenario.faults = {drop_of_load};
  const Seen seen = run(scenario, in_turn({{pick(), move(0)}, {}}));
  ASSERT_EQ(seen.trace.of(TraceKind::FaultStrikes).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::FaultStrikes)[0].entity, AgvId{0U}) << "that carries the load";
  EXPECT_EQ(seen.outcome.counters.loads_cleared, 1U);
  EXPECT_EQ(open_transports(seen.outcome.counters), 0U);
  EXPECT_EQ(std::ranges::count(seen.outcome.incidents, IncidentKind::LoadMovedByNobody, &Incident::kind), 0);
}

TEST(OpenOrders, ABreakdownOnTheWayHoldsWhoPicked) {
  Scenario scenario = with_server(100.0);
  Fault breakdown = test::fault(Fault::Kind::Breakdown, 2.0, 10.0);
  breakdown.agv = {};
  breakdown.transport = 0;
  scenario.faults = {breakdown};
  const Seen seen = run(scenario, in_turn({{pick(), drop(0)}, {}}));
  ASSERT_EQ(seen.trace.of(TraceKind::FaultOver).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::FaultOver)[0].entity, AgvId{0U});
  EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
}

TEST(OpenOrders, ReferenceAgentsThatAreOnBoardAloneSayWhyTheyCannotStart) {
  Scenario scenario = with_server();
  scenario.computers.clear();
  for (const char* name : {"hull-lock", "reckless", "timeout-grant"}) {
    const Outcome outcome = simulate(scenario, test::reference_agent(name), {});
    EXPECT_TRUE(outcome.crash) << name;
    EXPECT_THAT(outcome.message, testing::HasSubstr("create() returned null: it carries out assigned transports only"));
  }
  scenario.agvs[0].transports = std::exchange(scenario.open_orders, {});
  EXPECT_FALSE(simulate(scenario, test::reference_agent("hull-lock"), {}).crash);
}

// ---- withdrawal

TEST(Withdrawal, OfALoadThatNobodyHasTakenIsTheEnd) {
  Scenario scenario = with_server();
  scenario.open_orders[0].withdrawn = seconds(4.0);
  const Seen seen = run(scenario, in_turn({{pick_load(0, FP_REFUSED), pick(), holds(FP_NONE)}, {}}, 5'000'000'000));
  EXPECT_THAT(seen.ears.told, ElementsAre("2 at 1 s: order 0 from 0", "2 at 4 s: withdrawn 0"));
  EXPECT_EQ(seen.outcome.counters.transports_withdrawn, 1U);
  EXPECT_EQ(open_transports(seen.outcome.counters), 0U);
  EXPECT_THAT(accused(seen.outcome), IsEmpty());
  EXPECT_FALSE(seen.outcome.stuck);
}

TEST(Withdrawal, OfALoadOnBoardChangesNothing) {
  Scenario scenario = with_server();
  scenario.open_orders[0].withdrawn = seconds(9.0);
  const Seen seen = run(scenario, in_turn({{pick(), drop(0)}, {}}));
  EXPECT_THAT(seen.ears.told, ElementsAre("2 at 1 s: order 0 from 0", "2 at 9 s: withdrawn 0"));
  EXPECT_EQ(seen.outcome.counters.transports_withdrawn, 0U);
  EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
}

TEST(Withdrawal, AfterTheDeliveryIsNothing) {
  Scenario scenario = with_server();
  scenario.open_orders[0].withdrawn = seconds(50.0);
  const Seen seen = run(scenario, in_turn({{pick(), drop(0)}, {}}));
  EXPECT_THAT(seen.ears.told, ElementsAre("2 at 1 s: order 0 from 0"));
  EXPECT_TRUE(seen.trace.of(TraceKind::OrderWithdrawn).empty());
}

// A pick takes 5 s, from 2 s on.
TEST(Withdrawal, DuringAPickLeavesTheAgvEmpty) {
  Scenario scenario = with_server();
  scenario.open_orders[0].withdrawn = seconds(4.0);
  const Seen seen = run(scenario, in_turn({{pick(), holds(FP_NONE)}, {}}));
  EXPECT_EQ(seen.outcome.counters.transports_withdrawn, 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::LoadMoves).size(), 2U) << "it comes and it goes";
  EXPECT_THAT(accused(seen.outcome), IsEmpty()) << "the load is not lost";
}

TEST(Withdrawal, OfAnAssignedTransportIsToldToItsAgv) {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.agvs[0].transports = {withdrawn({StationId{0U}, StationId{1U}, seconds(1.0)}, 4.0)};
  EXPECT_THAT(run(scenario).ears.told, ElementsAre("0 at 1 s: order 0 from 0", "0 at 4 s: withdrawn 0"));
}

TEST(Withdrawal, IsNotToldToWhoHasNotHeardOfTheOrder) {
  Scenario scenario = with_server();
  scenario.open_orders[0].withdrawn = seconds(4.0);
  for (const Fault::Kind kind : {Fault::Kind::Freeze, Fault::Kind::Restart}) {
    scenario.faults = {test::fault(kind, 0.5, 5.0)};
    scenario.faults[0].agv = EntityId{kServer};
    EXPECT_THAT(run(scenario).ears.told, IsEmpty());
  }
  // A start that is put off by a freeze.
  scenario.faults = {test::fault(Fault::Kind::Freeze, 0.4, 5.0), test::fault(Fault::Kind::Restart, 0.5, 0.1)};
  for (Fault& fault : scenario.faults) fault.agv = EntityId{kServer};
  EXPECT_THAT(run(scenario).ears.told, IsEmpty());
}

// Both stand at one station: nothing forbids that here.
TEST(OpenOrders, OfTwoAgvsThatPickOneLoadTheFirstGetsIt) {
  Scenario scenario = with_server();
  scenario.contact_stops = false;
  scenario.agvs[1].start = StationId{0U};
  const auto later = in_turn({{}, {pick_load(0), holds(FP_NONE)}}, 4'000'000'000);
  const auto first = in_turn({{pick_load(0), holds(0)}, {}});
  const Seen seen = run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    (b.self == 0 ? first : later)(host, c, b, e);
  });
  EXPECT_EQ(seen.trace.of(TraceKind::LoadMoves).size(), 2U);
  for (const IncidentKind kind : accused(seen.outcome)) {
    EXPECT_NE(kind, IncidentKind::LoadHeldByTwo);
    EXPECT_NE(kind, IncidentKind::LoadVanished);
  }
}

// ---- declarations

struct Declared {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> works, waits;  // AGV and order, AGV and AGV
};
Declared declared(const Seen& seen) {
  Declared found;
  for (const TraceRecord& record : seen.trace.of(TraceKind::WorksOn))
    found.works.emplace_back(record.entity.value, read<traced::WorksOn>(record).transport.value);
  for (const TraceRecord& record : seen.trace.of(TraceKind::WaitingFor))
    found.waits.emplace_back(record.entity.value, read<traced::WaitingFor>(record).agv.value);
  return found;
}

TEST(DeclaredWork, IsSaidByTheAgvItselfOrByAComputer) {
  Scenario scenario = with_server();
  scenario.agvs[1].transports = {{StationId{2U}, StationId{3U}, seconds(1.0)}};
  const Seen seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 2'000'000'000);
    if (e.kind == FP_EVENT_START && b.self == kServer) {
      EXPECT_EQ(host.works_on(c, 0, 1), FP_INVALID) << "not released";
    }
    if (e.kind != FP_EVENT_TIMER) return;
    if (b.self == 0) {
      EXPECT_EQ(host.works_on(c, 0, 1), FP_OK);
      EXPECT_EQ(host.works_on(c, 0, FP_NONE), FP_OK);
      EXPECT_EQ(host.works_on(c, 0, 0), FP_INVALID) << "that of another AGV";
      EXPECT_EQ(host.works_on(c, 0, 9), FP_INVALID);
      EXPECT_EQ(host.works_on(c, 1, 1), FP_INVALID) << "it speaks for itself only";
      EXPECT_EQ(host.declare_waiting(c, 1, 0), FP_INVALID);
      EXPECT_EQ(host.declare_waiting(c, 0, 1), FP_OK);
    }
    if (b.self == kServer) {
      EXPECT_EQ(host.works_on(c, 1, 1), FP_OK);
      EXPECT_EQ(host.works_on(c, 1, 0), FP_OK) << "its own";
      EXPECT_EQ(host.works_on(c, kServer, 1), FP_INVALID) << "no AGV";
      EXPECT_EQ(host.declare_waiting(c, 1, 0), FP_OK);
      EXPECT_EQ(host.declare_waiting(c, 1, FP_NONE), FP_OK);
      EXPECT_EQ(host.declare_waiting(c, 1, kServer), FP_INVALID);
    }
  });
  const Declared found = declared(seen);
  EXPECT_THAT(found.works,
              ElementsAre(std::pair(0U, 1U), std::pair(0U, FP_NONE), std::pair(1U, 1U), std::pair(1U, 0U)));
  EXPECT_THAT(found.waits, ElementsAre(std::pair(0U, 1U), std::pair(1U, 0U), std::pair(1U, FP_NONE)));
}

TEST(DeclaredWork, TakesEffectAfterTheCostsOfTheCallsBeforeIt) {
  Scenario scenario = with_server();
  const Seen seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != kServer || e.kind != FP_EVENT_ORDER) return;
    host.declare_cost_ns(c, 2'000'000'000);
    host.works_on(c, 0, 0);
    host.declare_waiting(c, 0, 1);
  });
  ASSERT_EQ(seen.trace.of(TraceKind::WorksOn).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::WorksOn)[0].at, at_seconds(3.0));
  EXPECT_EQ(seen.trace.of(TraceKind::WaitingFor).at(0).at, at_seconds(3.0));
}

TEST(DeclaredWork, EndsWithTheMemoryOfWhoSaidIt) {
  for (const std::uint32_t restarts : {0U, 1U, kServer}) {
    Scenario scenario = with_server();
    scenario.faults = {test::fault(Fault::Kind::Restart, 10.0, 1.0)};
    scenario.faults[0].agv = EntityId{restarts};
    const Seen seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (b.boot > 0) return;
      if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 2'000'000'000);
      if (e.kind != FP_EVENT_TIMER) return;
      if (b.self == 0) host.works_on(c, 0, 0), host.waiting_for(c, 1);
      if (b.self == kServer) host.works_on(c, 1, 0), host.declare_waiting(c, 1, 0);
    });
    const Declared found = declared(seen);
    const std::size_t taken_back = restarts == 1 ? 0 : 1;  // AGV 1 has said nothing
    ASSERT_EQ(found.works.size(), 2 + taken_back);
    ASSERT_EQ(found.waits.size(), 2 + taken_back);
    if (taken_back == 0) continue;
    EXPECT_EQ(found.works[2], std::pair(restarts == kServer ? 1U : 0U, FP_NONE));
    EXPECT_EQ(found.waits[2], std::pair(restarts == kServer ? 1U : 0U, FP_NONE));
  }
}

TEST(OpenOrders, ARecordedRunPlaysTheSame) {
  Scenario scenario = with_server(100.0);
  scenario.open_orders.push_back(withdrawn({StationId{3U}, StationId{2U}, seconds(3.0)}, 20.0));
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == kServer && e.kind == FP_EVENT_ORDER) {
      host.works_on(c, e.order_id, e.order_id);
      host.declare_waiting(c, e.order_id, 1 - e.order_id);
      host.works_on(c, 9, 9);
      host.send_unicast(c, &e.order_id, sizeof e.order_id, e.order_id);
    }
    fp_message message{};
    message.struct_size = sizeof message;
    if (b.self != kServer && host.get_message(c, &message) == FP_OK) host.pick_load(c, FP_HERE, b.self);
    if (e.kind == FP_EVENT_ACTION_DONE) host.drop(c, b.self == 0 ? 0 : 2);
  };
  const auto play = [&](const RunWatch& watch, const FleetSoftware& software) {
    test::ToldRun told;
    test::Listener listener(told.trace);
    test::current_handler = &handler;
    told.outcome = simulate(scenario, software, {}, &listener, watch);
    test::current_handler = nullptr;
    return told;
  };
  CallTape tape;
  RunWatch record, playing;
  record.record = &tape;
  const test::ToldRun recorded = play(record, test::handler_software(scenario));
  EXPECT_EQ(recorded.outcome.counters.transports_done, 2U);
  const std::string bytes = tape.take();
  playing.play = bytes;
  test::expect_same(play({}, test::handler_software(scenario)), recorded);
  const RoleSoftware untouchable{&test::untouchable_agent()};
  test::expect_same(play(playing, {untouchable, {untouchable}}), recorded);
}

// ---- the operator at a standstill

TEST(OpenOrdersAtAStandstill, TheComputersAreRestartedFirstAndThenTheLongestIdleAgv) {
  Scenario scenario = with_server(200.0);
  scenario.computers.push_back({.name = "other"});
  scenario.stuck_after = seconds(30.0);
  scenario.operator_help = test::comes_after(10.0);
  const Seen seen = run(scenario);
  std::vector<std::uint32_t> restarted;
  for (const TraceRecord& record : seen.trace.of(TraceKind::OperatorAssists)) restarted.push_back(record.entity.value);
  EXPECT_THAT(restarted, ElementsAre(2U, 3U, 0U, 1U, 0U, 1U)) << "nobody has declared whose work it is";
  EXPECT_TRUE(seen.outcome.stuck);
}

TEST(OpenOrdersAtAStandstill, AfterWorkTheComputersComeFirstAgain) {
  Scenario scenario = with_server(160.0);
  scenario.stuck_after = seconds(30.0);
  scenario.operator_help = test::comes_after(10.0);
  const Seen seen = run(scenario, in_turn({{move(0)}, {}}, 60'000'000'000));
  std::vector<std::uint32_t> restarted;
  for (const TraceRecord& record : seen.trace.of(TraceKind::OperatorAssists)) restarted.push_back(record.entity.value);
  EXPECT_THAT(restarted, ElementsAre(kServer, kServer, 1U));
}

}  // namespace
}  // namespace fleetproof::open_orders_test
