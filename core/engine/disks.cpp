#include "core/engine/disks.hpp"

#include <xxhash.h>

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {
namespace {

// So much may be accepted and not yet written: an agent that replaces a record again and again needs no more memory.
constexpr std::uint64_t kMostInHand = 4 * std::uint64_t{FP_DISK_BYTES};

// What a record takes of a disk; one that is not there, or that deletes another one, takes nothing.
std::uint64_t room_of(const DiskRecord* record) {
  return record == nullptr || record->size == 0 ? 0 : std::uint64_t{record->size} + FP_RECORD_OVERHEAD;
}

}  // namespace

std::uint64_t disk_hash(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

DiskRecord disk_record(std::string_view bytes) {
  ensure(bytes.size() <= FP_DISK_BYTES, "a record that is kept fits on a disk");
  return {disk_hash(bytes), static_cast<std::uint32_t>(bytes.size()), std::string(bytes)};
}

const DiskRecord* Disks::Disk::find(std::uint32_t number) const {
  const auto newest =
      std::find_if(accepted.rbegin(), accepted.rend(), [&](const Accepted& one) { return one.number == number; });
  if (newest != accepted.rend()) return newest->record.size == 0 ? nullptr : &newest->record;
  const auto written = records.find(number);
  return written == records.end() ? nullptr : &written->second;
}

bool Disks::accept(EntityId participant, std::uint32_t number, DiskRecord record) {
  const auto found = disks_.find(participant);
  const Disk* const before = found == disks_.end() ? nullptr : &found->second;
  const std::uint64_t used = before == nullptr ? 0 : before->used - room_of(before->find(number));
  const std::uint64_t in_hand = record.size + (before == nullptr ? 0 : before->in_hand);
  if (used + room_of(&record) > FP_DISK_BYTES || in_hand > kMostInHand) return false;
  Disk& disk = disks_[participant];
  disk.in_hand = in_hand;
  disk.used = used + room_of(&record);
  disk.accepted.push_back({number, std::move(record)});
  return true;
}

void Disks::write(EntityId participant) {
  Disk& disk = disks_.at(participant);
  ensure(!disk.accepted.empty(), "a record is accepted before it is written");
  auto [number, record] = std::move(disk.accepted.front());
  disk.accepted.pop_front();
  disk.in_hand -= record.size;
  run_.trace(participant, traced::Kept{number, record.size, record.hash});
  if (record.size == 0) {
    disk.records.erase(number);
  } else {
    disk.records.insert_or_assign(number, std::move(record));
  }
}

const DiskRecord* Disks::find(EntityId participant, std::uint32_t number) const {
  const auto disk = disks_.find(participant);
  return disk == disks_.end() ? nullptr : disk->second.find(number);
}

void Disks::forget(EntityId participant) {
  const auto found = disks_.find(participant);
  if (found == disks_.end()) return;
  Disk& disk = found->second;
  disk.accepted.clear();
  disk.used = disk.in_hand = 0;
  for (const auto& [number, record] : disk.records) disk.used += room_of(&record);
}

}  // namespace fleetproof
