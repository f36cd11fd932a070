#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fleetproof {

// A directed edge from one node to another.
struct Arrow {
  std::uint32_t from, to;
};

// The nodes 0 .. n-1, divided into sets whose nodes can all reach each other along the edges.
struct StrongComponents {
  std::vector<std::uint32_t> component;  // by node
  std::uint32_t largest = 0;  // the component with most nodes; of equal ones, the component of the smallest node
  std::size_t largest_size = 0;

  bool in_largest(std::size_t node) const { return component[node] == largest; }
};

StrongComponents strong_components(std::size_t nodes, std::span<const Arrow> arrows);

// Adds to `reached`, by node, every node to which arrows lead from the nodes in it.
void reach_along(std::span<const Arrow> arrows, std::vector<bool>& reached);

}  // namespace fleetproof
