#include "reports/replay_page/explained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/json_text.hpp"
#include "reports/markup/section_tables.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {
namespace {

using html::Element;
using html::text_element;

constexpr int kExplainedVersion = 1;

constexpr double kCurveWidth_px = 420, kCurveHeight_px = 130, kCurveLeft_px = 34, kCurveRight_px = 10, kCurveTop_px = 8,
                 kCurveBottom_px = 34;

ExplainedRun explained_from(const Json& json) {
  ExplainedRun run;
  run.of = json.at("of");
  run.failure = json.at("failure");
  run.lead = json.at("lead");
  for (const Json& line : json.at("sentences")) {
    ExplainedLine& told = run.lines.emplace_back();
    told.text = line.at("text");
    if (!line.at("at_us").is_null()) told.at_us = line.at("at_us").get<std::int64_t>();
    told.is_of_run = line.at("of_run");
    told.runs = line.at("runs").get<std::vector<std::size_t>>();
  }
  run.branches = json.at("branches");
  run.is_whole = json.value("whole", true);
  for (const Json& at : json.at("curve")) run.curve.push_back({at.at("at_us"), at.at("failing")});
  return run;
}

// No run lasts longer: figures and clicks can count with these instants.
bool has_possible_instants(const ExplainedRun& run) {
  constexpr std::int64_t kLatest_us = 1'000'000'000'000'000;
  const auto is_possible = [](std::int64_t at_us) { return at_us >= 0 && at_us <= kLatest_us; };
  return std::ranges::all_of(run.curve, is_possible, &ExplainedBranches::at_us) &&
         std::ranges::all_of(run.lines, [&](const ExplainedLine& line) { return is_possible(line.at_us.value_or(0)); });
}

// An instant of this page is one that a click goes to; that of another page is a link.
Element line_element(const ExplainedPart& part, const ExplainedLine& line) {
  const bool is_here = line.is_of_run == (part.shows == ExplainedPart::Shows::Run);
  Element told = line.at_us && is_here ? Element("p", {{"data-us", fmt::format("{}", *line.at_us)}}) : Element("p");
  told.text(line.text);
  const std::string& elsewhere = line.is_of_run ? part.run_page : part.small_page;
  if (line.at_us && !is_here && !elsewhere.empty())
    told.text(" ").add(Element::link_to_page(elsewhere, fmt::format("t={}", time_text(*line.at_us)), "show"));
  if (line.runs.empty()) return told;
  told.text(" [");
  for (std::size_t i = 0; i < line.runs.size(); ++i) {
    const std::string number = fmt::format("{}", line.runs[i]);
    if (i > 0) told.text(", ");
    if (line.runs[i] <= part.run_pages) {
      told.add(Element::link_to_page(page_of_run(line.runs[i]), "", number));
    } else {
      told.text(number);
    }
  }
  return told.text("]");
}

// The share of branches that fail, over the time from which the radio draws anew.
Element curve_figure(const ExplainedRun& run) {
  const std::int64_t from_us = run.curve.front().at_us,
                     to_us = std::max(run.curve.back().at_us, run.curve.front().at_us + 1);
  const auto x = [&](std::int64_t at_us) {
    return kCurveLeft_px + (kCurveWidth_px - kCurveLeft_px - kCurveRight_px) * static_cast<double>(at_us - from_us) /
                               static_cast<double>(to_us - from_us);
  };
  const auto y = [&](std::size_t failing) {
    const double share = static_cast<double>(failing) / static_cast<double>(std::max<std::size_t>(1, run.branches));
    return kCurveHeight_px - kCurveBottom_px - (kCurveHeight_px - kCurveBottom_px - kCurveTop_px) * share;
  };
  Element svg("svg", {{"viewBox", fmt::format("0 0 {} {}", kCurveWidth_px, kCurveHeight_px)},
                      {"role", "img"},
                      {"aria-label", "how often the run fails if the radio draws anew from an instant on"}});
  const auto note = [&](const std::string& text, double at_x, double at_y, const char* anchor) {
    svg.add(
        text_element("text", text,
                     {{"x", at_x}, {"y", at_y}, {"text-anchor", anchor}, {"font-size", 11}, {"fill", "currentColor"}}));
  };
  std::string path;
  for (const ExplainedBranches& at : run.curve)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(at.at_us), y(at.failing));
  for (const std::size_t level : {std::size_t{0}, run.branches})
    svg.add(
        Element("path", {{"d", fmt::format("M{} {:.1f}H{}", kCurveLeft_px, y(level), kCurveWidth_px - kCurveRight_px)},
                         {"stroke", "currentColor"},
                         {"stroke-opacity", "0.25"}}));
  svg.add(Element("path", {{"d", path}, {"fill", "none"}, {"stroke", "currentColor"}, {"stroke-width", 2}}));
  for (const ExplainedBranches& at : run.curve)
    svg.add(Element("circle", {{"cx", x(at.at_us)}, {"cy", y(at.failing)}, {"r", 2.5}, {"fill", "currentColor"}}));
  note("100 %", kCurveLeft_px - 4, y(run.branches) + 4, "end");
  note("0", kCurveLeft_px - 4, y(0) + 4, "end");
  note(time_text(from_us) + " s", kCurveLeft_px, kCurveHeight_px - kCurveBottom_px + 16, "start");
  note(time_text(to_us) + " s", kCurveWidth_px - kCurveRight_px, kCurveHeight_px - kCurveBottom_px + 16, "end");
  Element figure("figure", {{"class", "curve"}});
  figure.add(svg);
  return figure.add(text_element(
      "figcaption",
      fmt::format("So many of {} branches fail, if the radio draws anew from this instant on.", run.branches)));
}

}  // namespace

