#include "generators/worlds/drawn_faults.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/geometry/rotation.hpp"
#include "core/scenario/draw_numbers.hpp"

namespace fleetproof {
namespace {

constexpr double kHourIn_s = 3600.0;
constexpr double kWithinMission_s = 60.0;  // after the pick
constexpr double kFallsClear_m = 0.2;      // between the AGV and the load that fell off behind it
constexpr double kBesideTrack_m = 1.5;
constexpr Footprint kObstacle{.length_m = 0.8, .width_m = 0.6};
constexpr double kLowBattery = 0.12, kLowBatteryMost = 0.20;

class FaultDraws {
 public:
  FaultDraws(Scenario& scenario, const FaultRates& rates, std::uint64_t key)
      : scenario_(scenario), rates_(rates), key_(key) {
    clocks_agree_ = draws(FaultTopic::ClocksAgree, 0).uniform() < rates.clocks_agree_share;
  }

  void run() {
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) agv(AgvId{i});
    obstacles();
  }

  void computer(EntityId id, const std::vector<NamedFaultRate>& named) {
    const EntityId item = DrawNumbers(scenario_).of(id);
    for (const RecurringFault& fault : kRecurringFaults) recurring(id, item, fault);
    for (std::uint32_t i = 0; i < named.size(); ++i)
      named_fault(id, draws(FaultTopic{static_cast<std::uint32_t>(FaultTopic::Named) + i}, item.value), named[i]);
  }

 private:
  Draws draws(FaultTopic topic, std::uint32_t item) const {
    return Draws(key_, static_cast<std::uint32_t>(topic), item);
  }

  void agv(AgvId id) {
    for (const RecurringFault& fault : kRecurringFaults) recurring(id, id, fault);
    missions(id);
    sensing(id);
    Draws battery = draws(FaultTopic::Battery, id.value);
    if (battery.uniform() < rates_.low_battery_share)
      scenario_.agvs[id.index()].battery = battery.uniform(kLowBattery, kLowBatteryMost);
  }

  double lasts_s(const RecurringFault& recurring, Draws& d) const {
    const double lasts = rates_.*recurring.lasts_s;
    switch (recurring.lasting) {
      case RecurringFault::Lasting::Exponential:
        return d.exponential(lasts);
      case RecurringFault::Lasting::Uniform:
        return d.uniform(lasts, rates_.*recurring.most_s);
      case RecurringFault::Lasting::Exact:
        return lasts;
    }
    invariant_violated("a fault lasts for some time");
  }

  // The instants of a Poisson process, as far as the run goes.
  template <class Strikes>
  void process(double per_hour, Draws& d, Strikes strikes) const {
    if (per_hour <= 0.0) return;
    const double horizon_s = to_seconds(scenario_.horizon), mean_s = kHourIn_s / per_hour;
    for (double t_s = d.exponential(mean_s); t_s < horizon_s; t_s += d.exponential(mean_s)) strikes(seconds(t_s));
  }

  // `item`: under which it is drawn.
  void recurring(EntityId id, EntityId item, const RecurringFault& recurring) {
    Draws d = draws(recurring.topic, item.value);
    process(rates_.*recurring.per_agv_hour, d, [&](Duration at) {
      Fault fault;
      fault.kind = recurring.kind;
      fault.agv = id;
      fault.at = at;
      fault.lasts = seconds(lasts_s(recurring, d));
      scenario_.faults.push_back(fault);
    });
  }

  void named_fault(EntityId id, Draws d, const NamedFaultRate& rate) {
    process(rate.per_hour, d, [&](Duration at) {
      Fault fault;
      fault.kind = Fault::Kind::Named;
      fault.agv = id;
      fault.at = at;
      fault.word = rate.word;
      const double numbers = static_cast<double>(rate.number_most) - rate.number_least + 1.0;
      fault.number = rate.number_least + static_cast<std::uint32_t>(d.uniform() * numbers);
      fault.lasts = seconds(d.uniform(rate.least_s, rate.most_s));
      scenario_.faults.push_back(fault);
    });
  }

