#include "core/agents/central/server_disk.hpp"

#include <cstring>

namespace fleetproof::agents::central {
namespace {

constexpr std::uint32_t kFormat = 1;  // of the records; a server of another format does not believe them
constexpr std::uint32_t kStartRecord = 0;

// Which start of the server wrote last, and of which boot the ways are.
struct StartRecord {
  std::uint32_t start = 0, server_boot = 0;
};

}  // namespace

// FNV-1a.
std::uint64_t ServerDisk::seal(std::uint32_t number, std::span<const std::byte> bytes) const {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto mix = [&](std::span<const std::byte> part) {
    for (const std::byte byte : part) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3;
  };
  const std::uint32_t about[] = {kFormat, number, fleet_count_, map_.station_count(), map_.lane_count()};
  mix(std::as_bytes(std::span(about)));
  mix(bytes);
  return hash;
}

bool ServerDisk::put(std::uint32_t number, std::vector<std::byte> bytes) {
  const std::uint64_t hash = seal(number, bytes);
  const auto hash_bytes = std::as_bytes(std::span(&hash, 1));
  bytes.insert(bytes.end(), hash_bytes.begin(), hash_bytes.end());
  return controller_.keep(number, bytes);
}

std::span<const std::byte> ServerDisk::get(std::uint32_t number) {
  const std::span<const std::byte> all = controller_.recall(number);
  std::uint64_t hash = 0;
  if (all.size() < sizeof hash) return {};
  const auto bytes = all.first(all.size() - sizeof hash);
  std::memcpy(&hash, all.data() + bytes.size(), sizeof hash);
  return hash == seal(number, bytes) ? bytes : std::span<const std::byte>();
}

bool ServerDisk::open(std::uint32_t server_boot) {
  const StartRecord present{start_, server_boot};
  const auto bytes = std::as_bytes(std::span(&present, 1));
  opened_ = opened_ || put(kStartRecord, {bytes.begin(), bytes.end()});
  return opened_;
}

std::vector<AgvRecord> ServerDisk::recall() {
  StartRecord last;
  const auto bytes = get(kStartRecord);
  if (bytes.size() != sizeof last) return {};
  std::memcpy(&last, bytes.data(), sizeof last);
  if (last.start + 1 != start_) return {};
  std::vector<AgvRecord> records;
  for (std::uint32_t agv = 0; agv < fleet_count_; ++agv) {
    const std::optional<AgvRecord> record = decode_record(get(1 + agv));
    if (!record || record->state.way.server_boot != last.server_boot) return {};
    records.push_back(*record);
  }
  return records;
}

}  // namespace fleetproof::agents::central
