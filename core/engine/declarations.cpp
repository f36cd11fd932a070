#include "core/engine/declarations.hpp"

namespace fleetproof {

void Declarations::set_safe_mode(AgvId agv, bool on) {
  Slice& slice = slices_[agv.index()];
  if (on == slice.safe_since.has_value()) return;
  if (on) {
    slice.safe_since = run_.now;
  } else {
    slice.safe_mode_ns += static_cast<std::uint64_t>((run_.now - *slice.safe_since).count());
    slice.safe_since.reset();
  }
  run_.trace(agv, traced::SafeMode{on});
}

void Declarations::set_waiting_for(AgvId agv, AgvId other) { run_.trace(agv, traced::WaitingFor{other}); }

void Declarations::note(AgvId agv, TraceKind kind, std::string_view text) {
  const std::uint64_t hash = name_hash(text);
  if (kind == TraceKind::Log) return run_.trace(agv, traced::Log{hash}, text);
  probes_.declare(text, hash);
  run_.trace(agv, traced::Probe{hash}, text);
}

void Declarations::forget(AgvId agv) {
  set_safe_mode(agv, false);
  set_waiting_for(agv, {});
}

void Declarations::close_books() {
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    set_safe_mode(AgvId{i}, false);
    run_.counters.safe_mode_ns += slices_[i].safe_mode_ns;
  }
}

}  // namespace fleetproof
