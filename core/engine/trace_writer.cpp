#include "core/engine/trace_writer.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kTogether = 256;  // records

}  // namespace

TraceWriter::TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink) : sink_(sink) {
  for (const auto& law : laws) {
    const bool together = law->hears_messages_together();
    if (together) together_.push_back(law.get());
    const TraceKinds kinds = law->reads();
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      const auto kind = static_cast<TraceKind>(i);
      if (!kinds.has(kind) || (together && kMessageKinds.has(kind))) continue;
      readers_[i].push_back(law.get());
      read_ = read_ | TraceKinds{kind};
    }
  }
  if (has_sink()) read_ = TraceKinds::all();
  if (together_.empty()) return;
  kept_ = kMessageKinds;
  messages_.resize(kTogether);
}

void TraceWriter::tell(const TraceRecord& record, std::string_view text) {
  if (has_sink()) sink_->record(record, text);
  const auto& readers = readers_[static_cast<std::size_t>(record.kind)];
  if (!readers.empty() && !kMessageKinds.has(record.kind)) hand_over();
  for (Law* law : readers) law->happened(record);
}

void TraceWriter::hand_over() {
  if (waiting_ == 0) return;
  for (Law* law : together_) law->messages({messages_.data(), waiting_});
  waiting_ = 0;
}

}  // namespace fleetproof
