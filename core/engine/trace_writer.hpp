#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/outcome/law.hpp"
#include "core/outcome/trace.hpp"

namespace fleetproof {

// Hands each trace record to the digest, to the sink and to the laws that read its kind.
class TraceWriter final : public TraceSource {
 public:
  // `sink` may be null. Laws and sink outlive the writer.
  TraceWriter(std::span<const std::unique_ptr<Law>> laws, TraceSink* sink);
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  // `text`: the words of a probe or a log line, the bytes of a message that is sent, else empty.
  void write(const TraceRecord& record, std::string_view text) {
    digest_.append(record);
    if (read_.has(record.kind)) [[unlikely]]
      tell(TraceRecord(record), text);  // a copy, so that the record itself need not be in memory
  }
  // Hands a record to the sink and to the laws, and leaves the digest as it is.
  void write_aside(const TraceRecord& record) {
    if (read_.has(record.kind)) tell(record, {});
  }
  // Hands a note of an agent to the sink and to nothing else.
  void note(const TraceRecord& note, std::string_view text) {
    if (has_sink()) sink_->record(note, text);
  }
  bool has_sink() const { return sink_ != nullptr; }
  TraceDigest& digest() { return digest_; }

  // Laws that hear records together hear those that they have not heard yet. Call it before the end of the run.
  void hand_over() override;

 private:
  void tell(const TraceRecord& record, std::string_view text);

  TraceDigest digest_;
  TraceSink* sink_;
  TraceKinds read_;  // by a law, or all of them by the sink
  std::vector<Law*> laws_;
  std::array<std::uint64_t, 64> readers_{};  // by kind: a bit for each law
  std::array<std::uint64_t, 16> about_{};    // by activity: a bit for each law that reads about it
  std::vector<Law*> together_;               // those that hear records together
};

}  // namespace fleetproof
