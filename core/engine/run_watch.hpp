#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

class CallTape;
class ForeignHandles;
class ToldPlant;

// The last call into an agent: create, on_event, destroy, knows_fault or run_ends. It may lie in memory that another
// process reads, so that it outlives a run whose agent ends the process. Threads: one writes, any number read.
struct CallNote {
  static constexpr std::uint32_t kDestroy = 0xffffffff;     // `event` of a call of destroy
  static constexpr std::uint32_t kKnowsFault = 0xfffffffe;  // `event` of a call of knows_fault
  static constexpr std::uint32_t kRunEnds = 0xfffffffd;     // `event` of a call of run_ends

  std::atomic<std::uint64_t> number{0};  // of the calls of this run, from 1; 0: no call yet
  std::atomic<std::int64_t> at_ns{0};    // simulated time
  std::atomic<std::uint32_t> agv{0};     // or computer: its id
  std::atomic<std::uint32_t> event{0};   // FP_EVENT_..., or one of these three
  std::atomic<std::uint32_t> fleet{0};   // so many AGVs; the ids of computers follow
};

// A call into an agent that is known to end the process or never to return. The engine does not make the call. It files
// the AGV's agent as crashed or hung, and the run goes on.
struct KnownEnd {
  std::uint64_t call = 0;  // as counted by CallNote::number
  bool hang = false;
  std::string message;
  friend bool operator==(const KnownEnd&, const KnownEnd&) = default;
};

// What the caller of simulate() sees and steers while the run is under way.
struct RunWatch {
  CallNote* note = nullptr;  // null: no process reads it
  // Called when a call into an agent is over, with the note as it was in that call; after the last one its caller knows
  // that. Empty: nobody wants to know. Only with a note.
  std::function<void()> call_ended{};
  std::span<const KnownEnd> known_ends;        // in order of their calls
  const std::atomic<bool>* abandon = nullptr;  // true: simulate() throws RunAbandoned at the next event
  CallTape* record = nullptr;                  // takes what the agents do; not if a tape is played
  // Not empty: the bytes of a CallTape. The engine calls no function of the agent type. It makes the controller calls
  // of the tape, and needs no known ends. If the bytes are damaged or belong to another run, simulate() throws
  // EngineError.
  std::string_view play{};
  // Of the plug-in to which the agent type belongs; they outlive all its threads. Null: its code is part of this
  // program.
  ForeignHandles* foreign = nullptr;
  // From which the agents learn what follows from map and fleet, and in which it is kept for later runs. Null, or if it
  // is another plant: the run makes its own.
  ToldPlant* plant = nullptr;
  bool share_facts = true;  // false: each agent works out for itself what follows from map and fleet
};

// The caller wanted no outcome any more.
class RunAbandoned : public std::runtime_error {
 public:
  RunAbandoned() : std::runtime_error("the run was abandoned") {}
};

// Counts the calls into the agents of one run.
class CallCounter {
 public:
  explicit CallCounter(const RunWatch& watch) : watch_(watch) {}

  // Call this before each call into an agent. Not null: the call must not be made.
  const KnownEnd* next(EntityId agv, std::uint32_t event, SimTime at) {
    ++number_;
    if (watch_.note != nullptr) {
      if (watch_.call_ended && number_ > 1) watch_.call_ended();
      write_note(agv, event, at);
    }
    if (ended_ == watch_.known_ends.size() || watch_.known_ends[ended_].call != number_) [[likely]]
      return nullptr;
    return &watch_.known_ends[ended_++];
  }

 private:
  void write_note(EntityId agv, std::uint32_t event, SimTime at) {
    CallNote& note = *watch_.note;
    note.at_ns.store(to_ns(at), std::memory_order_relaxed);
    note.agv.store(agv.value, std::memory_order_relaxed);
    note.event.store(event, std::memory_order_relaxed);
    note.number.store(number_, std::memory_order_release);
  }

  RunWatch watch_;
  std::uint64_t number_ = 0;
  std::size_t ended_ = 0;  // known ends that have been met
};

}  // namespace fleetproof
