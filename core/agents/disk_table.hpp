#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
  bool open(std::uint32_t era);
  // True if whatever is sent from now on is sent after the row is on the disk. Never before `open` was true.
  template <class Row>
  bool keep(std::uint32_t row, const Row& content) {
    return opened_ && put(1 + row, encode(content));
  }

 private:
  std::uint64_t seal(std::uint32_t number, std::span<const std::byte> bytes) const;
  bool put(std::uint32_t number, std::vector<std::byte> bytes);
  // What was put there; empty if there is no such record, or if its seal is wrong.
  std::span<const std::byte> get(std::uint32_t number);
  // That of the start before; none if it wrote nothing.
  std::optional<std::uint32_t> last_era();

  Controller& controller_;
  std::vector<std::uint32_t> about_;
  std::uint32_t rows_, start_;
  bool opened_ = false;
};

}  // namespace fleetproof::agents
