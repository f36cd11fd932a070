#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/cli/command_line.hpp"
#include "campaign/cli/trace_words.hpp"
#include "campaign/watch/chrome_trace.hpp"
#include "campaign/watch/moment.hpp"
#include "campaign/watch/pieces_file.hpp"
#include "campaign/watch/replay_file.hpp"

namespace fleetproof::cli {

// What the user wants to see or keep of one run, besides its outcome.
struct ObserverWords {
  TraceWords trace;
  std::string pieces, poses, chrome, html, svg;
  std::optional<std::uint64_t> every_ms;
  std::optional<double> at_s;  // of the picture

  bool wanted() const {
    return trace.wanted() || !pieces.empty() || !poses.empty() || !chrome.empty() || !html.empty() || !svg.empty() ||
           at_s.has_value();
  }
};

void add_observer_options(Options& options, ObserverWords& words);

// All that observes one run, as one sink.
class RunObservers final : public TraceSink {
 public:
  // `violations` of the run, if they are known before it. Throws InputError. Requires: words and scenario outlive the
  // observers.
  RunObservers(const ObserverWords& words, const Scenario& scenario, std::vector<Violation> violations,
               ReplayWords replay);

  void record(const TraceRecord& record, std::string_view text) override;
  void piece_started(const Piece& piece) override;
  void piece_ended(const Piece& piece) override;
  // Call this after the run: writes the files. `remark` is for the replay page. Throws InputError if the run ended
  // before the instant of the picture.
  void finish(const Outcome& outcome, const std::string& remark = {});

 private:
  const ObserverWords& words_;
  const Scenario& scenario_;
  std::optional<TraceOutput> trace_;
  std::optional<PieceKeeper> pieces_;
  std::optional<ChromeTrace> chrome_;
  ReplayWords replay_;
  std::optional<FilmRecorder> film_;
  std::optional<MomentKeeper> moment_;
};

}  // namespace fleetproof::cli
