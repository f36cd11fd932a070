#include "core/engine/trace_writer.hpp"

#include <bit>

#include "core/base/error.hpp"

namespace fleetproof {
TraceWriter::TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink) : sink_(sink) {
  ensure(laws.size() <= 64, "a bit for each law");
  for (const auto& law : laws) {
    if (law->hears_together()) together_.push_back(law.get());
    const TraceKinds kinds = law->reads();
    for (std::size_t kind = 0; kind < readers_.size(); ++kind)
      readers_[kind] |= std::uint64_t{kinds.has(static_cast<TraceKind>(kind))} << laws_.size();
    read_ = read_ | kinds;
    laws_.push_back(law.get());
  }
  if (has_sink()) read_ = TraceKinds::all();
  if (together_.empty()) return;
  digest_.when_full([](void* writer) { static_cast<TraceWriter*>(writer)->hand_over(); }, this);
}

void TraceWriter::tell(const TraceRecord& record, std::string_view text) {
  if (has_sink()) sink_->record(record, text);
  std::uint64_t readers = readers_[static_cast<std::size_t>(record.kind)];
  if (readers == 0) return;
  for (const Law* law : together_) {
    if (!law->must_hear_before(record.at)) continue;
    hand_over();
    break;
  }
  for (; readers != 0; readers &= readers - 1)
    laws_[static_cast<std::size_t>(std::countr_zero(readers))]->happened(record);
}

void TraceWriter::hand_over() {
  if (together_.empty()) return;
  const TracePart newest = digest_.take_newest();
  for (Law* law : together_) law->together(newest);
}

}  // namespace fleetproof
