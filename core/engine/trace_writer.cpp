#include "core/engine/trace_writer.hpp"

namespace fleetproof {

TraceWriter::TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink) : sink_(sink) {
  for (const auto& law : laws) {
    const TraceKinds kinds = law->reads();
    if (!kinds.empty()) readers_.emplace_back(law.get(), kinds);
    read_by_laws_ = read_by_laws_ | kinds;
  }
}

void TraceWriter::write(const TraceRecord& record, std::string_view text) {
  digest_.append(record);
  if (sink_ != nullptr) sink_->record(record, text);
  if (!read_by_laws_.has(record.kind)) return;
  for (const auto& [law, kinds] : readers_) {
    if (kinds.has(record.kind)) law->happened(record);
  }
}

}  // namespace fleetproof
