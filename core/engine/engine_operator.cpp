// The operator: when he is called, when he comes, and what he does then.
#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/engine/engine.hpp"
#include "core/engine/recovery.hpp"

namespace fleetproof {
namespace {

constexpr Duration kTriesAgain = std::chrono::seconds(1);
constexpr std::uint32_t kAssistTopic = 100;  // of the faults stream, which the generator draws from under lower topics
constexpr std::uint32_t kStandstillTopic =
    101;  // likewise; a topic of its own, so that a call in vain moves no other draw
constexpr double kBuiltExactly_m =
    1e-6;  // stations whose bodies are exactly the safety distance apart are free of each other

// An activity that ends by itself before long. Charging does, but nobody waits for it.
bool is_work(ActivityKind kind) { return kind != ActivityKind::Park && kind != ActivityKind::Charge; }

}  // namespace

Duration Engine::until_help_comes(const Agv& agv, std::uint32_t topic, std::uint32_t number) const {
  const OperatorSetup& help = scenario_.operator_help;
  const auto key = stream_key(scenario_.seed_of(Stream::Faults), Stream::Faults);
  const auto draw = unit_interval(word64(philox(key, {number, 0, topic, agv.id.value}), 0));
  return seconds(help.least_s + (help.most_s - help.least_s) * draw);
}

// Of a jam or an empty battery, `halt` says which: help for one that has passed is no help for the next.
void Engine::call_operator(Agv& agv, Assist what, std::uint64_t halt) {
  if (!scenario_.operator_help.on) return;
  queue_.push(now_ + until_help_comes(agv, kAssistTopic, agv.assists++), agv.id, Event::Kind::OperatorComes,
              static_cast<std::uint64_t>(what), halt);
}

void Engine::operator_comes(Agv& agv, Assist what, std::uint64_t stamp) {
  if (what == Assist::Contact) return take_off_floor(agv);
  if (what == Assist::Standstill) return help_at_standstill(agv, stamp);
  if (agv.out_of_order || std::ranges::find(agv.halts, stamp, &Halt::number) == agv.halts.end()) return;
  if (agv.activity && agv.activity->kind == ActivityKind::Drive) {  // nobody walks up to an AGV that still moves
    return queue_.push(now_ + kTriesAgain, agv.id, Event::Kind::OperatorComes, static_cast<std::uint64_t>(what), stamp);
  }
  if (what == Assist::Jam) {
    assisted(agv, Assist::Jam);
    agv.scanner_muted = true;
  } else {
    change_battery(agv);
  }
  end_halt(agv, stamp);
}

void Engine::assisted(const Agv& agv, Assist what) {
  ++outcome_.counters.assists;
  trace(agv.id, TraceKind::OperatorAssists, static_cast<std::uint64_t>(what));
}

void Engine::change_battery(Agv& agv) {
  assisted(agv, Assist::Battery);
  settle_battery(agv);
  agv.book.charged += scenario_.operator_help.battery - agv.battery;
  agv.battery = scenario_.operator_help.battery;
  agv.battery_at = now_;
  agv.battery_out = false;
  predict_empty_battery(agv);
}

// ---- after a contact

// Everything that holds the AGV ends here, but it stays out of order until it is set down.
void Engine::take_off_floor(Agv& agv) {
  assisted(agv, Assist::Contact);
  for (std::size_t i = 0; i < scenario_.faults.size(); ++i) {
    if (scenario_.faults[i].agv == agv.id) fault_halt_ends(agv, i);
  }
  agv.halts.clear();
  agv.plan_waits = false;
  agv.scanner_muted = false;
  agent_goes_away(agv);
  world_.take_off_floor(agv.id, now_);
  trace(agv.id, TraceKind::Leaves);
  queue_.push(now_ + kTriesAgain, agv.id, Event::Kind::BodyAppears);
}

void Engine::look_for_place(Agv& agv) {
  const Footprint footprint = type_of(agv).footprint_with(is_loaded(agv));
  const double margin_m = std::max(0.0, scenario_.law.safety_distance_m - kBuiltExactly_m);
  const auto places = recovery_places(*scenario_.map, agv.station, agv.stopped_on, world_.pose_of(agv.id, now_));
  const auto place = std::ranges::find_if(places, [&](const RecoveryPlace& p) {
    const OrientedRectangle body = placed(footprint, p.pose);
    return world_.stays_free(body, margin_m, now_) && !is_on_the_way(body, margin_m);
  });
  if (place == places.end()) return queue_.push(now_ + kTriesAgain, agv.id, Event::Kind::BodyAppears);
  world_.forget_touches(agv.id);
  radio_.is_carried(agv.id);
  world_.put_on_floor(agv.id, footprint, place->pose, now_);
  trace(agv.id, TraceKind::Appears, place->station.value);
  agv.station = place->station;
  is_set_down(agv);
}

// Whether a lane passes there that an AGV has begun to drive or will drive next.
bool Engine::is_on_the_way(const OrientedRectangle& place, double margin_m) const {
  Box box;
  box.add(place);
  const auto passes = [&](const Agv& agv, const Lane* lane) {
    if (lane == nullptr) return false;
    Piece drive = rest_piece(agv.id, type_of(agv).footprint_with(is_loaded(agv)), lane->curve.pose_at(0.0), now_);
    drive.manner = Manner::Drive;
    drive.curve = &lane->curve;
    drive.profile = MotionProfile(lane->curve.length_m(), type_of(agv).drive);
    return drive.swept_box(drive.begin + drive.profile.duration()).grown(margin_m).overlaps(box);
  };
  return std::ranges::any_of(agvs_, [&](const Agv& agv) {
    if (agv.out_of_order) return false;
    return ((agv.acting || agv.committed) && passes(agv, agv.plan.lane)) || (agv.next && passes(agv, agv.next->lane));
  });
}

void Engine::is_set_down(Agv& agv) {
  agv.out_of_order = false;
  agv.doing = FP_IDLE;
  agv.past.clear();  // its position is of here from the first
  progressed(agv);
  predict_touches(agv.id);
  settle_battery(agv);
  if (agv.battery_out || agv.battery <= 0.0) {
    change_battery(agv);
  } else {
    predict_empty_battery(agv);
  }
  agent_comes_back(agv);
}

// ---- at a standstill

bool Engine::transports_are_open() const {
  const Counters& counters = outcome_.counters;
  return counters.transports_done + counters.loads_cleared < counters.transports_released;
}

bool Engine::has_open_transport(const Agv& agv) const {
  return std::ranges::any_of(world_.loads(),
                             [&](const Load& load) { return load.carrier == agv.id && !load.is_over(); });
}

// Nobody works, and nobody is held by something that ends without the agents, with or without the operator's help.
bool Engine::stands_still() const {
  return transports_are_open() && std::ranges::none_of(agvs_, [&](const Agv& agv) {
           const bool waits_for_help = !agv.halts.empty() || (agv.out_of_order && world_.body(agv.id).on_floor);
           return waits_for_help || (agv.activity && is_work(agv.activity->kind));
         });
}

// Every second, last of all at its instant.
void Engine::operator_looks() {
  queue_.push(now_ + kTriesAgain, EntityId{}, Event::Kind::OperatorLooks);
  if (!stands_still()) still_since_ = now_;
  if (standstill_called_ || now_ - std::max(still_since_, last_progress_) < scenario_.stuck_after) return;
  Agv* agv = longest_idle();
  if (agv == nullptr) return;
  standstill_called_ = true;
  const Duration until = until_help_comes(*agv, kStandstillTopic, standstills_++);
  queue_.push(now_ + until, agv->id, Event::Kind::OperatorComes, static_cast<std::uint64_t>(Assist::Standstill),
              standstill_stamp());
}

// Of those whose agent could be the cause: null if there is none.
Agv* Engine::longest_idle() {
  Agv* longest = nullptr;
  for (Agv& agv : agvs_) {
    if (agv.agent_failed || agv.agent_away > 0 || agv.activity || !has_open_transport(agv)) continue;
    if (longest == nullptr || agv.last_progress < longest->last_progress) longest = &agv;
  }
  return longest;
}

// The one standstill is told from the next by when it began.
std::uint64_t Engine::standstill_stamp() const {
  return static_cast<std::uint64_t>(to_ns(std::max(still_since_, last_progress_)));
}

void Engine::help_at_standstill(Agv& agv, std::uint64_t stamp) {
  standstill_called_ = false;
  if (stamp != standstill_stamp() || !stands_still() || agv.agent_failed || agv.agent_away > 0) return;
  assisted(agv, Assist::Standstill);
  agv.last_progress = still_since_ = now_;
  agent_goes_away(agv);
  agent_comes_back(agv);
}

}  // namespace fleetproof
