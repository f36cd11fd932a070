#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace fleetproof {

// Makes the memory of this process unlike that of a worker of the campaign, so that software whose results depend on
// addresses, or on memory that it never wrote, comes out differently. Software that is deterministic does not notice.
// Threads: one, the one that calls the agents.
class Disturbance {
 public:
  // Which memory is filled: what `malloc` hands out next, which costs nothing later, or all that it ever hands out.
  enum class Fill : bool { Next, All };

  // Call this before a run. Another key gives another order of the addresses that `malloc` hands out next, other bytes
  // in this memory, and other bytes below the stack.
  void renew(std::uint64_t key, Fill fill = Fill::All);

 private:
  void scatter_heap(std::uint64_t key, int byte);

  std::vector<std::unique_ptr<char[]>> between_;  // what keeps freed blocks from growing together
};

}  // namespace fleetproof
