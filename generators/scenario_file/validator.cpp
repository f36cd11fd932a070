#include "generators/scenario_file/validator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "generators/scenario_file/radio_fields.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr double kLongestCall_s = 60.0, kLongest_s = 1e9, kLargestBody_m = 100.0, kLargestRate = 1e6;
constexpr double kSmallestRate =
    1e-3;  // slower than any vehicle; keeps every activity within the range of simulated time
constexpr Duration kLongestRun = std::chrono::seconds(10'000'000);
constexpr Duration kLongest = std::chrono::seconds(1'000'000'000);

// A field of the scenario file, turned into a JSON pointer only when there is something to say about it.
struct Field {
  std::string_view list;  // "/agvs"; empty: `name` stands alone
  std::size_t index = 0;
  std::string_view name;  // "/battery"

  std::string pointer() const { return list.empty() ? std::string(name) : fmt::format("{}/{}{}", list, index, name); }
};

class RangeCheck {
 public:
  explicit RangeCheck(const Scenario& scenario) : scenario_(scenario) {}

  Problems run() {
    ensure(scenario_.map != nullptr, "a scenario has a map");
    if (!is_plain_utf8(scenario_.name))
      add(ProblemKind::BadName, Field{{}, 0, "/name"}.pointer(), "a name is UTF-8 without control characters");
    duration({{}, 0, "/horizon_ns"}, scenario_.horizon);
    if (scenario_.horizon > kLongestRun)
      add(ProblemKind::NumberOutOfRange, "/horizon_ns", "a run lasts at most 1e7 s, which is four months");
    duration({{}, 0, "/stuck_after_ns"}, scenario_.stuck_after);
    radio_and_laws();
    if (scenario_.vehicle_types.empty())
      add(ProblemKind::UnknownReference, "/vehicle_types", "at least one vehicle type is needed");
    names("/vehicle_types", scenario_.vehicle_types);
    for (std::size_t i = 0; i < scenario_.vehicle_types.size(); ++i) vehicle(i);
    if (scenario_.agvs.empty()) add(ProblemKind::EmptyFleet, "/agvs", "a scenario needs at least one AGV");
    names("/agvs", scenario_.agvs);
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) agv(i);
    names("/obstacles", scenario_.obstacles);
    for (std::size_t i = 0; i < scenario_.obstacles.size(); ++i) obstacle(i);
    for (std::size_t i = 0; i < scenario_.faults.size(); ++i) fault(i);
    scanner_and_operator();
    return std::move(problems_);
  }

 private:
  void add(ProblemKind kind, std::string pointer, std::string sentence) {
    problems_.push_back({kind, std::move(pointer), std::move(sentence)});
  }

  void within(const Field& field, double value, double low, double high) {
    if (value >= low && value <= high) return;  // false for NaN
    add(ProblemKind::NumberOutOfRange, field.pointer(), fmt::format("{} is outside {} .. {}", value, low, high));
  }

  void positive(const Field& field, double value, double high) {
    if (value > 0.0 && value <= high) return;
    add(ProblemKind::NumberOutOfRange, field.pointer(), fmt::format("{} is not above 0 and at most {}", value, high));
  }

  void duration(const Field& field, Duration value) {
    if (value > Duration::zero() && value <= kLongest) return;
    add(ProblemKind::NumberOutOfRange, field.pointer(),
        fmt::format("{} s is not above 0 and at most 1e9 s", to_seconds(value)));
  }

  void radio_and_laws() {
    for (const auto& [key, sentence] : radio_faults(scenario_.radio))
      add(ProblemKind::NumberOutOfRange, "/radio/" + key, sentence);
    within({{}, 0, "/agent_clock/call_cost_s"}, scenario_.agent_clock.call_cost_s, 0.0, kLongestCall_s);
    within({{}, 0, "/law/safety_distance_m"}, scenario_.law.safety_distance_m, 0.0, kLargestBody_m);
    within({{}, 0, "/law/snapshot_s"}, scenario_.law.snapshot_s, 1e-6, kLongest_s);
    within({{}, 0, "/law/reaction_s"}, scenario_.law.reaction_s, 0.0, kLongest_s);
    within({{}, 0, "/law/exempt_radius_m"}, scenario_.law.exempt_radius_m, 0.0, 100.0);
    within({{}, 0, "/law/min_transports_per_agv_hour"}, scenario_.law.min_transports_per_agv_hour, 0.0, 1e6);
    for (std::size_t i = 0; i < scenario_.law.exempt_pairs.size(); ++i) exempt_pair(i);
  }

  void exempt_pair(std::size_t i) {
    constexpr std::string_view kList = "/law/exempt_pairs";
    std::vector<std::string> types;
    for (const VehicleType& type : scenario_.vehicle_types) types.push_back(type.name);
    const auto fault = fault_of_exempt_pair(scenario_.law.exempt_pairs[i], types);
    if (!fault.empty()) add(ProblemKind::UnknownReference, Field{kList, i, {}}.pointer(), fault);
  }

  template <class Named>
  void names(std::string_view list, const std::vector<Named>& all) {
    std::set<std::string_view> seen;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Field field{list, i, "/name"};
      if (const char* fault = fault_of_name(all[i].name)) add(ProblemKind::BadName, field.pointer(), fault);
      if (!seen.insert(all[i].name).second)
        add(ProblemKind::BadName, field.pointer(),
            fmt::format("the name {} is taken; choose another", in_quotes(all[i].name)));
    }
  }

  void footprint(std::string_view list, std::size_t i, const Footprint& f) {
    positive({list, i, "/length_m"}, f.length_m, kLargestBody_m);
    positive({list, i, "/width_m"}, f.width_m, kLargestBody_m);
  }

  void heading(const Field& field, const Vec2& h) {
    if (std::abs(h.squaredNorm() - 1.0) <= kUnitVector) return;
    add(ProblemKind::NumberOutOfRange, field.pointer(),
        fmt::format("[{}, {}] is not a direction; a heading is a unit vector", h.x(), h.y()));
  }

  void vehicle(std::size_t i) {
    constexpr std::string_view kList = "/vehicle_types";
    const auto& v = scenario_.vehicle_types[i];
    footprint(kList, i, v.footprint);
    within({kList, i, "/drive/speed_mps"}, v.drive.speed_mps, kSmallestRate, kLargestRate);
    within({kList, i, "/drive/acceleration_mps2"}, v.drive.acceleration_mps2, kSmallestRate, kLargestRate);
    within({kList, i, "/drive/deceleration_mps2"}, v.drive.deceleration_mps2, kSmallestRate, kLargestRate);
    within({kList, i, "/turn/speed_radps"}, v.turn.speed_mps, kSmallestRate, kLargestRate);
    within({kList, i, "/turn/acceleration_radps2"}, v.turn.acceleration_mps2, kSmallestRate, kLargestRate);
    within({kList, i, "/turn/deceleration_radps2"}, v.turn.deceleration_mps2, kSmallestRate, kLargestRate);
    within({kList, i, "/battery_per_m"}, v.battery_per_m, 0.0, 1.0);
    within({kList, i, "/charge_per_s"}, v.charge_per_s, 0.0, 1.0);
    within({kList, i, "/pick_s"}, v.pick_s, 0.0, kLongest_s);
    within({kList, i, "/drop_s"}, v.drop_s, 0.0, kLongest_s);
    within({kList, i, "/storage_spread_s"}, v.storage_spread_s, 0.0, kLongest_s);
    within({kList, i, "/other_spread_s"}, v.other_spread_s, 0.0, kLongest_s);
    within({kList, i, "/settle_s"}, v.settle_s, 0.0, kLongest_s);
    within({kList, i, "/battery_idle_per_s"}, v.battery_idle_per_s, 0.0, 1.0);
    within({kList, i, "/lateral_mps2"}, v.lateral_mps2, 0.0, kLargestRate);
    within({kList, i, "/speed_deviation"}, v.speed_deviation, 0.0, 0.5);
    within({kList, i, "/loaded/extra_length_m"}, v.loaded.extra_length_m, 0.0, kLargestBody_m);
    within({kList, i, "/loaded/extra_width_m"}, v.loaded.extra_width_m, 0.0, kLargestBody_m);
    within({kList, i, "/loaded/speed_share"}, v.loaded.speed_share, 0.1, 1.0);
    within({kList, i, "/loaded/acceleration_share"}, v.loaded.acceleration_share, 0.1, 1.0);
  }

  void from_zero_on(const Field& field, Duration value, Duration most) {
    if (value >= Duration::zero() && value <= most) return;
    add(ProblemKind::NumberOutOfRange, field.pointer(), fmt::format("{} s is outside 0 .. 1e9 s", to_seconds(value)));
  }

  void sensing(std::size_t i, const SensingSetup& s) {
    constexpr std::string_view kList = "/agvs";
    within({kList, i, "/sensing/clock_offset_s"}, s.clock_offset_s, 0.0, 1e6);
    within({kList, i, "/sensing/clock_drift_ppm"}, s.clock_drift_ppm, -1e5, 1e5);
    within({kList, i, "/sensing/position_error_m"}, s.position_error_m, 0.0, kLargestBody_m);
    within({kList, i, "/sensing/position_late_s"}, s.position_late_s, 0.0, 3600.0);
  }

  void fault(std::size_t i) {
    constexpr std::string_view kList = "/faults";
    const Fault& f = scenario_.faults[i];
    from_zero_on({kList, i, "/at_ns"}, f.at, kLongest);
    from_zero_on({kList, i, "/lasts_ns"}, f.lasts, kLongest);
    if (f.agv.index() >= scenario_.agvs.size())
      return add(ProblemKind::UnknownReference, Field{kList, i, "/agv"}.pointer(), "there is no such AGV");
    if (f.transport && *f.transport >= scenario_.agvs[f.agv.index()].transports.size()) {
      add(ProblemKind::UnknownReference, Field{kList, i, "/transport"}.pointer(),
          fmt::format("{} has {} transports; they count from 0", in_quotes(scenario_.agvs[f.agv.index()].name),
                      scenario_.agvs[f.agv.index()].transports.size()));
    }
    if (f.kind != Fault::Kind::LoadDrop) return;
    footprint(kList, i, f.load);
    within({kList, i, "/ahead_m"}, f.ahead_m, -kLargestBody_m, kLargestBody_m);
    within({kList, i, "/left_m"}, f.left_m, -kLargestBody_m, kLargestBody_m);
  }

  void scanner_and_operator() {
    const auto& s = scenario_.scanner;
    within({{}, 0, "/scanner/reaction_s"}, s.reaction_s, 1e-3, 10.0);
    within({{}, 0, "/scanner/margin_m"}, s.margin_m, 0.0, kLargestBody_m);
    within({{}, 0, "/scanner/resume_s"}, s.resume_s, 0.0, kLongest_s);
    const auto& o = scenario_.operator_help;
    within({{}, 0, "/operator/least_s"}, o.least_s, 1.0, kLongest_s);
    within({{}, 0, "/operator/most_s"}, o.most_s, o.least_s, kLongest_s);
    within({{}, 0, "/operator/battery"}, o.battery, 0.01, 1.0);
  }

  bool has_station(StationId id) const { return id.index() < scenario_.map->station_count(); }

  void agv(std::size_t i) {
    constexpr std::string_view kList = "/agvs";
    const auto& a = scenario_.agvs[i];
    if (a.type >= scenario_.vehicle_types.size())
      add(ProblemKind::UnknownReference, Field{kList, i, "/type"}.pointer(), "there is no such vehicle type");
    if (!has_station(a.start))
      add(ProblemKind::UnknownReference, Field{kList, i, "/start"}.pointer(), "there is no such station");
    heading({kList, i, "/heading"}, a.heading);
    within({kList, i, "/battery"}, a.battery, 0.0, 1.0);
    sensing(i, a.sensing);
    for (std::size_t k = 0; k < a.transports.size(); ++k) transport(i, k, a.transports[k]);
    Duration last{};
    for (std::size_t k = 0; k < a.script.size(); ++k) {
      const auto& call = a.script[k];
      const auto place = [&](std::string_view field) { return fmt::format("/agvs/{}/script/{}{}", i, k, field); };
      if (call.segment.index() >= scenario_.map->segment_count())
        add(ProblemKind::UnknownReference, place("/segment"), "there is no such segment");
      if (call.at < last || call.at > kLongest) {
        add(ProblemKind::NumberOutOfRange, place("/at_ns"),
            fmt::format("{} s: calls are listed in order of time, from 0 on", to_seconds(call.at)));
      }
      last = call.at;
    }
  }

  void transport(std::size_t i, std::size_t k, const TransportOrder& order) {
    const auto place = [&](std::string_view field) { return fmt::format("/agvs/{}/transports/{}{}", i, k, field); };
    if (!has_station(order.from)) add(ProblemKind::UnknownReference, place("/from"), "there is no such station");
    if (!has_station(order.to)) add(ProblemKind::UnknownReference, place("/to"), "there is no such station");
    if (order.from == order.to)
      add(ProblemKind::UnknownReference, place("/to"), "a transport leads to another station than it comes from");
    if (order.release < Duration::zero() || order.release > kLongest) {
      add(ProblemKind::NumberOutOfRange, place("/release_ns"),
          fmt::format("{} s is outside 0 .. 1e9 s", to_seconds(order.release)));
    }
  }

  void obstacle(std::size_t i) {
    constexpr std::string_view kList = "/obstacles";
    const auto& o = scenario_.obstacles[i];
    footprint(kList, i, o.footprint);
    heading({kList, i, "/heading"}, o.pose.heading);
    within({kList, i, "/position_m"}, o.pose.position_m.x(), -kLargestCoordinate_m, kLargestCoordinate_m);
    within({kList, i, "/position_m"}, o.pose.position_m.y(), -kLargestCoordinate_m, kLargestCoordinate_m);
    from_zero_on({kList, i, "/appears_ns"}, o.appears, kLongest);
    if (o.leaves != kLongestDuration) from_zero_on({kList, i, "/leaves_ns"}, o.leaves, kLongest);
    if (o.leaves <= o.appears)
      add(ProblemKind::NumberOutOfRange, Field{kList, i, "/leaves_ns"}.pointer(),
          "an obstacle leaves after it has appeared");
  }

  const Scenario& scenario_;
  Problems problems_;
};

