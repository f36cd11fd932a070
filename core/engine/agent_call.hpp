#pragma once

#include <cstdint>
#include <string>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/engine/run_watch.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// One call into an agent. The create() and the on_event() of a start are one call.
struct AgentCall {
  const fp_agent_type& type;
  EntityId agv;  // or computer
  SimTime at;
  const fp_event* event = nullptr;        // null: the agent is destroyed, or its program is asked or told something
  fp_controller* controller = nullptr;    // of this participant; null without an event
  const fp_briefing* briefing = nullptr;  // the same, for a start

  // Whether agents of this type know a fault of this name.
  struct Question {
    const char* word = nullptr;  // null: nothing is asked
    bool* knows = nullptr;       // takes the answer
  } question{};
  bool is_run_end = false;  // the program is told that the run is over; the first of its participants stands for it

  bool is_question() const { return question.word != nullptr; }
  bool is_end() const { return event == nullptr && !is_question() && !is_run_end; }
  bool is_start() const { return event != nullptr && event->kind == FP_EVENT_START; }
  std::uint32_t kind() const {
    if (event != nullptr) return event->kind;
    return is_question() ? CallNote::kKnowsFault : is_run_end ? CallNote::kRunEnds : CallNote::kDestroy;
  }
};

// How a call ended that did not return.
struct AgentFailure {
  bool hang = false;
  std::string message;
};

}  // namespace fleetproof
