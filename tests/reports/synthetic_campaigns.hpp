#pragma once

#include <cstdint>
#include <functional>

#include "core/base/random.hpp"
#include "reports/evidence/binomial.hpp"

// Ten thousand campaigns whose truth is known, for tests that count how often a method calls software good that is not.
namespace fleetproof::synthetic {

inline constexpr double kLimit = 0.1, kConfidence = 0.95;
inline constexpr std::uint64_t kCampaigns = 10'000;

inline double uniform(Draws& draws) { return static_cast<double>(draws.next() >> 11) * 0x1p-53; }

inline double share_of(const std::function<bool(std::uint64_t campaign)>& passes) {
  std::uint64_t passed = 0;
  for (std::uint64_t campaign = 0; campaign < kCampaigns; ++campaign) passed += passes(campaign) ? 1 : 0;
  return static_cast<double>(passed) / static_cast<double>(kCampaigns);
}

// What 10 000 campaigns of a rule that passes with this probability exceed in one of a million tries.
inline double most_by_chance(double probability = 1.0 - kConfidence) {
  auto passed = static_cast<std::uint64_t>(probability * static_cast<double>(kCampaigns));
  while (passed < kCampaigns && probability_of_at_most(passed, kCampaigns, probability) < 1.0 - 1e-6) ++passed;
  return static_cast<double>(passed) / static_cast<double>(kCampaigns);
}
// What they fall short of in one of a million tries.
inline double least_by_chance(double probability) { return 1.0 - most_by_chance(1.0 - probability); }

}  // namespace fleetproof::synthetic
