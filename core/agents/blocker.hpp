#pragma once

#include <cstdint>

#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"

namespace fleetproof::agents {

// Whether another AGV waits inside the hull of a path. It is worked out when it is asked for, and then again only as
// far as an AGV has changed. Requires: the neighbours outlive the object.
class Blocker {
 public:
  explicit Blocker(Neighbours& neighbours) : neighbours_(neighbours) {}

  // The path is another one.
  void forget() { is_known_ = false; }
  // The AGV has begun to wait, waits elsewhere, or waits no more. True if an answer that was given may now be another.
  bool look_at(std::uint32_t agv, const Path& path) {
    if (!is_known_) return false;
    if (agv_ == agv) {
      forget();
      return true;
    }
    if (agv_ != FP_NONE || !neighbours_.waits_inside(agv, path)) return false;
    agv_ = agv;
    return true;
  }
  // Requires: the same path as at all calls since `forget`.
  bool is_inside(const Path& path) {
    if (!is_known_) agv_ = neighbours_.waiting_inside(path);
    is_known_ = true;
    return agv_ != FP_NONE;
  }

 private:
  Neighbours& neighbours_;
  std::uint32_t agv_ = FP_NONE;
  bool is_known_ = false;
};

}  // namespace fleetproof::agents