class WorldCheck {
 public:
  WorldCheck(const Scenario& scenario, const Reachability& reachability)
      : scenario_(scenario), reachability_(reachability) {}

  Problems run() {
    if (reachability_.core_share() < kSmallestCoreShare) {
      add(ProblemKind::WeakCore, "/layout",
          fmt::format("only {} of {} stations can all reach each other, less than 90 %; add segments that lead back",
                      reachability_.core().size(), scenario_.map->station_count()));
    }
    starts();
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) transports(i);
    return std::move(problems_);
  }

 private:
  void add(ProblemKind kind, std::string pointer, std::string sentence) {
    problems_.push_back({kind, std::move(pointer), std::move(sentence)});
  }

  void starts() {
    const double distance_m = scenario_.law.safety_distance_m;
    std::vector<OrientedRectangle> bodies;
    for (const auto& agv : scenario_.agvs) bodies.push_back(start_body(scenario_, agv));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto& agv = scenario_.agvs[i];
      const auto pointer = [&] { return fmt::format("/agvs/{}/start", i); };
      for (std::size_t k = 0; k < i; ++k) {
        if (!closer_than(bodies[k], bodies[i], distance_m)) continue;
        add(ProblemKind::StartsTooClose, pointer(),
            fmt::format("{} starts closer than {} m to {}{}; choose another start", in_quotes(agv.name), distance_m,
                        in_quotes(scenario_.agvs[k].name), with_load(agv, scenario_.agvs[k])));
      }
      for (const auto& obstacle : scenario_.obstacles) {
        if (obstacle.appears > Duration::zero() ||
            !closer_than(placed(obstacle.footprint, obstacle.pose), bodies[i], distance_m))
          continue;
        add(ProblemKind::StartNearObstacle, pointer(),
            fmt::format("{} starts closer than {} m to obstacle {}{}; move one", in_quotes(agv.name), distance_m,
                        in_quotes(obstacle.name), with_load(agv, agv)));
      }
      if (scenario_.map->lanes_from(agv.start).empty()) {
        add(ProblemKind::StartWithoutLane, pointer(),
            fmt::format("no lane leaves the station where {} starts", in_quotes(agv.name)));
      }
    }
  }

  // Says in the error that the bodies were measured with their loads, if a load makes one of them larger.
  std::string_view with_load(const AgvSetup& one, const AgvSetup& other) const {
    const auto grows = [&](const AgvSetup& agv) {
      const LoadEffect& loaded = scenario_.type_of(agv).loaded;
      return loaded.extra_length_m > 0.0 || loaded.extra_width_m > 0.0;
    };
    return grows(one) || grows(other) ? " once loaded" : "";
  }

  void transports(std::size_t i) {
    const auto& agv = scenario_.agvs[i];
    for (std::size_t k = 0; k < agv.transports.size(); ++k) {
      const auto& order = agv.transports[k];
      const auto need = [&](StationId from, StationId to, std::string_view field) {
        if (reachability_.reaches(from, to)) return;
        const auto name = [&](StationId id) { return in_quotes(scenario_.map->station(id).name); };
        add(ProblemKind::Unreachable, fmt::format("/agvs/{}/transports/{}{}", i, k, field),
            fmt::format("no way leads from {} to {}", name(from), name(to)));
      };
      need(agv.start, order.from, "/from");
      need(order.from, order.to, "/to");
      need(order.to, order.from, "/from");
    }
  }

  const Scenario& scenario_;
  const Reachability& reachability_;
  Problems problems_;
};

}  // namespace

Problems unusable_problems(const Scenario& scenario) { return RangeCheck(scenario).run(); }

Problems world_problems(const Scenario& scenario, const Reachability& reachability) {
  return WorldCheck(scenario, reachability).run();
}

Problems problems_of(const Scenario& scenario) {
  auto problems = unusable_problems(scenario);
  if (problems.empty()) problems = world_problems(scenario, Reachability(*scenario.map));
  return problems;
}

bool closer_than(const OrientedRectangle& a, const OrientedRectangle& b, double distance_m) {
  // Far apart, as most pairs are: no exact distance needed.
  const double reach = a.half_length_m + a.half_width_m + b.half_length_m + b.half_width_m + distance_m;
  if ((a.centre_m - b.centre_m).squaredNorm() > reach * reach) return false;
  return clearance_m(a, b) < distance_m - kBuiltToTheLimit_m;
}

OrientedRectangle start_body(const Scenario& scenario, const AgvSetup& agv) {
  const Footprint largest = scenario.type_of(agv).footprint_with(true);
  return placed(largest, {scenario.map->station(agv.start).position_m, agv.heading});
}

}  // namespace fleetproof
