#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "core/engine/run_context.hpp"

namespace fleetproof {

// What an agent keeps under a number. A played run knows hash and size alone: nobody reads the bytes there.
struct DiskRecord {
  std::uint64_t hash = 0;
  std::uint32_t size = 0;
  std::string bytes{};
};
// Requires: the bytes fit on a disk.
DiskRecord disk_record(std::string_view bytes);
std::uint64_t disk_hash(std::string_view bytes);

// The disk of each participant: numbered records that outlive restarts and power failures. A disk on which nothing has
// been kept needs no memory.
class Disks {
 public:
  explicit Disks(RunContext& run) : run_(run) {}

  // Takes a record in hand; an empty one deletes what has its number. False: the disk would hold too much, or too much
  // would be in hand, and nothing changes. Requires, after true: `write` or `forget`.
  bool accept(EntityId participant, std::uint32_t number, DiskRecord record);
  // The record that was accepted first is on the disk from now on.
  void write(EntityId participant);
  // The newest record with this number that was accepted, valid until the next call for this participant; null: none.
  const DiskRecord* find(EntityId participant, std::uint32_t number) const;

  // The computer goes down: what is not on the disk by now never will be.
  void forget(EntityId participant);
  // All is gone.
  void lose(EntityId participant) { disks_.erase(participant); }

 private:
  struct Accepted {
    std::uint32_t number = 0;
    DiskRecord record;
  };
  struct Disk {
    std::map<std::uint32_t, DiskRecord> records;
    std::deque<Accepted> accepted;  // and not written yet
    std::uint64_t used = 0;         // bytes, once all of them are written
    std::uint64_t in_hand = 0;      // bytes of those accepted
    const DiskRecord* find(std::uint32_t number) const;
  };

  RunContext& run_;
  std::map<EntityId, Disk> disks_;
};

}  // namespace fleetproof
