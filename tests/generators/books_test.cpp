// The books of a run, kept a second time by a law that sees nothing but pieces and trace: distance, energy, loads and
// messages must balance at the end of random runs in which everything goes wrong that can.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/error.hpp"
#include "core/motion/activity.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/generators/independent_check.hpp"
#include "tests/support/hard_world.hpp"
#include "tests/support/reference_agent.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::books_test {
namespace {

class Bookkeeper final : public Law {
 public:
  explicit Bookkeeper(const Scenario& scenario) : fleet_(scenario.agvs.size()) {}

  TraceKinds reads() const override {
    return TraceKinds{TraceKind::LoadMoves,     TraceKind::Sent,    TraceKind::Lost,   TraceKind::Received,
                      TraceKind::TransportDone, TraceKind::Appears, TraceKind::Leaves, TraceKind::OperatorAssists};
  }
  void happened(const TraceRecord& record) override {
    switch (record.kind) {
      case TraceKind::LoadMoves:
        holders[record.a] = record.b;
        break;
      case TraceKind::Sent:
        receptions += record.a == FP_NONE ? fleet_ - 1 : 1;
        break;
      case TraceKind::Lost:
        ++lost;
        break;
      case TraceKind::Received:
        ++received;
        break;
      case TraceKind::TransportDone:
        ++done;
        break;
      case TraceKind::OperatorAssists:
        ++helped[record.a];
        break;
      case TraceKind::Leaves:
        if (record.entity.index() >= fleet_) break;
        EXPECT_TRUE(off_floor_.insert(record.entity.index()).second);
        EXPECT_EQ(ended_[record.entity.index()], record.at) << "with its last piece";
        last_.erase(record.entity.index());  // it may come back anywhere
        break;
      case TraceKind::Appears:
        if (record.entity.index() >= fleet_) break;
        EXPECT_EQ(off_floor_.erase(record.entity.index()), 1U);
        ++set_down;
        break;
      default:
        break;
    }
  }
  // Along the curve for a drive, by the poses for the rest, which must not have moved.
  void piece_ended(const Piece& piece) override {
    if (piece.entity.index() >= fleet_) return;
    const auto before = ended_.find(piece.entity.index());
    if (before != ended_.end() && last_.contains(piece.entity.index())) gaps += before->second != piece.begin ? 1 : 0;
    ended_[piece.entity.index()] = piece.end;
    const Pose from = piece.pose_at(piece.begin), to = piece.pose_at(piece.end);
    const auto known = last_.find(piece.entity.index());
    if (known != last_.end())
      largest_jump_m = std::max(largest_jump_m, (known->second.position_m - from.position_m).norm());
    last_[piece.entity.index()] = to;
    if (piece.manner == Manner::Drive) driven_m += piece.way_at(piece.end) - piece.way_begin_m;
  }
  LawResults findings() const override { return {}; }

  std::map<std::uint64_t, std::uint64_t> holders;
  std::map<std::uint64_t, std::uint64_t> helped;  // by what for
  std::uint64_t receptions = 0, lost = 0, received = 0, done = 0, set_down = 0, gaps = 0;
  std::size_t off_floor() const { return off_floor_.size(); }
  double driven_m = 0.0, largest_jump_m = 0.0;

 private:
  std::size_t fleet_;
  std::map<std::size_t, Pose> last_;
  std::map<std::size_t, SimTime> ended_;
  std::set<std::size_t> off_floor_;
};

WorldSpec everything_goes_wrong() {
  WorldSpec spec = test::hard_world(120.0);
  spec.faults.load_drops_per_transport = 0.3;
  spec.faults.load_lies_s = 20.0;
  spec.faults.obstacles_per_hour = 60.0;
  spec.faults.obstacle_stays_s = 20.0;
  return spec;
}

struct Totals {
  std::uint64_t runs = 0, faults = 0, empty = 0, cleared = 0, stops = 0, assists = 0, done = 0, contacts = 0, bends = 0;
  std::uint64_t recovered = 0, restarted = 0;
};

// Where nothing happens that would stir a fleet that stands still.
void leave_alone(FaultRates& faults) {
  faults.protective_stops_per_agv_hour = faults.freezes_per_agv_hour = faults.restarts_per_agv_hour = 0.0;
  faults.breakdowns_per_agv_hour = faults.breakdowns_per_transport = 0.0;
}

std::uint64_t bends(const LogicalMap& map) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(map.lanes(), [](const Lane& lane) { return !lane.curve.is_straight(); }));
}

