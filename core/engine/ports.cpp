#include "core/engine/ports.hpp"

#include <utility>

#include "core/engine/actions.hpp"
#include "core/engine/activities.hpp"
#include "core/engine/agent_host.hpp"
#include "core/engine/battery.hpp"
#include "core/engine/halts.hpp"
#include "core/engine/messenger.hpp"
#include "core/engine/position_sensor.hpp"
#include "core/engine/timers.hpp"

namespace fleetproof {

void BatteryPort::settle(AgvId agv) const { part_->settle(agv); }
void BatteryPort::activity_changed(AgvId agv, bool drive_begins) const { part_->activity_changed(agv, drive_begins); }
double BatteryPort::level(AgvId agv) const { return part_->level(agv); }
bool BatteryPort::is_out(AgvId agv) const { return part_->is_out(agv); }
void BatteryPort::change(AgvId agv, double level) const { part_->change(agv, level); }

void PositionSensorPort::piece_ends(AgvId agv) const { part_->piece_ends(agv); }
Pose PositionSensorPort::perceived(AgvId agv) const { return part_->perceived(agv); }
void PositionSensorPort::forget(AgvId agv) const { part_->forget(agv); }

void MessengerPort::piece_begins(const Piece& piece) const { part_->piece_begins(piece); }
void MessengerPort::forget_path(AgvId agv) const { part_->forget_path(agv); }
std::optional<std::uint32_t> MessengerPort::accept(AgvId sender, std::string_view bytes, std::uint32_t receiver) const {
  return part_->accept(sender, bytes, receiver);
}
void MessengerPort::spare(std::uint32_t slot) const { part_->spare(slot); }
std::uint64_t MessengerPort::hash_of(std::uint32_t slot) const { return part_->hash_of(slot); }
void MessengerPort::transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver) const {
  part_->transmit(sender, slot, receiver);
}
void MessengerPort::withdraw(std::uint32_t slot) const { part_->withdraw(slot); }
bool MessengerPort::read(AgvId agv, fp_message& out) const { return part_->read(agv, out); }
std::span<const fp_message> MessengerPort::unread(AgvId agv) const { return part_->unread(agv); }
void MessengerPort::forget_inbox(AgvId agv) const { part_->forget_inbox(agv); }

void ActivitiesPort::begin(AgvId agv, const Activity& activity, std::uint64_t subject) const {
  part_->begin(agv, activity, subject);
}
void ActivitiesPort::begin_moving(AgvId agv, ActivityKind kind, const Piece& piece, std::uint64_t subject) const {
  part_->begin_moving(agv, kind, piece, subject);
}
void ActivitiesPort::continue_with(AgvId agv, const Piece& piece) const { part_->continue_with(agv, piece); }
void ActivitiesPort::end(AgvId agv, bool as_planned) const { part_->end(agv, as_planned); }
void ActivitiesPort::end_turn_at(AgvId agv, const Vec2& heading) const { part_->end_turn_at(agv, heading); }
void ActivitiesPort::end_rolling(AgvId agv) const { part_->end_rolling(agv); }
void ActivitiesPort::stand(AgvId agv, const Pose& pose) const { part_->stand(agv, pose); }

bool ActionsPort::accept(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) const {
  return part_->accept(agv, call, segment, load);
}
void ActionsPort::begin(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) const {
  part_->begin(agv, call, segment, load);
}
void ActionsPort::withdraw_accepted(AgvId agv) const { part_->withdraw_accepted(agv); }
fp_action ActionsPort::doing(AgvId agv) const { return part_->doing(agv); }
LanesAhead ActionsPort::lanes(AgvId agv) const { return part_->lanes(agv); }
void ActionsPort::brake(AgvId agv) const { part_->brake(agv); }
void ActionsPort::go_on(AgvId agv) const { part_->go_on(agv); }
void ActionsPort::reshape(AgvId agv) const { part_->reshape(agv); }
bool ActionsPort::stop_for_good(AgvId agv) const { return part_->stop_for_good(agv); }
void ActionsPort::put_back(AgvId agv, StationId station) const { part_->put_back(agv, station); }

std::uint64_t HaltsPort::begin(AgvId agv, Halt::Reason reason) const { return part_->begin(agv, reason); }
void HaltsPort::end(AgvId agv, std::uint64_t number) const { part_->end(agv, number); }
void HaltsPort::end_all(AgvId agv, Halt::Reason reason) const { part_->end_all(agv, reason); }
void HaltsPort::forget(AgvId agv) const { part_->forget(agv); }

std::int64_t TimersPort::now_ns(AgvId agv) const { return part_->now_ns(agv); }
void TimersPort::set(AgvId agv, std::uint32_t number, std::int64_t at_ns) const { part_->set(agv, number, at_ns); }
void TimersPort::forget(AgvId agv) const { part_->forget(agv); }

void AgentHostPort::tell(AgvId agv, const fp_event& event) const { part_->tell(agv, event); }
bool AgentHostPort::is_up(AgvId agv) const { return part_->is_up(agv); }
bool AgentHostPort::has_events_waiting(AgvId agv) const { return part_->has_events_waiting(agv); }
void AgentHostPort::freeze_until(AgvId agv, SimTime until) const { part_->freeze_until(agv, until); }
void AgentHostPort::goes_away(AgvId agv) const { part_->goes_away(agv); }
void AgentHostPort::comes_back(AgvId agv) const { part_->comes_back(agv); }
std::optional<Denial> AgentHostPort::why_not_told(AgvId agv, const std::string& word) const {
  return part_->why_not_told(agv, word);
}
void AgentHostPort::tell_fault(AgvId agv, const Fault& fault) const { part_->tell_fault(agv, fault); }

}  // namespace fleetproof
