#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/watch/trace_context.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

enum class TraceFormat : std::uint8_t { Text, JsonLines };

// Which lines of a trace are printed. Empty sets let all pass.
struct TraceFilter {
  std::set<EntityId> bodies;
  std::set<std::string> kinds;  // words of name_of(TraceKind), and kDistance
  SimTime from = kStart, to = kForever;
};
inline constexpr const char* kDistance = "distance";  // lines about the safety distance

// Makes a trace readable, one event a line, and hands the lines to `print` as the run goes on. In text: time to the
// nanosecond, body, event, what it is about, where the body is. JSON lines have the same in members.
class TracePrinter final : public TraceSink {
 public:
  using Print = std::function<void(const std::string& line)>;
  // `violations`, if they are known before: a line where each begins, and one where the bodies are closest. Requires:
  // the scenario outlives the printer.
  TracePrinter(const Scenario& scenario, TraceFormat format, TraceFilter filter, std::vector<Violation> violations,
               Print print);

  void record(const TraceRecord& record, std::string_view text) override;
  void piece_started(const Piece& piece) override { context_.note(piece); }
  // Call this after the run.
  void finish();

 private:
  struct Line {
    SimTime at;
    EntityId body;
    std::string event, details;
    std::optional<TracedMessage> message;
  };
  bool passes(const Line& line) const;
  void print(const Line& line);
  void print_distances(SimTime until);

  TraceContext context_;
  TraceFormat format_;
  TraceFilter filter_;
  std::vector<Line> distances_;  // the first last
  Print print_;
  bool has_undescribed_ = false;  // messages among the lines printed
};

// The words that TraceFilter::kinds may hold.
std::vector<std::string> trace_kind_words();

}  // namespace fleetproof