std::string explained_text(const ExplainedRun& run) {
  Json json = {{"schema_version", kExplainedVersion},
               {"of", run.of},
               {"failure", run.failure},
               {"lead", run.lead},
               {"sentences", Json::array()},
               {"branches", run.branches},
               {"whole", run.is_whole},
               {"curve", Json::array()}};
  for (const ExplainedLine& line : run.lines)
    json["sentences"].push_back({{"text", line.text},
                                 {"at_us", line.at_us ? Json(*line.at_us) : Json(nullptr)},
                                 {"of_run", line.is_of_run},
                                 {"runs", line.runs}});
  for (const ExplainedBranches& at : run.curve) json["curve"].push_back({{"at_us", at.at_us}, {"failing", at.failing}});
  return shown_json(json);
}

std::optional<ExplainedRun> parse_explained(const std::string& text) {
  const Json json = read_json(text);
  if (!json.is_object() || json.value("schema_version", Json()) != kExplainedVersion) return std::nullopt;
  try {
    ExplainedRun run = explained_from(json);
    return has_possible_instants(run) ? std::optional(std::move(run)) : std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string page_of_run(std::size_t number) { return fmt::format("{:03}.html", number); }

Element explained_part(const ExplainedPart& part) {
  Element box("div", {{"class", "why"}, {"id", "why"}});
  if (part.run.lines.empty()) {
    if (part.command.empty()) return box;
    Element hint("p", {{"class", "soft"}});
    hint.text("Why it failed was not looked for. ").add(text_element("code", part.command));
    return box.add(hint.text(" changes one thing at a time and simulates again; then this page tells what it found."));
  }
  box.add(text_element("h3", "Why it failed"));
  Element note("p", {{"class", "soft"}});
  note.text("Found by changing one thing at a time in the smallest case that fails in the same way; ");
  box.add(note.text(part.run_page.empty() && part.small_page.empty()
                        ? "its instants are those of that case, not of this run. The runs in brackets show it: "
                        : "the runs in brackets show it: ")
              .add(text_element("code", part.command)));
  for (const ExplainedLine& line : part.run.lines) box.add(line_element(part, line));
  if (part.run.curve.size() > 1 && part.run.branches > 0) box.add(curve_figure(part.run));
  return box;
}

}  // namespace fleetproof::web
