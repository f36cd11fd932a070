#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "campaign/watch/trace_context.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A run in the JSON trace event format of Chrome, which Perfetto and chrome://tracing show. Every body is a process
// with rows: what it does, what its agent says of itself, the radio, what happened to it. A message that is received is
// an arrow. An episode below the safety distance is a bar of its own. Perfetto nests what has no length and happens at
// one instant, and drops what lies deeper than 512: a row with more at one instant goes on in rows of its own.
class ChromeTrace final : public TraceSink {
 public:
  // Requires: the scenario outlives the object.
  explicit ChromeTrace(const Scenario& scenario);

  void record(const TraceRecord& record, std::string_view text) override;
  void piece_started(const Piece& piece) override { context_.note(piece); }
  // Call this once, after the run. `end`: of the run.
  std::string text(const std::vector<Violation>& violations, SimTime end);

 private:
  using Row = std::pair<EntityId, int>;
  struct Open {
    SimTime since;
    std::string name, details;
  };
  void begin(const Row& row, SimTime at, std::string name, std::string details);
  void end(const Row& row, SimTime at);
  // The row on which something without length is drawn.
  Row with_room(const Row& row, SimTime at);
  void bar(const Row& row, SimTime from, SimTime to, const std::string& name, const std::string& details);
  void point(const Row& row, SimTime at, const std::string& name, const std::string& details);
  void message(const TraceRecord& record);
  void name_rows(const std::map<EntityId, std::vector<SimTime>>& distance_rows);

  TraceContext context_;
  std::vector<std::string> events_;  // JSON objects
  std::map<Row, Open> open_;
  std::map<Row, std::pair<SimTime, int>> at_once_;  // the last instant of a row, and how many without length it had
  std::set<Row> more_rows_;                         // those that go on another
};

}  // namespace fleetproof
