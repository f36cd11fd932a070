#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/base/strong_id.hpp"
#include "core/engine/call_limits.hpp"

namespace fleetproof {

inline constexpr std::size_t kLongestTape = std::size_t{64} << 20U;  // bytes
inline constexpr std::size_t kTapePiece = std::size_t{64} << 10U;    // the least of a piece that is handed on

// The items of a tape. Their numbers stand in recordings: append, or raise kTapeVersion.
enum class TapeItem : std::uint8_t {
  // How a call into an agent ended. It is the last item of the call.
  Returned,
  Crashed,  // message
  Hung,     // message
  // What happened during the call.
  Created,    // create() has returned an agent
  Services,   // count: so many calls of random and now_ns
  NoEffect,   // a controller call that counts and does nothing else: its arguments were invalid
  OverLimit,  // count: so many controller calls beyond kCallsMax
  // Controller calls, with what was given to them.
  Move,
  Pick,
  Drop,
  Park,
  Charge,
  SendBroadcast,
  SendUnicast,
  GetPosition,
  GetBatteryLevel,
  GetMessage,
  IsLoaded,
  GetAction,
  SetTimer,
  DeclareCost,
  SafeMode,
  WaitingFor,
  Sometimes,
  Log,
  PickLoad,
  GetLoad,
  Stop,
  GoOn,
  // Notes.
  Describe,
  DeclareState,
  Believe,
  NotesLeftOut,  // count: so many notes beyond kNotesMax
  // What else happened during the call.
  ProcessorChanged,  // it left another state of the processor behind
  FaultIsKnown,      // the program knows the named fault that it was asked for
  // More controller calls.
  Keep,  // number and size of the record, and its hash in place of its bytes: nobody reads them in a played run
  WorksOn,
  DeclareWaiting,
  DescribeMessage,  // a note: all fields as one text
};

inline constexpr std::uint8_t kTapeVersion = 1;

// What the agents of one run did: for each call into an agent the controller calls that it made, and how the call
// ended. A TapePlayer repeats the run from these bytes without the agents' code.
//
// The first byte is kTapeVersion. Each call into an agent is the id of its AGV, the kind of its event, and its items. A
// number takes one byte for every seven bits, lowest first; the top bit says that more follow. An id is its number plus
// one, so that FP_NONE takes one byte. A time has its sign in the lowest bit. A text follows its length.
//
// Calls into agents do not nest: what an agent does reaches other agents through the event queue.
class CallTape {
 public:
  using HandOn = std::function<void(std::string piece)>;
  // If a tape becomes longer than `longest_bytes`, it is dropped. `hand_on`: takes the bytes in pieces while the run
  // lasts, so that the tape needs no memory; take() returns the last piece. Null: take() returns all.
  explicit CallTape(std::size_t longest_bytes = kLongestTape, HandOn hand_on = nullptr);

  // ---- by the engine
  // `event`: as CallNote has it.
  void call_begins(AgvId agv, std::uint32_t event);
  void agent_created() { put(TapeItem::Created); }
  void processor_changed() { put(TapeItem::ProcessorChanged); }
  void fault_is_known() { put(TapeItem::FaultIsKnown); }
  void call_returned() { call_ends(TapeItem::Returned); }
  void call_failed(bool hang, std::string_view message);

  // ---- by the controller, between begin and end of a call
  template <class... Arguments>
  void controller_call(TapeItem item, Arguments... arguments) {
    if (!admits()) return;
    put(item);
    (put(arguments), ...);
  }
  void service() { ++services_; }
  template <class... Arguments>
  void note(TapeItem item, Arguments... arguments) {
    if (++notes_ > kNotesMax) return;
    put(item);
    (put(arguments), ...);
  }

  // ---- for the caller of simulate()
  // False: the tape was dropped, because it became too long or there was not enough memory.
  bool is_complete() const { return complete_; }
  // The bytes. Empty if the tape is not complete: pieces that were handed on are worth nothing then. Call it once.
  std::string take();

 private:
  bool admits();
  void call_ends(TapeItem how);
  void put_services();
  void put_number(std::uint64_t number);
  void put(TapeItem item);
  void put(std::uint32_t id) { put_number(id + 1U); }
  void put(std::int64_t time_ns);
  void put(std::string_view text);
  void append(std::string_view bytes);

  std::size_t longest_bytes_, handed_on_ = 0;
  HandOn hand_on_;
  bool complete_ = true;
  std::uint64_t calls_ = 0, services_ = 0, notes_ = 0;  // of this call into an agent; services not yet on the tape
  std::string bytes_;
};

}  // namespace fleetproof
