// Contact is physics: the world stops bodies that touch, and the law files the touch. In random worlds, both name the
// same pairs at the same instants.
#include "core/outcome/trace_records.hpp"
#include "laws/comparison.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/oracle/whole_runs.hpp"

namespace fleetproof::contacts_and_law_test {
namespace {

using Pair = std::pair<EntityId, EntityId>;

struct Touches {
  std::map<Pair, SimTime> of_world, of_law;
  std::int64_t speed_um_s = 0;  // of the last one that the law files
};

void expect_stands_from(const TimelineKeeper& timelines, const Scenario& scenario, EntityId body, SimTime at) {
  if (body.index() >= scenario.agvs.size()) return;
  for (const Piece& piece : timelines.of(body))
    EXPECT_TRUE(piece.manner == Manner::Rest || piece.end <= at) << "AGV " << body.index() << " goes on";
}

Touches run(const Scenario& scenario, const fp_agent_type& agent) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law("exact")->make(scenario));
  laws.push_back(std::make_unique<TimelineKeeper>(scenario));
  const auto& timelines = static_cast<const TimelineKeeper&>(*laws[1]);
  test::Recorder recorder;
  const Outcome outcome = simulate(scenario, agent, laws, &recorder);
  Touches touches;
  for (const TraceRecord& record : recorder.of(TraceKind::Contact)) {
    const EntityId other = read<traced::Contact>(record).other;
    touches.of_world[{std::min(record.entity, other), std::max(record.entity, other)}] = record.at;
  }
  for (const Violation& violation : outcome.violations) {
    if (!violation.contact) continue;
    EXPECT_TRUE(touches.of_law.emplace(Pair{violation.a, violation.b}, violation.closest_at).second) << "filed twice";
    expect_stands_from(timelines, scenario, violation.a, violation.closest_at);
    expect_stands_from(timelines, scenario, violation.b, violation.closest_at);
    EXPECT_EQ(violation.min_clearance_um, 0);
    touches.speed_um_s = violation.relative_speed_um_s;
  }
  return touches;
}

TEST(ContactsAndLaw, TheWorldStopsWhatTheLawFilesAndTheLawFilesWhatTheWorldStops) {
  const AgentPrograms programs;
  const auto families = layout_families();
  std::size_t contacts = 0;
  for (int i = 0; i < 480; ++i) {
    SCOPED_TRACE(testing::Message() << "world " << i);
    Scenario scenario = oracle::run_of(i, families[static_cast<std::size_t>(i) % families.size()].name, 120.0);
    scenario.contact_stops = true;
    // Bodies of many shapes, so that sides, corners and nearly parallel sides meet.
    for (std::size_t k = 0; k < scenario.vehicle_types.size(); ++k)
      scenario.vehicle_types[k].footprint.width_m += 0.0002 * i;
    const Touches touches = run(scenario, programs.find("reckless", "test"));
    contacts += touches.of_world.size();
    for (const auto& [pair, at] : touches.of_world) {
      const auto filed = touches.of_law.find(pair);
      ASSERT_NE(filed, touches.of_law.end()) << pair.first.index() << " and " << pair.second.index() << " not filed";
      EXPECT_LE(std::abs((filed->second - at).count()), 2);
    }
    for (const auto& [pair, at] : touches.of_law)
      EXPECT_TRUE(touches.of_world.contains(pair))
          << pair.first.index() << " and " << pair.second.index() << " do not stop at " << to_ns(at);
  }
  EXPECT_GT(contacts, 250U);
}

// AGV 0 drives 10 m in a row, with an obstacle on the way or beside it.
Touches drive_with(const ObstacleSetup& obstacle) {
  Scenario scenario = test::row_of_tens({0});
  scenario.obstacles.push_back(obstacle);
  const test::Handler moves = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_START) host.move(c, 0);
  };
  test::current_handler = &moves;
  const Touches touches = run(scenario, test::handler_agent());
  test::current_handler = nullptr;
  return touches;
}

TEST(ContactsAndLaw, AgreeAboutGapsOfAMicrometre) {
  for (const double gap_um : {-1.0, 0.0, 0.5, 0.99, 1.01, 1.5, 1.9, 2.5}) {
    const Touches touches = drive_with({"shelf", {2.0, 1.0}, {{5.0, 1.0 + 1e-6 * gap_um}, Vec2::UnitX()}});
    EXPECT_EQ(touches.of_world.size(), gap_um < 1.0 ? 1U : 0U) << gap_um;
    EXPECT_EQ(touches.of_law.size(), gap_um < 1.0 ? 1U : 0U) << gap_um;
  }
}

TEST(ContactsAndLaw, TheSpeedIsThatJustBeforeTheStop) {
  const Touches met = drive_with({"box", {1.0, 1.0}, {{5.3, 0.0}, Vec2::UnitX()}});  // 4 m ahead of the nose
  EXPECT_EQ(met.of_law.size(), 1U);
  EXPECT_NEAR(static_cast<double>(met.speed_um_s), 2e6, 2.0);
}

}  // namespace
}  // namespace fleetproof::contacts_and_law_test
