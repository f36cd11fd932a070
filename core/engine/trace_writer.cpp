#include "core/engine/trace_writer.hpp"

#include <bit>

#include "core/base/error.hpp"

namespace fleetproof {
TraceWriter::TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink) : sink_(sink) {
  ensure(laws.size() <= 64, "a bit for each law");
  laws_.reserve(laws.size());
  for (const auto& law : laws) {
    const std::uint64_t bit = std::uint64_t{1} << laws_.size();
    if (law->hears_together()) {
      together_.push_back(law.get());
      law->hears_from(*this);
    }
    const TraceKinds kinds = law->reads();
    for (std::uint64_t bits = kinds.bits(); bits != 0; bits &= bits - 1)
      readers_[static_cast<std::size_t>(std::countr_zero(bits))] |= bit;
    const std::uint64_t about = law->reads_about().bits();
    for (std::size_t kind = 0; kind < about_.size(); ++kind) about_[kind] |= (about >> kind & 1) * bit;
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
  if (record.kind == TraceKind::ActivityBegins || record.kind == TraceKind::ActivityEnds)
    readers &= about_[record.a % about_.size()];
  for (; readers != 0; readers &= readers - 1)
    laws_[static_cast<std::size_t>(std::countr_zero(readers))]->happened(record);
}

void TraceWriter::hand_over() {
  if (together_.empty()) return;
  const TracePart newest = digest_.take_newest();
  for (Law* law : together_) law->together(newest);
}

}  // namespace fleetproof
