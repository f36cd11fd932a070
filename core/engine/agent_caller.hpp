#pragma once

#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/engine/agent_call.hpp"
#include "core/engine/foreign_calls.hpp"
#include "core/engine/run_watch.hpp"
#include "core/engine/tape_player.hpp"

namespace fleetproof {

// Makes the calls into the agents of one run. A call goes to the agent's type; or it is left out, because it is known
// to end the process; or it is played from a tape.
class AgentCaller {
 public:
  // Throws EngineError if the watch has a tape that no CallTape wrote.
  explicit AgentCaller(const RunWatch& watch);

  bool plays() const { return player_.has_value(); }
  // Each of these makes one call. Null: it has returned. Else how it failed, valid until the next call. They throw
  // EngineError if the tape holds another call. `start` puts the agent into `agent` as soon as it exists.
  const AgentFailure* start(const AgentCall& call, void*& agent);
  const AgentFailure* tell(const fp_agent_type& type, EntityId agv, SimTime at, const fp_event& event,
                           fp_controller* controller, void* agent) {
    if (is_watched_) [[unlikely]]
      return tell_watched({type, agv, at, &event, controller}, agent);
    const AgentFailure* failure = hear(type, event, agent);
    if (failure != nullptr) [[unlikely]]
      return own_failure({type, agv, at, &event, controller}, failure);
    return nullptr;
  }
  const AgentFailure* destroy(const AgentCall& call, void* agent);
  // `agent`: one of this type, which exists.
  const AgentFailure* ask(const AgentCall& question, void* agent);
  // The run is over for this program.
  const AgentFailure* end_run(const AgentCall& call);
  // Whether the next call of the tape is that. Requires: a tape is played.
  bool tape_ends_run_for(EntityId first) const { return player_->ends_run_for(first); }
  // At the end of the run. Throws EngineError if the tape holds more calls.
  void finish() const;
  // How many calls have left another state of the processor behind.
  std::uint64_t processor_changes() const;

 private:
  const AgentFailure* hear(const fp_agent_type& type, const fp_event& event, void* agent) {
    return guarded([&] { type.on_event(agent, &event); });
  }
  // Calls a function of the agent, which may throw.
  template <class Function>
  const AgentFailure* guarded(Function function) {
    try {
      function();
      return nullptr;
    } catch (const InvariantViolation&) {
      throw;  // ours, not the agent's
    } catch (const std::bad_alloc& error) {
      if (!foreign_agents_) throw;  // an agent of this program has no memory of its own
      return failed(false, error.what());
    } catch (const std::exception& error) {
      return failed(false, error.what());
    } catch (...) {
      return failed(false, "unknown exception");
    }
  }
  const AgentFailure* tell_watched(const AgentCall& call, void* agent);
  const AgentFailure* make_otherwise(const AgentCall& call, const KnownEnd* known, void*& agent);
  const AgentFailure* record(const AgentCall& call, const KnownEnd* known, void*& agent);
  const AgentFailure* make(const AgentCall& call, void*& agent) {
    return foreign_ ? make_foreign(call, agent) : reach(call, call.controller, agent);
  }
  // What the agent itself has filed during the call counts before how the call ended.
  const AgentFailure* own_failure(const AgentCall& call, const AgentFailure* otherwise);
  const AgentFailure* make_foreign(const AgentCall& call, void*& agent);
  const AgentFailure* reach(const AgentCall& call, fp_controller* handle, void*& agent);
  const AgentFailure* create_and_start(const AgentCall& call, fp_controller* handle, void*& agent);
  const AgentFailure* failed(bool hang, std::string_view message);

  CallCounter counter_;
  CallTape* tape_;
  const fp_host* host_;                          // what agents are given
  std::unique_ptr<ForeignHandles> own_handles_;  // of a recorded run of agents that are part of this program
  std::optional<ForeignCalls> foreign_;
  std::optional<TapePlayer> player_;
  bool foreign_agents_;   // some agents are no part of this program
  bool is_plain_;         // no tape, no foreign code
  bool is_watched_;       // not plain, or there is a note of the last call or a call that must not be made
  AgentFailure failure_;  // the last one
};

}  // namespace fleetproof