  void missions(AgvId id) {
    Draws breakdown = draws(FaultTopic::MissionBreakdown, id.value), drop = draws(FaultTopic::LoadDrop, id.value);
    const AgvSetup& agv = scenario_.agvs[id.index()];
    const double length_m = scenario_.type_of(agv).footprint_with(true).length_m;
    for (std::uint32_t transport = 0; transport < agv.transports.size(); ++transport) {
      Fault fault;
      fault.agv = id;
      fault.transport = transport;
      const bool breaks = breakdown.uniform() < rates_.breakdowns_per_transport;
      fault.at = seconds(breakdown.uniform(0.0, kWithinMission_s));
      fault.lasts = seconds(breakdown.exponential(rates_.repair_s));
      if (breaks) scenario_.faults.push_back(fault);
      const bool falls = drop.uniform() < rates_.load_drops_per_transport;
      fault.kind = Fault::Kind::LoadDrop;
      fault.at = seconds(drop.uniform(0.0, kWithinMission_s));
      fault.lasts = seconds(drop.exponential(rates_.load_lies_s));
      fault.ahead_m = -(0.5 * length_m + 0.5 * fault.load.length_m + kFallsClear_m);
      fault.left_m = drop.uniform(-0.8, 0.8);
      if (falls) scenario_.faults.push_back(fault);
    }
  }

  void sensing(AgvId id) {
    Draws clock = draws(FaultTopic::Clock, id.value);
    SensingSetup& sensing = scenario_.agvs[id.index()].sensing;
    sensing = {clock.uniform(0.0, rates_.clock_offset_s),
               clock.uniform(-rates_.clock_drift_ppm, rates_.clock_drift_ppm) + 0.0, rates_.position_error_m,
               rates_.position_late_s};
    if (clocks_agree_) sensing.clock_offset_s = sensing.clock_drift_ppm = 0.0;
  }

  void obstacles() {
    if (rates_.obstacles_per_hour <= 0.0) return;
    Draws d = draws(FaultTopic::Obstacle, 0);
    const double horizon_s = to_seconds(scenario_.horizon), mean_s = kHourIn_s / rates_.obstacles_per_hour;
    for (double t_s = d.exponential(mean_s); t_s < horizon_s; t_s += d.exponential(mean_s)) {
      const auto& lanes = scenario_.map->lanes();
      const Curve& curve = lanes[d.below(static_cast<std::uint32_t>(lanes.size()))].curve;
      const Pose on_track = curve.pose_at(d.uniform(0.0, curve.length_m()));
      ObstacleSetup obstacle;
      obstacle.name = fmt::format("foreign obstacle {}", scenario_.obstacles.size());
      obstacle.footprint = kObstacle;
      obstacle.pose = {on_track.position_m + d.uniform(-kBesideTrack_m, kBesideTrack_m) * left_of(on_track.heading),
                       on_track.heading + Vec2::Zero()};
      obstacle.appears = seconds(t_s);
      obstacle.leaves = obstacle.appears + seconds(d.exponential(rates_.obstacle_stays_s)) + Duration{1};
      scenario_.obstacles.push_back(obstacle);
    }
  }

  Scenario& scenario_;
  const FaultRates& rates_;
  std::uint64_t key_;
  bool clocks_agree_ = false;
};

}  // namespace

void draw_computer_faults(Scenario& scenario, EntityId computer, const ComputerFaultRates& rates, std::uint64_t key) {
  const FaultRates shared = rates.as_rates();
  FaultDraws(scenario, shared, key).computer(computer, rates.named);
}

void draw_faults(Scenario& scenario, const FaultRates& rates, std::uint64_t key) {
  if (rates != FaultRates{}) FaultDraws(scenario, rates, key).run();
}

}  // namespace fleetproof
