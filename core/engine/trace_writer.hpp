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
  void write(const TraceRecord& record, std::string_view text);
  // Hands a note of an agent to the sink and to nothing else.
  void note(const TraceRecord& note, std::string_view text) {
    if (has_sink()) sink_->record(note, text);
  }
  bool has_sink() const { return sink_ != nullptr; }
  TraceDigest& digest() { return digest_; }

 private:
  TraceDigest digest_;
  TraceSink* sink_;
  std::array<std::vector<Law*>, 64> readers_;  // by kind
};

}  // namespace fleetproof
