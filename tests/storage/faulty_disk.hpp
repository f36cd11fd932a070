#pragma once

#include <array>
#include <cstdint>

namespace fleetproof::test {

// What may fail at a disk.
enum class DiskCall : std::uint8_t { Open, Write, Sync, Truncate };
inline constexpr std::array kDiskCalls{DiskCall::Open, DiskCall::Write, DiskCall::Sync, DiskCall::Truncate};

const char* name_of(DiskCall call);

// While it lives, all files that SQLite opens in this process lie on a disk whose n-th call of one kind fails: that one
// call alone, or every call from it on. The program under test is the same as ever: the disk takes the place of
// SQLite's default. Threads: one; one FaultyDisk at a time.
class FaultyDisk {
 public:
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};
  FaultyDisk(DiskCall kind, std::uint64_t first_to_fail, bool goes_on);
  ~FaultyDisk();
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;

  std::uint64_t failed() const;  // calls that failed so far
};

}  // namespace fleetproof::test
