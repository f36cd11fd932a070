#include "campaign/run/world_cache.hpp"

#include <algorithm>

namespace fleetproof {

WorldCache::Loan WorldCache::borrow(std::uint64_t number, const std::function<Scenario()>& draw) {
  std::unique_ptr<DrawnWorld> world = find(number);
  if (!world) world = std::make_unique<DrawnWorld>(draw());
  const std::lock_guard lock(mutex_);
  most_lent_ = std::max(most_lent_, ++lent_);
  return {world.release(), PutBack{this, number}};
}

std::unique_ptr<DrawnWorld> WorldCache::find(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(worlds_, number, [](const auto& numbered) { return numbered.first; });
  if (found == worlds_.end()) return nullptr;
  std::unique_ptr<DrawnWorld> world = std::move(found->second);
  worlds_.erase(found);
  return world;
}

// As many worlds are kept as were lent at once: each thread goes on with its own.
void WorldCache::take_back(std::uint64_t number, std::unique_ptr<DrawnWorld> world) {
  const std::lock_guard lock(mutex_);
  --lent_;
  worlds_.emplace_front(number, std::move(world));
  while (worlds_.size() > most_lent_) worlds_.pop_back();
}

}  // namespace fleetproof
