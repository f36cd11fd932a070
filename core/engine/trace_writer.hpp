#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/outcome/law.hpp"
#include "core/outcome/trace.hpp"

namespace fleetproof {

// Hands each trace record to the digest, to the sink and to the laws that read its kind.
class TraceWriter {
 public:
  // `sink` may be null. Laws and sink outlive the writer.
  TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink);

  // `text` are the words of a probe or a log line, else empty.
  void write(const TraceRecord& record, std::string_view text) {
    digest_.append(record);
    if (kept_.has(record.kind)) keep(record);
    if (read_.has(record.kind)) tell(record, text);
  }
  // Hands a note of an agent to the sink and to nothing else.
  void note(const TraceRecord& note, std::string_view text) {
    if (has_sink()) sink_->record(note, text);
  }
  bool has_sink() const { return sink_ != nullptr; }
  TraceDigest& digest() { return digest_; }

  // Laws that hear messages together hear those that they have not heard yet. Call it before the end of the run.
  void hand_over();

 private:
  void keep(const TraceRecord& record) {
    messages_[waiting_++] = record;
    if (waiting_ == messages_.size()) hand_over();
  }
  void tell(const TraceRecord& record, std::string_view text);

  TraceDigest digest_;
  TraceSink* sink_;
  TraceKinds read_;                            // by a law, or all of them by the sink
  std::array<std::vector<Law*>, 64> readers_;  // by kind
  TraceKinds kept_;                            // of messages, if a law hears them together
  std::vector<Law*> together_;                 // those laws
  std::vector<TraceRecord> messages_;          // room; the first `waiting_` have not been handed over
  std::size_t waiting_ = 0;
};

}  // namespace fleetproof
