#pragma once

#include <cstdint>

#include "core/agents/controller.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"

namespace fleetproof::agents {

// Why a request cannot be locked before another AGV moves on. It is blocked if an AGV waits inside its hull. It is held
// up if an AGV holds floor there at all; but only while the own AGV has not asked for long: otherwise a long request
// might never come first where AGVs keep passing. Both are worked out when they are asked for, and then again only as
// far as an AGV has changed. Requires: the neighbours outlive the object.
class Blocker {
 public:
  explicit Blocker(Neighbours& neighbours) : neighbours_(neighbours) {}

  // The AGV asks for floor since this instant, or asks for other floor instead.
  void ask(std::int64_t now_ns) {
    if (asking_since_ns_ < 0) asking_since_ns_ = now_ns, is_patient_ = true;
    forget();
    grow_old(now_ns);
  }
  // It has locked what it asked for, or asks no more.
  void end() {
    asking_since_ns_ = -1;
    forget();
  }
  // Call this from time to time while the AGV asks. True if the request is held up no more.
  bool grow_old(std::int64_t now_ns) {
    const bool was_patient = is_patient_;
    is_patient_ = is_patient_ && now_ns - asking_since_ns_ < kPatience_ns;
    return was_patient && !is_patient_;
  }

  // Another AGV has begun to hold floor or to wait, does so elsewhere, or no more. True if an answer that was given may
  // now be another.
  bool look_at(std::uint32_t agv, const Path& path) {
    const bool waits = look_at(waits_, agv, path), holds = is_patient_ && look_at(holds_, agv, path);
    return waits || holds;
  }
  // Requires of both: the same path as at all calls since `ask`.
  bool is_blocked(const Path& path) { return is_inside(waits_, path); }
  bool is_held_up(const Path& path) { return is_patient_ && is_inside(holds_, path); }

  static constexpr std::int64_t kPatience_ns = 20 * kSecond_ns;

 private:
  // Which AGV is inside the hull, if one is.
  struct Found {
    Inside what;
    bool is_known = false;
    std::uint32_t agv = FP_NONE;
  };

  void forget() { waits_.is_known = holds_.is_known = false; }
  bool look_at(Found& found, std::uint32_t agv, const Path& path) {
    if (!found.is_known) return false;
    if (found.agv == agv) {
      found.is_known = false;
      return true;
    }
    if (found.agv != FP_NONE || !neighbours_.is_inside(agv, path, found.what)) return false;
    found.agv = agv;
    return true;
  }
  bool is_inside(Found& found, const Path& path) {
    if (!found.is_known) found.agv = neighbours_.first_inside(path, found.what);
    found.is_known = true;
    return found.agv != FP_NONE;
  }

  Neighbours& neighbours_;
  std::int64_t asking_since_ns_ = -1;
  bool is_patient_ = true;
  Found waits_{Inside::Waiting}, holds_{Inside::Holding};
};

}  // namespace fleetproof::agents
