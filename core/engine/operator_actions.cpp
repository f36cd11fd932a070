#include "core/engine/operator_actions.hpp"

#include <algorithm>

#include "core/base/random.hpp"
#include "core/base/tolerances.hpp"
#include "core/engine/contacts.hpp"
#include "core/engine/fault_injector.hpp"
#include "core/engine/scanner.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "core/scenario/ways.hpp"

namespace fleetproof {
namespace {

Pose arrival(const Lane& lane) { return lane.curve.pose_at(lane.curve.length_m()); }

bool may_drive_off(const LaneRules& rules, const RecoveryPlace& place) {
  const auto& lanes = rules.map.lanes_from(place.station);
  return lanes.empty() || std::ranges::any_of(lanes, [&](std::uint32_t lane) {
           return rules.may_drive(rules.map.lanes()[lane], place.pose.heading);
         });
}

}  // namespace

std::optional<RecoveryPlace> recovery_place(const LaneRules& rules, StationId station, const Lane* stopped_on,
                                            const Pose& stood, const std::function<bool(const RecoveryPlace&)>& suits) {
  const StationId first = stopped_on != nullptr ? stopped_on->to : station;
  const Pose first_pose = stopped_on != nullptr ? arrival(*stopped_on) : stood;
  std::optional<RecoveryPlace> found;
  visit_shortest_ways(rules.map, first, nullptr, [&](const ShortestWay& way) {
    RecoveryPlace place{way.to, way.last == nullptr ? first_pose : arrival(*way.last)};
    place.pose.heading = rules.map.station(way.to).heading.value_or(place.pose.heading);
    if (may_drive_off(rules, place) && suits(place)) found = place;
    return !found;
  });
  return found;
}

namespace {

// Topics of the faults stream; the generator draws under lower ones. A standstill has a topic of its own, so that a
// call in vain moves no other draw.
constexpr std::uint32_t kAssistTopic = 100, kStandstillTopic = 101;

}  // namespace

OperatorActions::OperatorActions(RunContext& run, const Ports& ports)
    : run_(run), ports_(ports), calls_(run.agvs.size()) {}

Duration OperatorActions::until_help_comes(AgvId agv, std::uint32_t topic, std::uint32_t number) const {
  const OperatorSetup& help = run_.scenario.operator_help;
  const auto key = stream_key(run_.scenario.seed_of(Stream::Faults), Stream::Faults);
  const auto draw = unit_interval(word64(philox(key, {number, 0, topic, run_.draw_numbers.of(agv).value}), 0));
  return seconds(help.least_s + (help.most_s - help.least_s) * draw);
}

void OperatorActions::call(AgvId agv, Assist what, std::uint64_t halt) {
  if (!run_.scenario.operator_help.on) return;
  run_.queue.push(run_.now + until_help_comes(agv, kAssistTopic, calls_[agv.index()]++), agv,
                  Event::Kind::OperatorComes, static_cast<std::uint64_t>(what), halt);
}

void OperatorActions::comes(AgvId agv, Assist what, std::uint64_t stamp) {
  switch (what) {
    case Assist::Contact:
      return take_off_floor(agv);
    case Assist::Standstill:
      return help_at_standstill(agv, stamp);
    case Assist::Jam:
    case Assist::Battery:
      return help_with_halt(agv, what, stamp);
  }
}

void OperatorActions::help_with_halt(AgvId agv, Assist what, std::uint64_t halt) {
  const AgvStatus& status = run_.status(agv);
  if (status.out_of_order || std::ranges::find(status.halts, halt, &Halt::number) == status.halts.end()) return;
  if (status.is_driving()) {  // the operator does not walk up to an AGV that still moves
    return run_.queue.push(run_.now + kBodyTriesAgain, agv, Event::Kind::OperatorComes,
                           static_cast<std::uint64_t>(what), halt);
  }
  if (what == Assist::Jam) {
    assisted(agv, Assist::Jam);
    ports_.scanner.set_muted(agv, true);
  } else {
    change_battery(agv);
  }
  ports_.halts.end(agv, halt);
}

void OperatorActions::assisted(AgvId agv, Assist what) {
  ++run_.counters.assists;
  run_.trace(agv, traced::OperatorAssists{what});
}

void OperatorActions::change_battery(AgvId agv) {
  assisted(agv, Assist::Battery);
  ports_.battery.change(agv, run_.scenario.operator_help.battery);
}

// ---- after a contact

// Every halt of the AGV ends here, but the AGV stays out of order until it is set down.
void OperatorActions::take_off_floor(AgvId agv) {
  assisted(agv, Assist::Contact);
  ports_.faults.end_halts_of(agv);
  ports_.halts.forget(agv);
  ports_.scanner.set_muted(agv, false);
  ports_.agents.goes_away(agv);
  run_.world.take_off_floor(agv, run_.now);
  run_.trace(agv, traced::Leaves{});
  run_.queue.push(run_.now + kBodyTriesAgain, agv, Event::Kind::BodyAppears);
}

void OperatorActions::look_for_place(AgvId agv) {
  const AgvStatus& status = run_.status(agv);
  const Footprint footprint = run_.type_of(agv).footprint_with(run_.is_loaded(agv));
  const double margin_m = std::max(0.0, run_.scenario.law.safety_distance_m - kBuiltToTheLimit_m);
  const LaneRules rules{*run_.scenario.map, run_.type_of(agv).name, run_.is_loaded(agv)};
  const auto suits = [&](const RecoveryPlace& p) {
    const OrientedRectangle body = placed(footprint, p.pose);
    return run_.world.stays_free(body, margin_m, run_.now) && !is_on_the_way(body, margin_m);
  };
  const auto place = recovery_place(rules, status.station, status.stopped_on, run_.pose_now(agv), suits);
  if (!place) return run_.queue.push(run_.now + kBodyTriesAgain, agv, Event::Kind::BodyAppears);
  run_.world.forget_touches(agv);
  ports_.messenger.forget_path(agv);
  ports_.sensor.forget(agv);
  run_.world.put_on_floor(agv, footprint, place->pose, run_.now);
  set_down(agv, place->station);
}

// Whether a lane passes the place on which an AGV drives now or will drive next.
bool OperatorActions::is_on_the_way(const OrientedRectangle& place, double margin_m) const {
  Box box;
  box.add(place);
  for (std::size_t i = 0; i < run_.agvs.size(); ++i) {
    const AgvId agv{i};
    if (run_.status(agv).out_of_order) continue;
    const LanesAhead lanes = ports_.actions.lanes(agv);
    if (passes(agv, lanes.current, box, margin_m) || passes(agv, lanes.next, box, margin_m)) return true;
  }
  return false;
}

bool OperatorActions::passes(AgvId agv, const Lane* lane, const Box& place, double margin_m) const {
  if (lane == nullptr) return false;
  Piece drive = run_.standing_piece(agv, lane->curve.pose_at(0.0));
  drive.manner = Manner::Drive;
  drive.curve = &lane->curve;
  drive.profile = MotionProfile(lane->curve.length_m(), run_.type_of(agv).drive);
  return drive.swept_box(drive.begin + drive.profile.duration()).grown(margin_m).overlaps(place);
}

void OperatorActions::set_down(AgvId agv, StationId station) {
  run_.trace(agv, traced::Appears{station});
  ports_.actions.put_back(agv, station);
  ports_.contacts.predict(agv);
  ports_.battery.settle(agv);
  if (ports_.battery.is_out(agv)) {
    change_battery(agv);
  } else {
    ports_.battery.activity_changed(agv, false);
  }
  ports_.agents.comes_back(agv);
}

// ---- at a standstill

// Its own transport is open, or one that no AGV has.
bool OperatorActions::may_have_work(AgvId agv) const {
  return std::ranges::any_of(run_.world.loads(), [&](const Load& load) {
    return (load.carrier == agv || !load.carrier.valid()) && !load.is_over();
  });
}

// No AGV works, and no AGV is held by something that ends without its agent, with or without the operator.
bool OperatorActions::stands_still() const {
  if (!run_.transports_are_open()) return false;
  for (std::size_t i = 0; i < run_.agvs.size(); ++i) {
    const AgvStatus& status = run_.agvs[i];
    const bool waits_for_help = status.is_held() || (status.out_of_order && run_.world.body(AgvId{i}).on_floor);
    if (waits_for_help || (status.activity && is_work(status.activity->kind))) return false;
  }
  return true;
}

void OperatorActions::looks() {
  run_.queue.push(run_.now + kBodyTriesAgain, EntityId{}, Event::Kind::OperatorLooks);  // the last event of its instant
  if (!stands_still()) {
    still_since_ = run_.now;
    computers_restarted_ = false;
  }
  if (standstill_called_ || run_.now - std::max(still_since_, run_.last_progress) < run_.scenario.stuck_after) return;
  const EntityId first = to_restart();
  if (!first.valid()) return;
  standstill_called_ = true;
  const Duration until = until_help_comes(first, kStandstillTopic, standstills_++);
  run_.queue.push(run_.now + until, first, Event::Kind::OperatorComes, static_cast<std::uint64_t>(Assist::Standstill),
                  standstill_began_ns());
}

// The first computer that is up stands for all of them. Invalid if nothing can be restarted.
EntityId OperatorActions::to_restart() const {
  const Scenario& scenario = run_.scenario;
  for (EntityId computer = scenario.first_computer(); !computers_restarted_ && scenario.is_computer(computer);
       ++computer.value) {
    if (ports_.agents.is_up(computer)) return computer;
  }
  return longest_idle();
}

// The AGV that has been idle longest, of the AGVs whose agent could be the cause. Invalid if there is none.
AgvId OperatorActions::longest_idle() const {
  AgvId longest;
  for (std::size_t i = 0; i < run_.agvs.size(); ++i) {
    const AgvId agv{i};
    const AgvStatus& status = run_.status(agv);
    if (!ports_.agents.is_up(agv) || status.activity || !may_have_work(agv)) continue;
    if (!longest.valid() || status.last_progress < run_.status(longest).last_progress) longest = agv;
  }
  return longest;
}

// A standstill is identified by its start time.
std::uint64_t OperatorActions::standstill_began_ns() const {
  return static_cast<std::uint64_t>(to_ns(std::max(still_since_, run_.last_progress)));
}

void OperatorActions::help_at_standstill(EntityId first, std::uint64_t began_ns) {
  standstill_called_ = false;
  if (began_ns != standstill_began_ns() || !stands_still() || !ports_.agents.is_up(first)) return;
  still_since_ = run_.now;
  if (run_.scenario.is_agv(first)) {
    run_.status(first).last_progress = run_.now;
    return restart(first);
  }
  computers_restarted_ = true;
  for (EntityId computer = first; run_.scenario.is_computer(computer); ++computer.value) {
    if (ports_.agents.is_up(computer)) restart(computer);
  }
}

void OperatorActions::restart(EntityId participant) {
  assisted(participant, Assist::Standstill);
  ports_.agents.goes_away(participant);
  ports_.agents.comes_back(participant);
}

}  // namespace fleetproof
