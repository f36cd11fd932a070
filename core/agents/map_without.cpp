#include "core/agents/map_without.hpp"

namespace fleetproof::agents {

void MapWithout::take_away(std::uint32_t station) {
  without_ = station;
  for (const std::uint32_t lane : blocked_list_) blocked_[lane] = false;
  blocked_list_.clear();
}

void MapWithout::block(std::uint32_t lane) {
  blocked_[lane] = true;
  blocked_list_.push_back(lane);
}

bool MapWithout::reaches(std::uint32_t from, std::uint32_t to) {
  begin_look(from);
  for (std::size_t next = 0; next < found_.size() && !was_found(to); ++next) look_on(found_[next], false);
  return was_found(to);
}

bool MapWithout::explore(std::uint32_t from, bool backwards, std::size_t most) {
  begin_look(from);
  for (std::size_t next = 0; next < found_.size(); ++next) {
    if (found_.size() > most) return false;
    look_on(found_[next], backwards);
  }
  return true;
}

void MapWithout::begin_look(std::uint32_t from) {
  seen_[from] = ++look_;
  found_.assign(1, from);
}

void MapWithout::look_on(std::uint32_t at, bool backwards) {
  for (const std::uint32_t lane : backwards ? map_.lanes_to(at) : map_.lanes_from(at)) {
    const std::uint32_t next = backwards ? map_.lane(lane).from : map_.lane(lane).to;
    if (next == without_ || blocked_[lane] || was_found(next)) continue;
    seen_[next] = look_;
    found_.push_back(next);
  }
}

}  // namespace fleetproof::agents
