// Books of transports, kept apart from those of the engine: each is delivered once, withdrawn, or it is known where its
// load is. In drawn runs with restarts, freezes, power failures and lost disks of AGVs and of the server.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "core/base/random.hpp"
#include "core/outcome/trace_records.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "laws/laws.hpp"
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::order_books_test {
namespace {

constexpr std::uint32_t kServer = 2;

Scenario drawn_world(std::uint32_t number, bool with_server) {
  Draws draws(stream_key(number, Stream::Transports));
  Scenario scenario = test::row_of_tens({0, 3}, 300.0);
  scenario.seed = number;
  scenario.contact_stops = false;  // one row, and nobody looks where it goes
  scenario.radio.delay_s = 0.2;
  if (with_server) scenario.computers = {{.name = "server"}};
  const auto order = [&](double release_s) {
    const std::uint32_t from = draws.below(4);
    TransportOrder drawn{StationId{from}, StationId{(from + 1 + draws.below(3)) % 4}, seconds(release_s)};
    if (draws.uniform() < 0.4) drawn.withdrawn = drawn.release + seconds(draws.uniform(0.0, 60.0));
    return drawn;
  };
  for (double t_s = 0.0; t_s < 250.0; t_s += draws.exponential(15.0)) scenario.open_orders.push_back(order(t_s));
  for (AgvSetup& agv : scenario.agvs) agv.transports.push_back(order(draws.uniform(0.0, 100.0)));
  constexpr std::array kKinds = {Fault::Kind::Restart, Fault::Kind::Freeze, Fault::Kind::PowerFailure,
                                 Fault::Kind::DiskLoss};
  for (int i = 0; i < 8; ++i) {
    Fault fault = test::fault(kKinds[draws.below(kKinds.size())], draws.uniform(0.0, 280.0), draws.uniform(0.1, 30.0));
    fault.agv = EntityId{draws.below(with_server ? 3 : 2)};
    scenario.faults.push_back(fault);
  }
  for (std::uint32_t i = 0; i < scenario.open_orders.size(); i += 7) {
    Fault fault = test::fault(Fault::Kind::LoadDrop, draws.uniform(0.0, 10.0), 20.0);
    fault.agv = {};
    fault.transport = i;
    fault.ahead_m = 3.0, fault.left_m = 20.0;  // there is room
    scenario.faults.push_back(fault);
  }
  return scenario;
}

// An AGV that goes to and fro, picks what it may and puts it down where it belongs, or, now and then, elsewhere.
void wander(const fp_host& host, fp_controller* c, const fp_briefing& b,
            const std::map<std::uint32_t, std::uint32_t>& to, std::uint32_t& station, std::uint32_t step) {
  std::uint32_t order = FP_NONE;
  host.get_load(c, &order);
  const std::uint64_t dice = host.random(c, 1, step + 1000 * b.boot);
  const auto goal = to.find(order);
  if (order != FP_NONE && goal != to.end() && (goal->second == station || dice % 11 == 0)) {
    host.drop(c, FP_HERE);
  } else if (order == FP_NONE && dice % 3 != 0) {
    const std::uint32_t wanted = to.empty() ? 0 : std::next(to.begin(), static_cast<long>(dice % to.size()))->first;
    if (dice % 5 == 0 || host.pick_load(c, FP_HERE, wanted) != FP_OK) host.pick(c, FP_HERE);
  } else {
    const bool right = station == 0 || (station < 3 && (dice >> 8) % 2 == 0);
    if (host.move(c, right ? station : station - 1) == FP_OK) station += right ? 1 : -1U;
  }
}

// What has been told to one agent since its start, and what it was told that it must not have been told.
struct Memory {
  std::set<std::uint32_t> orders;
  std::uint32_t boot = 0;
};

struct Books {
  std::map<std::uint32_t, Memory> told;                 // by participant
  std::map<std::uint32_t, std::uint32_t> destinations;  // of all that anybody was told of
  int wrong = 0;                                        // withdrawals of what was not told

  void hear(const fp_briefing& b, const fp_event& e) {
    Memory& memory = told[b.self];
    if (e.kind == FP_EVENT_START) memory = {{}, b.boot};
    if (e.kind == FP_EVENT_ORDER) {
      memory.orders.insert(e.order_id);
      destinations[e.order_id] = e.to;
    }
    if (e.kind == FP_EVENT_WITHDRAWN && !memory.orders.contains(e.order_id)) ++wrong;
  }
};

// By transport: what became of it, as the trace alone says.
struct Account {
  int released = 0, done = 0, withdrawn = 0, cleared = 0, picked = 0;
  std::optional<Holder> where;
};
std::map<std::uint32_t, Account> accounts_of(const test::Recorder& trace, SimTime until = kForever) {
  std::map<std::uint32_t, Account> accounts;
  std::map<LoadId, std::uint32_t> transport_of;
  std::uint32_t released = 0;
  for (const TraceRecord& record : trace.records) {
    if (record.at > until) break;
    if (record.kind == TraceKind::OrderReleased) {
      released = read<traced::OrderReleased>(record).transport.value;
      ++accounts[released].released;
    } else if (record.kind == TraceKind::TransportDone) {
      ++accounts[read<traced::TransportDone>(record).transport.value].done;
    } else if (record.kind == TraceKind::LoadMoves) {
      const auto [load, to] = read<traced::LoadMoves>(record);
      Account& account = accounts[transport_of.try_emplace(load, released).first->second];
      account.where = to;
      account.picked += to.kind == Holder::Kind::Agv ? 1 : 0;
      account.withdrawn += to.kind == Holder::Kind::Withdrawn ? 1 : 0;
      account.cleared += to.kind == Holder::Kind::ClearedAway ? 1 : 0;
    }
  }
  return accounts;
}

void check(const Scenario& scenario, const Outcome& outcome, const test::Recorder& trace) {
  std::uint64_t released = 0, done = 0, withdrawn = 0, cleared = 0;
  for (const auto& [transport, account] : accounts_of(trace)) {
    EXPECT_EQ(account.released, 1);
    EXPECT_LE(account.done + account.withdrawn + account.cleared, 1) << "one end";
    EXPECT_TRUE(account.withdrawn == 0 || account.picked == 0) << "a load that was taken up is delivered all the same";
    EXPECT_TRUE(account.done == 0 || account.where->kind == Holder::Kind::Station);
    released += 1, done += account.done, withdrawn += account.withdrawn, cleared += account.cleared;
  }
  const Counters& c = outcome.counters;
  EXPECT_EQ(c.transports_released, released);
  EXPECT_EQ(c.transports_done, done);
  EXPECT_EQ(c.transports_withdrawn, withdrawn);
  EXPECT_EQ(c.loads_cleared, cleared);
  EXPECT_EQ(open_transports(c), released - done - withdrawn - cleared);
  for (const Incident& incident : outcome.incidents) {
    const bool is_of_books =
        incident.kind == IncidentKind::LoadHeldByTwo || incident.kind == IncidentKind::LoadVanished ||
        incident.kind == IncidentKind::LoadDeliveredTwice || incident.kind == IncidentKind::LoadMovedByNobody ||
        incident.kind == IncidentKind::LoadPickedByFullAgv;
    EXPECT_FALSE(is_of_books) << info_of(incident.kind).name << " in world " << scenario.seed;
  }
}

struct Totals {
  std::uint64_t done = 0, withdrawn = 0, cleared = 0, restarts = 0;
};

void run_one(std::uint32_t number, Totals& totals) {
  const bool with_server = number % 4 != 0;
  const Scenario scenario = drawn_world(number, with_server);
  Books books;
  std::map<std::uint32_t, std::uint32_t> stations, steps;
  test::Recorder trace;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    books.hear(b, e);
    if (b.role == FP_COMPUTER) {
      for (const std::uint32_t order : books.told[b.self].orders) host.works_on(c, order % 2, order);
      return;
    }
    if (e.kind == FP_EVENT_START) host.set_timer(c, 1, e.now_ns + 1'000'000'000);
    std::uint32_t action = 0;
    host.get_action(c, &action);
    if (e.kind == FP_EVENT_TIMER) host.set_timer(c, 1, e.now_ns + 5'000'000'000);
    if (action == FP_DRIVING || action == FP_TURNING || action == FP_OUT_OF_ORDER) return;
    fp_pose pose{};
    host.get_position(c, &pose);
    stations[b.self] = static_cast<std::uint32_t>(pose.x_m / 10.0 + 0.5);
    wander(host, c, b, books.destinations, stations[b.self], ++steps[b.self]);
  };
  const auto laws = make_default_laws(scenario, {});
  test::current_handler = &handler;
  const Outcome outcome = simulate(scenario, test::handler_software(scenario), laws, &trace);
  test::current_handler = nullptr;
  ASSERT_FALSE(outcome.engine_error || outcome.crash || outcome.hang) << outcome.message << " in world " << number;
  EXPECT_EQ(books.wrong, 0) << "in world " << number;
  check(scenario, outcome, trace);
  totals.done += outcome.counters.transports_done;
  totals.withdrawn += outcome.counters.transports_withdrawn;
  totals.cleared += outcome.counters.loads_cleared;
  for (const auto& [participant, memory] : books.told) totals.restarts += memory.boot;
}

// FLEETPROOF_SEEDS: so many runs, for releases.
TEST(OrderBooks, BalanceInDrawnRuns) {
  const char* wanted = std::getenv("FLEETPROOF_SEEDS");
  const auto runs = static_cast<std::uint32_t>(wanted != nullptr ? std::atoi(wanted) : 300);
  Totals totals;
  for (std::uint32_t number = 1; number <= runs; ++number) run_one(number, totals);
  EXPECT_GT(totals.done, runs);
  EXPECT_GT(totals.withdrawn, runs);
  EXPECT_GT(totals.cleared, runs / 30);
  EXPECT_GT(totals.restarts, runs);
}

// What a restarted server is told is what its books would have, had it never been away.
TEST(OrderBooks, ARestartedServerIsToldExactlyWhatIsNotDone) {
  for (std::uint32_t number = 1; number <= 40; ++number) {
    Scenario scenario = drawn_world(number, true);
    Fault restart = test::fault(Fault::Kind::Restart, 299.0, 0.5);
    restart.agv = EntityId{kServer};
    scenario.faults = {restart};
    std::set<std::uint32_t> told;
    test::Recorder trace;
    std::map<std::uint32_t, std::uint32_t> to, stations, steps;
    const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (e.kind == FP_EVENT_ORDER) to[e.order_id] = e.to;
      if (b.self == kServer && b.boot == 1 && e.kind == FP_EVENT_ORDER) told.insert(e.order_id);
      if (b.self == kServer) return;
      if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 1'000'000'000), stations[b.self] = b.start_station;
      std::uint32_t action = 0;
      host.get_action(c, &action);
      if (e.kind == FP_EVENT_TIMER) host.set_timer(c, 1, e.now_ns + 5'000'000'000);
      if (action != FP_DRIVING && action != FP_TURNING) wander(host, c, b, to, stations[b.self], ++steps[b.self]);
    };
    test::simulate_with(scenario, handler, &trace);
    std::set<std::uint32_t> open;
    for (const auto& [transport, account] : accounts_of(trace, kStart + seconds(299.5))) {
      if (transport >= 2 && account.done + account.withdrawn + account.cleared == 0) open.insert(transport);
    }
    EXPECT_EQ(told, open) << "in world " << number;
  }
}

}  // namespace
}  // namespace fleetproof::order_books_test