void check(const Scenario& scenario, const Outcome& outcome, const Bookkeeper& books, const std::string& which) {
  const Counters& c = outcome.counters;
  ASSERT_FALSE(outcome.engine_error) << which << ": " << outcome.message;
  EXPECT_LT(books.largest_jump_m, 1e-6) << which << ": a body never jumps";
  EXPECT_NEAR(static_cast<double>(c.distance_um), books.driven_m * 1e6, 2.0) << which;
  const double slack_ppb = 5.0;
  EXPECT_NEAR(static_cast<double>(c.battery_start_ppb + c.battery_charged_ppb),
              static_cast<double>(c.battery_end_ppb + c.battery_driven_ppb + c.battery_idled_ppb), slack_ppb)
      << which;
  const double needed_ppb = books.driven_m * scenario.vehicle_types[0].battery_per_m * 1e9;
  EXPECT_LE(static_cast<double>(c.battery_driven_ppb), needed_ppb + slack_ppb) << which;
  if (c.batteries_empty == 0) {
    EXPECT_NEAR(static_cast<double>(c.battery_driven_ppb), needed_ppb, slack_ppb) << which;
  }
  EXPECT_EQ(books.holders.size(), c.transports_released) << which << ": every load is somewhere";
  std::uint64_t cleared = 0;
  for (const auto& [load, holder] : books.holders)
    cleared += holder >> 32 == static_cast<std::uint64_t>(Holder::Kind::ClearedAway) ? 1 : 0;
  EXPECT_EQ(cleared, c.loads_cleared) << which;
  EXPECT_EQ(books.done, c.transports_done) << which;
  EXPECT_EQ(books.gaps, 0U) << which << ": on the floor, piece follows piece";
  std::uint64_t assists = c.loads_cleared;
  for (const auto& [what, count] : books.helped) assists += count;
  EXPECT_EQ(assists, c.assists) << which;
  const auto taken_off = books.helped.find(static_cast<std::uint64_t>(Assist::Contact));
  EXPECT_EQ(taken_off == books.helped.end() ? 0 : taken_off->second, books.set_down + books.off_floor()) << which;
  EXPECT_EQ(books.receptions, c.receptions) << which;
  EXPECT_EQ(books.lost, c.receptions_lost) << which;
  EXPECT_EQ(books.received, c.received) << which;
  EXPECT_EQ(c.receptions, c.receptions_lost + c.received + c.under_way) << which;
}

void run(const fp_agent_type& agent, std::uint64_t runs, Totals& totals) {
  const auto families = layout_families();
  for (std::uint64_t i = 0; i < runs; ++i) {
    WorldSpec spec = everything_goes_wrong();
    // Each family in turn: as it is and bent, then both under stress.
    const FamilyRange choice{&families[i % families.size()],
                             i / families.size() % 4 < 2 ? Range::Normal : Range::Stress};
    const bool bent = i / families.size() % 2 == 1;
    if (bent) {
      spec.layout = test::bent_map(choice, 1000 + i);
    } else {
      spec.layout = family_name(choice.family->name, choice.range);
    }
    if (i % 5 == 3) leave_alone(spec.faults);
    RejectionCounts counts;
    Scenario scenario = generate_world(spec, 1000 + i, counts);
    totals.bends += bends(*scenario.map);
    scenario.radio.loss = 0.4;
    scenario.radio.delay_s = 2.0;
    scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
    scenario.agent_clock.call_cost_s = i % 3 == 0 ? 0.01 : 0.0;
    scenario.scanner.on = i % 2 == 0;
    scenario.operator_help = {.on = i % 5 != 0, .least_s = 5.0, .most_s = 20.0, .battery = 0.7};
    if (i % 4 == 3) {  // at once, before they move by themselves
      scenario.stuck_after = seconds(5.0);
      scenario.operator_help.least_s = scenario.operator_help.most_s = 1.0;
    }
    std::vector<std::unique_ptr<Law>> laws;
    laws.push_back(std::make_unique<Bookkeeper>(scenario));
    if (i % 25 == 0) {  // every law survives such a run
      scenario.law.exempt_purposes = Purpose::Charging;
      scenario.law.exempt_radius_m = 1.0;
      for (const auto& law : fleetproof::laws()) {
        if (law.name != "global-step") laws.push_back(law.make(scenario));
      }
    }
    const Outcome outcome = simulate(scenario, agent, laws);
    const auto& books = dynamic_cast<const Bookkeeper&>(*laws[0]);
    check(scenario, outcome, books, scenario.name + ", seed " + std::to_string(1000 + i));
    if (::testing::Test::HasFailure()) return;
    const Counters& c = outcome.counters;
    ++totals.runs;
    totals.faults += c.faults;
    totals.empty += c.batteries_empty;
    totals.cleared += c.loads_cleared;
    totals.stops += c.scanner_stops;
    totals.assists += c.assists;
    totals.done += c.transports_done;
    totals.contacts += c.contacts;
    totals.recovered += books.set_down;
    const auto restarted = books.helped.find(static_cast<std::uint64_t>(Assist::Standstill));
    totals.restarted += restarted == books.helped.end() ? 0 : restarted->second;
  }
}

TEST(Books, BalanceInRunsInWhichEverythingGoesWrong) {
  const std::uint64_t runs = 5 * independent::seed_count();
  Totals totals;
  run(test::reference_agent("reckless"), runs - runs / 10, totals);
  run(test::reference_agent("hull-lock"), runs / 10, totals);
  EXPECT_EQ(totals.runs, runs);
  EXPECT_GT(totals.faults, runs) << "or nothing went wrong";
  EXPECT_GT(totals.empty, runs / 100);
  EXPECT_GT(totals.cleared, runs / 100);
  EXPECT_GT(totals.stops, runs / 100);
  EXPECT_GT(totals.assists, runs / 100);
  EXPECT_GT(totals.done, runs / 10);
  EXPECT_GT(totals.contacts, runs / 100);
  EXPECT_GT(totals.recovered, runs / 10);
  EXPECT_GT(totals.restarted, runs / 1000);
  EXPECT_GT(totals.bends, 10 * runs);
}

}  // namespace
}  // namespace fleetproof::books_test
