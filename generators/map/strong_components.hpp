#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fleetproof {

// One way from a node to another one.
struct Arrow {
  std::uint32_t from, to;
};

// Nodes 0 .. n-1, parted into sets whose nodes can all reach each other along the arrows.
struct StrongComponents {
  std::vector<std::uint32_t> component;  // by node
  std::uint32_t largest = 0;             // the component with most nodes; the one of the smallest node among equals
  std::size_t largest_size = 0;

  bool in_largest(std::size_t node) const { return component[node] == largest; }
};

StrongComponents strong_components(std::size_t nodes, std::span<const Arrow> arrows);

}  // namespace fleetproof
