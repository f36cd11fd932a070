#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "core/engine/told_plant.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A drawn world, before a cell sets radio and agents; and what agents have derived from its plant.
struct DrawnWorld {
  explicit DrawnWorld(Scenario drawn) : scenario(std::move(drawn)), plant(scenario) {}

  Scenario scenario;
  ToldPlant plant;
};

// Worlds that several runs use, one run at a time. Threads: any number.
class WorldCache {
 public:
  struct PutBack {
    WorldCache* cache = nullptr;
    std::uint64_t number = 0;
    void operator()(DrawnWorld* world) const { cache->take_back(number, std::unique_ptr<DrawnWorld>(world)); }
  };
  using Loan = std::unique_ptr<DrawnWorld, PutBack>;

  // The world with this number; `draw` makes it if it is not there. Throws what `draw` throws.
  Loan borrow(std::uint64_t number, const std::function<Scenario()>& draw);

 private:
  std::unique_ptr<DrawnWorld> find(std::uint64_t number);
  void take_back(std::uint64_t number, std::unique_ptr<DrawnWorld> world);

  std::mutex mutex_;
  std::size_t lent_ = 0, most_lent_ = 0;
  std::deque<std::pair<std::uint64_t, std::unique_ptr<DrawnWorld>>> worlds_;  // that came back last: in front
};

}  // namespace fleetproof
