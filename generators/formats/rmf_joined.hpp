#pragma once

#include <cstddef>
#include <map>
#include <vector>

namespace fleetproof {

// Vertices of an RMF level that lanes of no length join: they are one station.
class JoinedVertices {
 public:
  void join(std::size_t a, std::size_t b);
  // The smallest of those that are joined with the vertex; most stand alone.
  std::size_t first_of(std::size_t vertex) const;
  // In order; `first` alone if it stands alone. Requires: first_of(first) == first.
  std::vector<std::size_t> members_of(std::size_t first) const;

 private:
  std::map<std::size_t, std::vector<std::size_t>> members_;  // by first
  std::map<std::size_t, std::size_t> first_of_;
};

}  // namespace fleetproof
