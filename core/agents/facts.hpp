#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "core/sdk/fact_store.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// The facts of the host, from which all AGVs of a run derive their knowledge of the plant. On a host that has none
// (before minor 3), each AGV keeps its own.
class Facts {
 public:
  explicit Facts(const fp_briefing& briefing) {
    const bool told = briefing.struct_size >= offsetof(fp_briefing, facts) + sizeof(briefing.facts);
    if (!told || briefing.facts == nullptr) own_ = std::make_unique<FactStore>(briefing);
    facts_ = own_ ? &own_->facts() : briefing.facts;
  }

  const fp_facts& shared() const { return *facts_; }

 private:
  std::unique_ptr<FactStore> own_;
  const fp_facts* facts_;
};

// An answer that is a table of plain values.
template <class T>
std::span<const T> ask(const fp_facts& facts, fp_derive derive, std::uint64_t question) {
  std::uint64_t size = 0;
  const void* bytes = facts.ask(&facts, derive, question, &size);
  return {static_cast<const T*>(bytes), static_cast<std::size_t>(size / sizeof(T))};
}

template <class T>
void answer(const fp_facts& facts, fp_answer* to, const std::vector<T>& table) {
  static_assert(std::is_trivially_copyable_v<T>);
  facts.answer(to, table.data(), table.size() * sizeof(T));
}

// Several tables in one answer. They are read in the order in which they were added.
class TableWriter {
 public:
  template <class... Ts>
  void add(const std::vector<Ts>&... tables) {
    static_assert(((std::is_trivially_copyable_v<Ts> && alignof(Ts) <= kAlignment) && ...));
    bytes_.reserve(bytes_.size() + (... + (sizeof(std::uint64_t) + kAlignment + tables.size() * sizeof(Ts))));
    (add_bytes(tables.data(), tables.size(), tables.size() * sizeof(Ts)), ...);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

  static constexpr std::size_t kAlignment = 8;

 private:
  void add_bytes(const void* first, std::uint64_t count, std::size_t size) {
    const auto put = [&](const void* from, std::size_t length) {
      const auto* bytes = static_cast<const std::byte*>(from);
      bytes_.insert(bytes_.end(), bytes, bytes + length);
    };
    put(&count, sizeof(count));
    if (size > 0) put(first, size);
    bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
  }

  std::vector<std::byte> bytes_;
};

class TableReader {
 public:
  explicit TableReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  std::span<const T> next() {
    std::uint64_t count = 0;
    std::memcpy(&count, bytes_.data(), sizeof(count));
    const auto* first = reinterpret_cast<const T*>(bytes_.data() + sizeof(count));
    const std::size_t size = (count * sizeof(T) + TableWriter::kAlignment - 1) / TableWriter::kAlignment;
    bytes_ = bytes_.subspan(sizeof(count) + size * TableWriter::kAlignment);
    return {first, static_cast<std::size_t>(count)};
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace fleetproof::agents
