#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/agents/byte_fields.hpp"
#include "core/agents/controller.hpp"

namespace fleetproof::agents {

// A table on the disk of a computer, of which a later start of its program believes all rows or none. All rows are of
// one era, which the program names when it begins to write, and each row says by `era()`; a start may go on with the
// era of the start before. Each record is sealed with a checksum over its content, its number and `about`, so that a
// torn record, or one of another plant, is not believed.
class DiskTable {
 public:
  // `about`: what the rows depend on, as the sizes of the plant. `start`: how often the computer has started before.
  DiskTable(Controller& controller, std::vector<std::uint32_t> about, std::uint32_t rows, std::uint32_t start)
      : controller_(controller), about_(std::move(about)), rows_(rows), start_(start) {}

  // All rows as the start before left them; empty if the disk is not to be believed. An image of the disk from an
  // earlier start is not: it lacks later rows.
  template <class Row>
  std::vector<Row> recall() {
    std::vector<Row> rows;
    const std::optional<std::uint32_t> era = last_era();
    for (std::uint32_t row = 0; era && row < rows_; ++row) {
      const std::optional<Row> found = decode_as<Row>(get(1 + row));
      if (!found || found->era() != *era) return {};
      rows.push_back(*found);
    }
    return rows;
  }
  // To be called at the start, and again until it is true: this start writes rows of this era.
  bool open(std::uint32_t era) {
    opened_ = opened_ || put(kStartNumber, encode(StartRecord{start_, era}));
    return opened_;
  }
  // True if whatever is sent from now on is sent after the row is on the disk. Never before `open` was true.
  template <class Row>
  bool keep(std::uint32_t row, const Row& content) {
    return opened_ && put(1 + row, encode(content));
  }

 private:
  static constexpr std::uint32_t kFormat = 1;       // of the records; a program of another format believes none
  static constexpr std::uint32_t kStartNumber = 0;  // of the record that says which start wrote last
  struct StartRecord {
    std::uint32_t start = 0, era = 0;
    void fields(auto& io) { io(start, era); }
  };

  // FNV-1a.
  std::uint64_t seal(std::uint32_t number, std::span<const std::byte> bytes) const {
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
  bool put(std::uint32_t number, std::vector<std::byte> bytes) {
    const std::uint64_t hash = seal(number, bytes);
    const auto hash_bytes = std::as_bytes(std::span(&hash, 1));
    bytes.insert(bytes.end(), hash_bytes.begin(), hash_bytes.end());
    return controller_.keep(number, bytes);
  }
  // What was put there; empty if there is no such record, or if its seal is wrong.
  std::span<const std::byte> get(std::uint32_t number) {
    const std::span<const std::byte> all = controller_.recall(number);
    std::uint64_t hash = 0;
    if (all.size() < sizeof hash) return {};
    const auto bytes = all.first(all.size() - sizeof hash);
    std::memcpy(&hash, all.data() + bytes.size(), sizeof hash);
    return hash == seal(number, bytes) ? bytes : std::span<const std::byte>();
  }
  // That of the start before; none if it wrote nothing.
  std::optional<std::uint32_t> last_era() {
    const std::optional<StartRecord> last = decode_as<StartRecord>(get(kStartNumber));
    return last && last->start + 1 == start_ ? std::optional(last->era) : std::nullopt;
  }

  Controller& controller_;
  std::vector<std::uint32_t> about_;
  std::uint32_t rows_, start_;
  bool opened_ = false;
};

}  // namespace fleetproof::agents
