#include "reports/evidence/audit_share.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kLargestBlock = std::uint64_t{1} << 31;

std::uint64_t block_of(double share) {
  if (share <= 0.0) return 0;
  return static_cast<std::uint64_t>(std::clamp(std::round(1.0 / share), 1.0, static_cast<double>(kLargestBlock)));
}

}  // namespace

AuditShare::AuditShare(std::uint64_t seed, double share, const std::vector<CellRecord>& cells,
                       const std::vector<std::string>& plugin_agents)
    : seed_(name_hash("audit") ^ seed), block_(block_of(share)) {
  std::map<std::string, std::uint32_t> numbers;
  for (const CellRecord& cell : cells) {
    const auto [found, is_new] = numbers.try_emplace(cell.agent, static_cast<std::uint32_t>(agents_.size()));
    if (is_new) {
      const bool is_plugin = std::ranges::find(plugin_agents, cell.agent) != plugin_agents.end();
      agents_.push_back({0, is_plugin ? kAuditsToPass : 1});
    }
    places_.push_back({found->second, agents_[found->second].cells++});
  }
}

bool AuditShare::contains(std::uint32_t cell, std::uint64_t replicate) const {
  if (block_ == 0) return false;
  const Place& place = places_[cell];
  const Agent& agent = agents_[place.agent];
  const std::uint64_t number = replicate * agent.cells + place.among_its_cells;  // among the runs of its agent
  if (number < agent.first_runs) return true;
  Draws draws(seed_ + number / block_, place.agent);
  return number % block_ == draws.below(static_cast<std::uint32_t>(block_));
}

}  // namespace fleetproof
