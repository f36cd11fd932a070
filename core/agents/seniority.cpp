#include "core/agents/seniority.hpp"

#include <utility>

namespace fleetproof::agents {

void Seniority::raise(std::int64_t now_ns) {
  if (before_ns_ >= 0 && now_ns >= old_again_at_ns_) since_ns_ = std::exchange(before_ns_, kNone);
  if (since_ns_ < 0) since_ns_ = now_ns;
}

void Seniority::stand_back(std::int64_t now_ns) {
  if (before_ns_ < 0) before_ns_ = since_ns_;
  since_ns_ = kNone;
  old_again_at_ns_ = now_ns + kYoung_ns;
}

}  // namespace fleetproof::agents
