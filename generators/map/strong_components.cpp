#include "generators/map/strong_components.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {
namespace {

constexpr std::uint32_t kUnseen = ~0U;

// Arrows by the node they leave, one after the other in one array: [first[n], first[n + 1]) leave n.
struct Successors {
  Successors(std::size_t nodes, std::span<const Arrow> arrows) : first(nodes + 2, 0), to(arrows.size()) {
    // Counts are stored two places further on. Filling then moves the beginnings to their final places.
    for (const auto& arrow : arrows) ++first[arrow.from + 2];
    for (std::size_t n = 2; n < first.size(); ++n) first[n] += first[n - 1];
    for (const auto& arrow : arrows) to[first[arrow.from + 1]++] = arrow.to;
  }

  std::vector<std::uint32_t> first, to;
};

// Tarjan 1972, with a stack of its own: imported maps have tens of thousands of stations in a row. Both stacks have
// room for every node.
class Tarjan {
 public:
  Tarjan(const Successors& successors, std::size_t nodes)
      : successors_(successors), nodes_(nodes, {kUnseen, 0}), path_(nodes), frames_(nodes) {
    found_.component.assign(nodes, kUnseen);
  }

  StrongComponents run() {
    for (std::uint32_t root = 0; root < nodes_.size(); ++root) {
      if (nodes_[root].number == kUnseen) search(root);
    }
    return std::move(found_);
  }

 private:
  struct Node {
    std::uint32_t number, low;
  };
  struct Frame {
    std::uint32_t node, next;
  };

  void enter(std::uint32_t node) {
    nodes_[node] = {visited_, visited_};
    ++visited_;
    path_[on_path_++] = node;
    frames_[open_++] = {node, successors_.first[node]};
  }

  void search(std::uint32_t root) {
    enter(root);
    while (open_ > 0) {
      auto& [node, next] = frames_[open_ - 1];
      if (next < successors_.first[node + 1]) {
        const auto to = successors_.to[next++];
        if (nodes_[to].number == kUnseen) {
          enter(to);
        } else if (found_.component[to] == kUnseen) {
          nodes_[node].low = std::min(nodes_[node].low, nodes_[to].number);
        }
        continue;
      }
      const auto [number, low] = nodes_[node];
      if (low == number) close(node);
      if (--open_ == 0) continue;
      auto& lower = nodes_[frames_[open_ - 1].node].low;
      lower = std::min(lower, low);
    }
  }

  void close(std::uint32_t node) {
    const std::size_t before = on_path_;
    std::uint32_t member = kUnseen, smallest = kUnseen;
    do {
      member = path_[--on_path_];
      smallest = std::min(smallest, member);
      found_.component[member] = count_;
    } while (member != node);
    const std::size_t size = before - on_path_;
    if (size > found_.largest_size || (size == found_.largest_size && smallest < smallest_of_largest_)) {
      found_.largest_size = size;
      found_.largest = count_;
      smallest_of_largest_ = smallest;
    }
    ++count_;
  }

  const Successors& successors_;
  StrongComponents found_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> path_;
  std::vector<Frame> frames_;
  std::size_t on_path_ = 0, open_ = 0;
  std::uint32_t visited_ = 0, count_ = 0, smallest_of_largest_ = kUnseen;
};

}  // namespace

StrongComponents strong_components(std::size_t nodes, std::span<const Arrow> arrows) {
  const Successors successors(nodes, arrows);
  return Tarjan(successors, nodes).run();
}

void reach_along(std::span<const Arrow> arrows, std::vector<bool>& reached) {
  const Successors successors(reached.size(), arrows);
  std::vector<std::uint32_t> open;
  for (std::uint32_t node = 0; node < reached.size(); ++node) {
    if (reached[node]) open.push_back(node);
  }
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    for (std::uint32_t i = successors.first[node]; i < successors.first[node + 1]; ++i) {
      const std::uint32_t next = successors.to[i];
      if (reached[next]) continue;
      reached[next] = true;
      open.push_back(next);
    }
  }
}

}  // namespace fleetproof
