#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// The traces that the runs of a campaign had so far, cell by cell. Sixteen to 32 bytes a run.
class SeenTraces {
 public:
  // Whether the trace of the run is new to its cell. Requires: the run is not folded, and runs come in their order.
  bool add(const RunRecord& run);

 private:
  bool insert(std::uint64_t key);
  void grow();

  std::vector<std::uint64_t> slots_;  // 0: empty
  std::size_t taken_ = 0;
  bool has_zero_ = false;
};

}  // namespace fleetproof
