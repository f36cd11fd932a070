#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/engine/agent_call.hpp"
#include "core/engine/call_tape.hpp"

namespace fleetproof {

// Makes the controller calls of a recorded run in place of its agents. The bytes may be damaged or belong to another
// run: then a function throws EngineError.
class TapePlayer {
 public:
  // Requires: `tape` outlives the player.
  explicit TapePlayer(std::string_view tape);

  // The next call of the tape. If it creates an agent, `agent` is not null afterwards: an address that nobody may use.
  std::optional<AgentFailure> play(const AgentCall& call, void*& agent);
  // Whether the next call tells the program of this participant that the run is over.
  bool ends_run_for(EntityId first) const;
  // At the end of the run: all calls of the tape have been played.
  void finish() const;
  std::uint64_t processor_changes() const { return processor_changes_; }

 private:
  void play_controller_call(TapeItem item, fp_controller* controller);
  void play_message(TapeItem item, fp_controller* controller);
  void play_keep(fp_controller* controller);
  void play_perception(TapeItem item, fp_controller* controller);
  void play_note(TapeItem item, fp_controller* controller);

  TapeItem item() { return static_cast<TapeItem>(byte()); }
  std::uint64_t number();
  std::uint32_t id();
  std::int64_t time_ns();
  std::string_view text();
  std::uint8_t byte();
  [[noreturn]] static void fail(std::string_view why);

  std::string_view rest_;
  std::uint64_t processor_changes_ = 0;
};

}  // namespace fleetproof
