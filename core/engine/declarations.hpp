#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/call_limits.hpp"
#include "core/engine/notes.hpp"
#include "core/engine/run_context.hpp"
#include "core/outcome/probes.hpp"

namespace fleetproof {

// What agents declare. It moves nothing: it goes into the trace, and some of it is counted. Their notes are for people:
// they go to the sink of the trace, and the run is the same without them, unless its radio spares kinds of messages.
class Declarations {
 public:
  explicit Declarations(RunContext& run)
      : run_(run),
        agv_states_(run.scenario.participant_count()),
        has_spared_(run.scenario.radio.adverse.spared_kinds.size()) {}

  void set_safe_mode(AgvId agv, bool on);
  // Invalid: it waits for no AGV. `speaker`: its own agent, or the program of a computer.
  void set_waiting_for(AgvId agv, AgvId other, EntityId speaker);
  // Invalid: it works on no transport.
  void set_work(AgvId agv, TransportId transport, EntityId speaker);
  // `kind`: Probe or Log.
  void note(AgvId agv, TraceKind kind, std::string_view text);
  // The computer of the AGV, or this one, goes down: its safe mode and its state are over, and what it has declared
  // about AGVs.
  void forget(AgvId agv);

  // ---- notes, of one activation at a time. `leave_out` counts notes that are too many.
  // Counts a note. False: it is too many.
  bool admits_note(AgvId agv) { return ++agv_states_[agv.index()].notes <= kNotesMax; }
  void leave_out(AgvId agv, std::uint64_t notes);
  // Of the next message that is sent.
  void describe(AgvId agv, std::string_view kind) { agv_states_[agv.index()].described = kind; }
  // Whether it is of a kind that the radio spares.
  bool message_sent(AgvId agv, std::uint64_t hash);
  void set_state(AgvId agv, std::string_view state);
  void believe(AgvId agv, std::uint32_t about, const NotedPose& where, std::int64_t as_of_ns);
  void end_activation(AgvId agv);

  // At the end of the run.
  void settle_accounts();
  const ProbeTally& probes() const { return probes_; }

 private:
  struct AgvState {
    std::optional<SimTime> safe_since;
    std::uint64_t safe_mode_ns = 0;
    std::uint64_t notes = 0;  // in this activation
    std::string described;    // what the next message is; empty: not known
    std::string state;
    EntityId says_waiting, says_work;  // who has declared for whom the AGV waits, and on what it works
  };
  void take_back(AgvId agv, EntityId speaker);

  RunContext& run_;
  ProbeTally probes_;
  std::vector<AgvState> agv_states_;  // by participant
  std::vector<bool> has_spared_;      // by kind in the scenario's list: a message was described so
};

}  // namespace fleetproof
