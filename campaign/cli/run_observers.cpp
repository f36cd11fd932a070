#include "campaign/cli/run_observers.hpp"

#include <fmt/format.h>

#include "campaign/cli/output_file.hpp"
#include "campaign/watch/moment_picture.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::uint64_t kEvery_ms = 10, kMostEvery_ms = 3'600'000;

Duration step_of(const ObserverWords& words) {
  const std::uint64_t every_ms = words.every_ms.value_or(kEvery_ms);
  if (every_ms < 1 || every_ms > kMostEvery_ms)
    throw InputError("--every-ms", fmt::format("is {}; it is 1 to {}", every_ms, kMostEvery_ms));
  return std::chrono::milliseconds(every_ms);
}

OutputFile pieces_file(const ObserverWords& words) { return {words.pieces, "--pieces", OutputKind::Pieces}; }
OutputFile poses_file(const ObserverWords& words) { return {words.poses, "--poses", OutputKind::Poses}; }

OutputFile chrome_file(const ObserverWords& words) { return {words.chrome, "--chrome-trace", OutputKind::ChromeTrace}; }

OutputFile moment_file(const ObserverWords& words) { return {words.svg, "--svg", OutputKind::Picture}; }

OutputFile html_file(const ObserverWords& words) { return {words.html, "--html", OutputKind::ReplayPage}; }

std::string instants_text(SimTime end) {
  return fmt::format("the run lasts from 0 to {} s; choose an instant in it", to_seconds(end));
}

// The instant of the picture.
SimTime moment_of(const ObserverWords& words, const Scenario& scenario) {
  if (!words.at_s) throw InputError("--svg", "needs the instant of the picture; name its second with --at");
  if (words.svg.empty()) throw InputError("--at", "is the instant of a picture; name its file with --svg");
  // Written so that a number that is none is refused, too.
  if (!(*words.at_s >= 0.0 && seconds(*words.at_s) <= scenario.horizon))
    throw InputError("--at", fmt::format("is {} s; {}", *words.at_s, instants_text(kStart + scenario.horizon)));
  return kStart + seconds(*words.at_s);
}

}  // namespace

void add_observer_options(Options& options, ObserverWords& words) {
  add_trace_options(options, words.trace);
  options.option("--pieces", words.pieces, "write the exact motion of every body to this file (JSON)");
  options.option("--poses", words.poses, "write the pose of every body at equal steps to this file (CSV)");
  options.option("--chrome-trace", words.chrome,
                 "write activities and messages to this file, for Perfetto (ui.perfetto.dev) and chrome://tracing");
  options.option("--html", words.html,
                 "write a page to this file that shows the run in a browser: floor, messages, beliefs, clearance");
  options.option("--every-ms", words.every_ms, "step of --poses in milliseconds (default: 10)");
  options.option("--svg", words.svg,
                 "draw the floor at the instant --at into this file (SVG): bodies, perimeters, hulls, conflicts");
  options.option("--at", words.at_s, "instant of --svg in seconds of the run");
}

RunObservers::RunObservers(const ObserverWords& words, const Scenario& scenario, std::vector<Violation> violations,
                           ReplayWords replay)
    : words_(words), scenario_(scenario), replay_(std::move(replay)) {
  step_of(words);
  if (!words.pieces.empty()) require_writable(pieces_file(words));
  if (!words.poses.empty()) require_writable(poses_file(words));
  if (!words.chrome.empty()) {
    require_writable(chrome_file(words));
    chrome_.emplace(scenario);
  }
  if (!words.html.empty()) {
    require_writable(html_file(words));
    film_.emplace(scenario);
  }
  if (!words.svg.empty() || words.at_s) {
    moment_.emplace(scenario, moment_of(words, scenario));
    require_writable(moment_file(words));
  }
  if (words.trace.wanted()) trace_.emplace(words.trace, scenario, std::move(violations));
  if (!words.pieces.empty() || !words.poses.empty()) pieces_.emplace(*scenario.map);
}

void RunObservers::record(const TraceRecord& record, std::string_view text) {
  if (trace_) trace_->sink().record(record, text);
  if (chrome_) chrome_->record(record, text);
  if (film_) film_->record(record, text);
  if (moment_) moment_->record(record, text);
}

void RunObservers::piece_started(const Piece& piece) {
  if (trace_) trace_->sink().piece_started(piece);
  if (chrome_) chrome_->piece_started(piece);
  if (film_) film_->piece_started(piece);
}

void RunObservers::piece_ended(const Piece& piece) {
  if (pieces_) pieces_->piece_ended(piece);
  if (film_) film_->piece_ended(piece);
  if (moment_) moment_->piece_ended(piece);
}

void RunObservers::finish(const Outcome& outcome, const std::string& remark) {
  const SimTime end = at_ns(static_cast<std::int64_t>(outcome.simulated_ns));
  if (moment_ && moment_->at() > end)
    throw InputError("--at", fmt::format("is {} s; {}", to_seconds(moment_->at()), instants_text(end)));
  if (trace_) trace_->finish();
  if (!words_.pieces.empty()) write_whole(pieces_file(words_), pieces_json(scenario_, pieces_->pieces()));
  if (!words_.poses.empty()) write_whole(poses_file(words_), poses_csv(scenario_, pieces_->pieces(), step_of(words_)));
  if (chrome_) write_whole(chrome_file(words_), chrome_->text(outcome.violations, end));
  if (moment_) write_whole(moment_file(words_), moment_svg(moment_->moment(), scenario_));
  if (!remark.empty()) replay_.explained = {};  // it is about another run than the page shows
  if (film_) write_whole(html_file(words_), replay_html(*film_, scenario_, outcome, replay_, remark));
}

}  // namespace fleetproof::cli
