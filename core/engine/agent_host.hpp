// The agents of a run: activations, crashes, hangs and restarts.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/engine/agent_caller.hpp"
#include "core/engine/briefings.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/engine/run_watch.hpp"

namespace fleetproof {

// Counts how often one agent is called.
class ActivationCount {
 public:
  static constexpr std::uint32_t kMostAtInstant = 10'000;  // without time advancing

  // Counts an activation. False: it is one too many. `most`: in the run.
  bool admit(SimTime now, std::uint64_t most) {
    if (now == last_) [[unlikely]] {
      if (++at_instant_ > kMostAtInstant) return false;
    } else {
      last_ = now;
      at_instant_ = 1;
    }
    return ++in_run_ <= most;
  }
  // After one too many: which limit it broke, in words.
  const char* broken_limit() const {
    return at_instant_ > kMostAtInstant ? "10 000 activations without time advancing"
                                        : "woke up more often than any control software needs";
  }

 private:
  SimTime last_ = SimTime::min();
  std::uint32_t at_instant_ = 0;
  std::uint64_t in_run_ = 0;
};

// The agents of all participants: when an agent is called, what it is told, and what happens when it crashes, hangs, or
// when that on which it runs is away for a time.
class AgentHost {
 public:
  struct Ports {
    ActionsPort actions;
    AgvController& controller;
    TimersPort timers;
  };
  AgentHost(RunContext& run, const Ports& ports, const FleetSoftware& software, const RunWatch& watch);
  ~AgentHost();
  AgentHost(const AgentHost&) = delete;
  AgentHost& operator=(const AgentHost&) = delete;

  // Wakes the agent with this event, at once if it is free, else as soon as it is. An agent that is not up never sees
  // the event. Size and time of the event are filled in here.
  void tell(AgvId agv, fp_event event);
  void start(AgvId agv);
  void order_released(TransportId transport);
  // Nothing happens if it has been delivered.
  void order_withdrawn(TransportId transport);
  // Why a named fault does not strike: the program does not know the word, or has not started yet. Requires: the agent
  // is up. If it fails at the question, that is filed, and it is away.
  std::optional<Denial> why_not_told(AgvId agv, const std::string& word);
  // Requires: the agent knows the word, and the fault outlives the run.
  void tell_fault(AgvId agv, const Fault& fault);
  // The event. The agent may have been frozen since.
  void becomes_free(AgvId agv);

  // It has neither failed nor is its computer down.
  bool is_up(AgvId agv) const { return agv_states_[agv.index()].away == 0; }
  bool has_events_waiting(AgvId agv) const { return !agv_states_[agv.index()].waiting_events.empty(); }
  void freeze_until(AgvId agv, SimTime until);
  // The computer goes down: what the agent knew, was told and was about to do is lost. Actions that have taken effect
  // are carried out. Two reasons may overlap: the computer is back when `comes_back` has been called for each.
  void goes_away(AgvId agv);
  void comes_back(AgvId agv);

  // Ends all agents. The trace does not learn of a failure in here. Throws EngineError if a tape does not end here.
  void close();
  // Adds crash, hang and the message of the first of them.
  void file_failures(Outcome& outcome) const;

 private:
  struct AgvState {
    const fp_agent_type* type = nullptr;
    void* agent = nullptr;
    fp_controller* controller = nullptr;
    bool failed = false;
    std::uint32_t away = 0;  // for so many reasons, one of which is that it has failed
    std::uint32_t boot = 0;
    SimTime free_at = kStart;           // it is busy or frozen until then
    SimTime frozen_until = kStart;      // whichever agent runs there
    SimTime wakes_at = SimTime::max();  // the next event that wakes it; or never
    ActivationCount activations;
    std::list<fp_event> waiting_events;  // arrived while the agent was busy; a list: none need no memory
  };
  void keep(AgvId agv, AgvState& agv_state, const fp_event& event);
  void wake(AgvId agv, AgvState& agv_state);
  void activate(AgvId agv, AgvState& agv_state, const fp_event& event);
  void settle(AgvId agv, AgvState& agv_state);
  const AgentFailure* start_agent(AgvId agv, const fp_event& event);
  void give_up(AgvId agv, bool hang, std::string_view message);
  bool file_failure(AgvId agv, bool hang, std::string_view message);
  void tell_order(AgvId agv, TransportId transport, StationId from, StationId to);
  void tell_open_orders(AgvId agv);
  void tell_again(AgvId agv, const Load& load);
  void renew_briefing(AgvId agv);
  void destroy(AgvId agv);
  void tell_end_of_run();

  RunContext& run_;
  Ports ports_;
  std::unique_ptr<ToldPlant> own_plant_;  // null: that of the watch
  Briefings briefings_;
  AgentCaller caller_;
  std::uint64_t activations_max_;  // of one agent in this run
  bool crash_ = false, hang_ = false, is_over_ = false;
  std::string message_;
  std::vector<AgvState> agv_states_;  // by participant
};

}  // namespace fleetproof
