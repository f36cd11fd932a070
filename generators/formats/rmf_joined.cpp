#include "generators/formats/rmf_joined.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {

void JoinedVertices::join(std::size_t a, std::size_t b) {
  auto [first, other] = std::minmax({first_of(a), first_of(b)});
  if (first == other) return;
  auto& all = members_.try_emplace(first, std::vector{first}).first->second;
  for (const std::size_t member : members_of(other)) {
    all.push_back(member);
    first_of_[member] = first;
  }
  std::ranges::sort(all);
  members_.erase(other);
}

std::size_t JoinedVertices::first_of(std::size_t vertex) const {
  const auto found = first_of_.find(vertex);
  return found == first_of_.end() ? vertex : found->second;
}

std::vector<std::size_t> JoinedVertices::members_of(std::size_t first) const {
  const auto found = members_.find(first);
  return found == members_.end() ? std::vector{first} : found->second;
}

}  // namespace fleetproof
