#include "core/agents/disk_table.hpp"

#include <cstring>

namespace fleetproof::agents {
namespace {

constexpr std::uint32_t kFormat = 1;       // of the records; a program of another format does not believe them
constexpr std::uint32_t kStartNumber = 0;  // of the record that says which start wrote last; rows have 1 and more

struct StartRecord {
  std::uint32_t start = 0, era = 0;
  void fields(auto& io) { io(start, era); }
};

}  // namespace

// FNV-1a.
std::uint64_t DiskTable::seal(std::uint32_t number, std::span<const std::byte> bytes) const {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto mix = [&](std::span<const std::byte> part) {
    for (const std::byte byte : part) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3;
  };
  const std::uint32_t place[] = {kFormat, number};
  mix(std::as_bytes(std::span(place)));
  mix(std::as_bytes(std::span(about_)));
  mix(bytes);
  return hash;
}

bool DiskTable::put(std::uint32_t number, std::vector<std::byte> bytes) {
  const std::uint64_t hash = seal(number, bytes);
  const auto hash_bytes = std::as_bytes(std::span(&hash, 1));
  bytes.insert(bytes.end(), hash_bytes.begin(), hash_bytes.end());
  return controller_.keep(number, bytes);
}

std::span<const std::byte> DiskTable::get(std::uint32_t number) {
  const std::span<const std::byte> all = controller_.recall(number);
  std::uint64_t hash = 0;
  if (all.size() < sizeof hash) return {};
  const auto bytes = all.first(all.size() - sizeof hash);
  std::memcpy(&hash, all.data() + bytes.size(), sizeof hash);
  return hash == seal(number, bytes) ? bytes : std::span<const std::byte>();
}

bool DiskTable::open(std::uint32_t era) {
  opened_ = opened_ || put(kStartNumber, encode(StartRecord{start_, era}));
  return opened_;
}

std::optional<std::uint32_t> DiskTable::last_era() {
  const std::optional<StartRecord> last = decode_as<StartRecord>(get(kStartNumber));
  return last && last->start + 1 == start_ ? std::optional(last->era) : std::nullopt;
}

}  // namespace fleetproof::agents
