#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// $TMPDIR, or else /tmp. Throws InputError if it is no folder.
std::string temporary_folder();

// The encoded runs of one chunk until it is published: they finish in any order, and are read in theirs. The bytes lie
// in a file of the local folder for temporary files ($TMPDIR), which nobody else sees and which ends with the process.
// Throws MachineError if the disk fails. Threads: one.
class RunSpool {
 public:
  explicit RunSpool(std::uint64_t run_count);
  ~RunSpool();
  RunSpool(const RunSpool&) = delete;
  RunSpool& operator=(const RunSpool&) = delete;

  // Once for each place of the chunk.
  void add(std::uint64_t place, std::string_view encoded);
  bool is_complete() const { return missing_ == 0; }
  std::uint64_t bytes() const { return used_; }
  // Requires: the place was added.
  std::string at(std::uint64_t place) const;

 private:
  struct Extent {
    std::uint64_t offset = 0, length = 0;
  };
  std::vector<Extent> extents_;
  std::uint64_t used_ = 0, missing_;
  int file_;
};

}  // namespace fleetproof
