#include "core/engine/declarations.hpp"

#include <algorithm>

namespace fleetproof {

void Declarations::set_safe_mode(AgvId agv, bool on) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (on == agv_state.safe_since.has_value()) return;
  if (on) {
    agv_state.safe_since = run_.now;
  } else {
    agv_state.safe_mode_ns += static_cast<std::uint64_t>((run_.now - *agv_state.safe_since).count());
    agv_state.safe_since.reset();
  }
  run_.trace(agv, traced::SafeMode{on});
}

void Declarations::set_waiting_for(AgvId agv, AgvId other, EntityId speaker) {
  agv_states_[agv.index()].says_waiting = speaker;
  run_.trace(agv, traced::WaitingFor{other});
}

void Declarations::set_work(AgvId agv, TransportId transport, EntityId speaker) {
  agv_states_[agv.index()].says_work = speaker;
  run_.trace(agv, traced::WorksOn{transport});
}

void Declarations::take_back(AgvId agv, EntityId speaker) {
  const AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.says_waiting == speaker) set_waiting_for(agv, {}, {});
  if (agv_state.says_work == speaker) set_work(agv, {}, {});
}

void Declarations::note(AgvId agv, TraceKind kind, std::string_view text) {
  const std::uint64_t hash = name_hash(text);
  if (kind == TraceKind::Log) return run_.trace(agv, traced::Log{hash}, text);
  probes_.declare(text, hash);
  run_.trace(agv, traced::Probe{hash}, text);
}

void Declarations::forget(AgvId agv) {
  if (run_.scenario.is_agv(agv)) {
    set_safe_mode(agv, false);
    // Its own agent counts as having said last for whom it waits, unless the program of a computer has.
    if (!agv_states_[agv.index()].says_waiting.valid()) agv_states_[agv.index()].says_waiting = agv;
    take_back(agv, agv);
  } else {
    for (std::size_t i = 0; i < run_.agvs.size(); ++i) take_back(AgvId{i}, agv);
  }
  set_state(agv, {});
}

// ---- notes

void Declarations::leave_out(AgvId agv, std::uint64_t notes) {
  std::uint64_t& sum = agv_states_[agv.index()].notes;
  sum += std::min(notes, ~sum);  // a damaged recording may hold any count
}

bool Declarations::message_sent(AgvId agv, std::uint64_t hash) {
  std::string& kind = agv_states_[agv.index()].described;
  if (kind.empty()) return false;
  run_.note(agv, traced::Described{hash}, kind);
  const auto& spared = run_.scenario.radio.adverse.spared_kinds;
  const auto found = std::ranges::find(spared, message_words(kind).kind);
  kind.clear();
  if (found == spared.end()) return false;
  has_spared_[static_cast<std::size_t>(found - spared.begin())] = true;
  return true;
}

void Declarations::set_state(AgvId agv, std::string_view state) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (state == agv_state.state) return;
  agv_state.state = state;
  run_.note(agv, traced::AgentState{}, state);
}

void Declarations::believe(AgvId agv, std::uint32_t about, const NotedPose& where, std::int64_t as_of_ns) {
  if (about >= run_.agvs.size()) return;
  run_.note(agv, traced::Belief{AgvId{about}, as_of_ns, where});
}

void Declarations::end_activation(AgvId agv) {
  AgvState& agv_state = agv_states_[agv.index()];
  if (agv_state.notes > kNotesMax) run_.note(agv, traced::NotesLeftOut{agv_state.notes - kNotesMax});
  agv_state.notes = 0;
  agv_state.described.clear();
}

void Declarations::settle_accounts() {
  for (std::size_t i = 0; i < agv_states_.size(); ++i) {
    set_safe_mode(AgvId{i}, false);
    run_.counters.safe_mode_ns += agv_states_[i].safe_mode_ns;
  }
  for (std::size_t i = 0; i < has_spared_.size(); ++i) {
    if (!has_spared_[i]) run_.deny(AgvId{0U}, Denial::NoSuchKind, i);
  }
}

}  // namespace fleetproof
