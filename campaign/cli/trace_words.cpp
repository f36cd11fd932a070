#include "campaign/cli/trace_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "campaign/cli/output_file.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/watch/run_text.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

TraceFormat format_of(const std::string& word) {
  if (word == "text") return TraceFormat::Text;
  if (word == "json") return TraceFormat::JsonLines;
  throw InputError("--trace-format", in_quotes(word) + " is not a format; write text or json");
}

EntityId body_of(const Scenario& scenario, const std::string& name) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < scenario.entity_count(); ++i) {
    known.push_back(body_name(scenario, EntityId{i}));
    if (known.back() == name) return EntityId{i};
  }
  throw InputError("--trace-body", fmt::format("there is no {} in this run; known: {}", in_quotes(name),
                                               printable(joined(known), 200)));
}

SimTime instant_of(const std::optional<double>& given_s, SimTime otherwise) {
  return given_s ? kStart + seconds(std::clamp(*given_s, 0.0, 1e9)) : otherwise;
}

TraceFilter filter_of(const TraceWords& words, const Scenario& scenario) {
  TraceFilter filter;
  for (const std::string& name : words.bodies) filter.bodies.insert(body_of(scenario, name));
  const auto known = trace_kind_words();
  for (const std::string& kind : words.kinds) {
    if (std::ranges::find(known, kind) == known.end())
      throw InputError("--trace-kind", fmt::format("{} is not an event; known: {}", in_quotes(kind), joined(known)));
    filter.kinds.insert(kind);
  }
  filter.from = instant_of(words.from_s, filter.from);
  filter.to = instant_of(words.to_s, filter.to);
  if (filter.to < filter.from)
    throw InputError("--trace-to",
                     fmt::format("is {} s, which is before --trace-from, {} s; no event lies between them",
                                 to_seconds(filter.to - kStart), to_seconds(filter.from - kStart)));
  return filter;
}

}  // namespace

void add_trace_options(Options& options, TraceWords& words) {
  options.flag("--trace", words.on, "print every event on stderr");
  options.option("--trace-output", words.out, "write the trace to this file instead");
  options.option("--trace-format", words.format, "text (default), or json: one JSON object a line");
  options.option("--trace-body", words.bodies, "only events of this body; may be repeated");
  options.option("--trace-kind", words.kinds,
                 "only this event (sent, received, begins, distance, ...); may be repeated");
  options.option("--trace-from", words.from_s, "only events from this second of the run on");
  options.option("--trace-to", words.to_s, "only events up to this second of the run");
}

TraceOutput::TraceOutput(const TraceWords& words, const Scenario& scenario, std::vector<Violation> violations)
    : words_(words) {
  const auto print = [this](const std::string& line) {
    if (words_.out.empty()) return talk_text(line, kForever_ms);
    lines_ += line;
  };
  if (!words.out.empty()) require_writable({words.out, "--trace-output", OutputKind::Trace});
  printer_.emplace(scenario, format_of(words.format), filter_of(words, scenario), std::move(violations), print);
}

void TraceOutput::finish() {
  printer_->finish();
  if (!words_.out.empty()) write_whole({words_.out, "--trace-output", OutputKind::Trace}, lines_);
}

}  // namespace fleetproof::cli
