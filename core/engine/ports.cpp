#include "core/engine/ports.hpp"

#include <utility>

#include "core/engine/actions.hpp"
#include "core/engine/activities.hpp"
#include "core/engine/agent_host.hpp"
#include "core/engine/agv_controller.hpp"
#include "core/engine/battery.hpp"
#include "core/engine/contacts.hpp"
#include "core/engine/declarations.hpp"
#include "core/engine/drives.hpp"
#include "core/engine/fault_desk.hpp"
#include "core/engine/halts.hpp"
#include "core/engine/messenger.hpp"
#include "core/engine/operator_desk.hpp"
#include "core/engine/position_sensor.hpp"
#include "core/engine/scanner.hpp"
#include "core/engine/timers.hpp"

namespace fleetproof {

void ContactsPort::predict(EntityId body) const { part_->predict(body); }
bool ContactsPort::foresees(EntityId one, EntityId other) const { return part_->foresees(one, other); }

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

void DrivesPort::begin(AgvId agv, const Lane& lane, double from_m, double entry_mps, const Lane* next) const {
  part_->begin(agv, lane, from_m, entry_mps, next);
}
void DrivesPort::replan(AgvId agv) const { part_->replan(agv); }
void DrivesPort::release_next(AgvId agv, const Lane& next) const { part_->release_next(agv, next); }
LegEnd DrivesPort::leg_ends(AgvId agv) const { return part_->leg_ends(agv); }
std::uint32_t DrivesPort::begun(AgvId agv) const { return part_->begun(agv); }

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

void FaultDeskPort::load_taken_up(AgvId agv, TransportId transport) const { part_->load_taken_up(agv, transport); }
void FaultDeskPort::end_halts_of(AgvId agv) const { part_->end_halts_of(agv); }

void OperatorDeskPort::call(AgvId agv, Assist what, std::uint64_t halt) const { part_->call(agv, what, halt); }

void ScannerPort::drive_begins(AgvId agv) const { part_->drive_begins(agv); }
void ScannerPort::set_muted(AgvId agv, bool muted) const { part_->set_muted(agv, muted); }

std::int64_t TimersPort::now_ns(AgvId agv) const { return part_->now_ns(agv); }
void TimersPort::set(AgvId agv, std::uint32_t number, std::int64_t at_ns) const { part_->set(agv, number, at_ns); }
void TimersPort::forget(AgvId agv) const { part_->forget(agv); }

void DeclarationsPort::set_safe_mode(AgvId agv, bool on) const { part_->set_safe_mode(agv, on); }
void DeclarationsPort::set_waiting_for(AgvId agv, AgvId other) const { part_->set_waiting_for(agv, other); }
void DeclarationsPort::note(AgvId agv, TraceKind kind, std::string_view text) const { part_->note(agv, kind, text); }
bool DeclarationsPort::admits_note(AgvId agv) const { return part_->admits_note(agv); }
void DeclarationsPort::leave_out(AgvId agv, std::uint64_t notes) const { part_->leave_out(agv, notes); }
void DeclarationsPort::describe(AgvId agv, std::string_view kind) const { part_->describe(agv, kind); }
bool DeclarationsPort::message_sent(AgvId agv, std::uint64_t hash) const { return part_->message_sent(agv, hash); }
void DeclarationsPort::set_state(AgvId agv, std::string_view state) const { part_->set_state(agv, state); }
void DeclarationsPort::believe(AgvId agv, std::uint32_t about, const NotedPose& where, std::int64_t as_of_ns) const {
  part_->believe(agv, about, where, as_of_ns);
}
void DeclarationsPort::end_activation(AgvId agv) const { part_->end_activation(agv); }
void DeclarationsPort::forget(AgvId agv) const { part_->forget(agv); }

fp_controller* AgvControllerPort::handle_of(AgvId agv) const { return part_->handle_of(agv); }
void AgvControllerPort::begin_activation(fp_controller& handle) const { part_->begin_activation(handle); }
bool AgvControllerPort::end_activation(fp_controller& handle) const { return part_->end_activation(handle); }
void AgvControllerPort::forget(AgvId agv) const { part_->forget(agv); }

void AgentHostPort::tell(AgvId agv, const fp_event& event) const { part_->tell(agv, event); }
bool AgentHostPort::is_up(AgvId agv) const { return part_->is_up(agv); }
bool AgentHostPort::has_events_waiting(AgvId agv) const { return part_->has_events_waiting(agv); }
void AgentHostPort::freeze_until(AgvId agv, SimTime until) const { part_->freeze_until(agv, until); }
void AgentHostPort::goes_away(AgvId agv) const { part_->goes_away(agv); }
void AgentHostPort::comes_back(AgvId agv) const { part_->comes_back(agv); }

}  // namespace fleetproof
