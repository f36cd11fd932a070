#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof::cli {

// Prints the trace of a run on stderr, one event a line. What an agent calls a message stands in the lines of that
// message.
class TracePrinter final : public TraceSink {
 public:
  explicit TracePrinter(const Scenario& scenario) : scenario_(scenario) {}
  void record(const TraceRecord& record, std::string_view text) override;

 private:
  std::string details_of(const TraceRecord& record, std::string_view text) const;
  std::string message_details(const TraceRecord& record) const;
  std::string note_details(const TraceRecord& record, std::string_view text) const;

  const Scenario& scenario_;
  std::map<std::uint64_t, std::string> described_;  // by the hash of the message
};

}  // namespace fleetproof::cli
