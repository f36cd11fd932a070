#include "core/engine/trace_writer.hpp"

namespace fleetproof {

TraceWriter::TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink) : sink_(sink) {
  for (const auto& law : laws) {
    const TraceKinds kinds = law->reads();
    for (std::size_t kind = 0; kind < readers_.size(); ++kind) {
      if (kinds.has(static_cast<TraceKind>(kind))) readers_[kind].push_back(law.get());
    }
  }
}

void TraceWriter::write(const TraceRecord& record, std::string_view text) {
  digest_.append(record);
  if (sink_ != nullptr) sink_->record(record, text);
  for (Law* law : readers_[static_cast<std::size_t>(record.kind)]) law->happened(record);
}

}  // namespace fleetproof
