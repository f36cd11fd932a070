#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "campaign/cli/command_line.hpp"
#include "campaign/watch/trace_printer.hpp"

namespace fleetproof::cli {

// What the user asks of a trace.
struct TraceWords {
  bool on = false;
  std::string format = "text", out;
  std::vector<std::string> bodies, kinds;
  std::optional<double> from_s, to_s;

  bool wanted() const { return on || !out.empty(); }
};

void add_trace_options(Options& options, TraceWords& words);

// The trace of one run, as the user asked for it: on standard error while the run goes on, or in a file after it.
class TraceOutput {
 public:
  // `violations` of the run, if they are known before it. Throws InputError. Requires: words.wanted(), and words and
  // scenario outlive the output.
  TraceOutput(const TraceWords& words, const Scenario& scenario, std::vector<Violation> violations);

  TraceSink& sink() { return *printer_; }
  void finish();

 private:
  const TraceWords& words_;
  std::string lines_;
  std::optional<TracePrinter> printer_;
};

}  // namespace fleetproof::cli
