#include "reports/sections/sample_sentence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "reports/page/wording.hpp"
#include "reports/sections/plan_conditions.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostInASentence = 8;

std::string listed(const FactorInfo& factor, const std::set<double>& values) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(factor_text(factor, value));
  if (words.size() > kMostInASentence) words = {words.front(), "...", words.back()};
  return joined(words);
}

std::string listed(const std::set<std::string>& names) {
  std::vector<std::string> words;
  for (const auto& name : names) words.push_back(printable(name, 40));
  const auto all = words.size();
  if (all > kMostInASentence) words.resize(kMostInASentence);
  return joined(words) + (all > kMostInASentence ? fmt::format(" and {} more", all - kMostInASentence) : "");
}

// The factors of a cell: its lower and its upper bounds, which are the same unless they are drawn.
struct Span {
  FactorValues lowest, highest;
  bool is_drawn() const { return lowest != highest; }
  friend auto operator<=>(const Span&, const Span&) = default;
};

// The lists of values of each factor if every combination of them was run, else the combinations. A factor that is only
// named above 0 is left out if it is 0 everywhere.
std::string combinations(const std::set<Span>& spans) {
  std::vector<std::string> lists;
  std::size_t combined = 1;
  for (const FactorInfo& factor : kFactors) {
    std::set<double> values;
    for (const Span& span : spans) values.insert(span.lowest[factor.id]);
    combined *= values.size();
    if (!factor.only_above_zero || *values.rbegin() > 0.0)
      lists.push_back(fmt::format("{} {}", factor.name, listed(factor, values)));
  }
  if (spans.size() == combined) return joined(lists, "; ");
  std::vector<std::string> words;
  for (const Span& span : spans) {
    if (words.size() < kMostInASentence) words.push_back(factor_spans(span.lowest, span.lowest, " with "));
  }
  return joined(words, "; ") +
         (spans.size() > kMostInASentence ? fmt::format("; and {} more", spans.size() - kMostInASentence) : "");
}

// "loss <= 40 %", "10 % <= loss <= 40 %", "loss = 40 %".
std::string within(const FactorInfo& factor, double from, double to) {
  if (from == to) return fmt::format("{} = {}", factor.name, factor_text(factor, from));
  return fmt::format("{}{} <= {}", from == 0.0 ? "" : factor_text(factor, from) + " <= ", factor.name,
                     factor_text(factor, to));
}

std::string region(const Span& span) {
  std::vector<std::string> words;
  for (const FactorInfo& factor : kFactors) {
    const double from = span.lowest[factor.id], to = span.highest[factor.id];
    if (!factor.only_above_zero || to > 0.0) words.push_back(within(factor, from, to));
  }
  return joined(words, " and ");
}

std::string how_drawn(const std::string& sampling) {
  if (sampling == "uniform") return "drawn uniformly";
  return fmt::format("drawn evenly ({}), not independently", printable(sampling, 20));
}

std::string where(const std::set<Span>& spans, const std::string& sampling) {
  if (std::ranges::none_of(spans, &Span::is_drawn)) {
    return fmt::format("at {} ({})",
                       spans.size() == 1 ? "this combination" : fmt::format("these {} combinations", spans.size()),
                       combinations(spans));
  }
  const std::string average = "; a rate is the mean over that region, not that of its worst point";
  if (spans.size() == 1) return fmt::format("wherever {} ({}{})", region(*spans.begin()), how_drawn(sampling), average);
  std::vector<std::string> words;
  for (const Span& span : spans) {
    if (words.size() < kMostInASentence) words.push_back(region(span));
  }
  const auto more = spans.size() > kMostInASentence ? fmt::format("; or {} more", spans.size() - kMostInASentence) : "";
  return fmt::format("wherever {}{} ({}{})", joined(words, "; or "), more, how_drawn(sampling), average);
}

// "in one warehouse, with the placement of replicate 3 throughout, "
std::string held_before(const Evidence& evidence, std::size_t worlds) {
  auto others = evidence.plan().campaign.held_streams;
  const bool one_layout = std::erase(others, "layout") > 0;
  std::string text;
  if (one_layout)
    text += worlds == 1 ? "in one warehouse, "
                        : fmt::format("in one warehouse for each of {} layouts and fleet sizes, ", worlds);
  if (!others.empty())
    text += fmt::format("with the {} of replicate {} throughout, ", joined(others),
                        evidence.plan().campaign.held_replicate);
  return text;
}

std::string held_world(const Evidence& evidence) {
  if (std::ranges::find(evidence.plan().campaign.held_streams, "layout") == evidence.plan().campaign.held_streams.end())
    return "that one draw of them";
  std::set<std::pair<std::string, std::uint32_t>> worlds;
  for (const auto& cell : evidence.cells()) worlds.emplace(cell.layout, cell.fleet_size);
  return worlds.size() == 1 ? "one warehouse" : "one warehouse for each layout and fleet size";
}

}  // namespace

std::string sampled_quality(const Evidence& evidence, const std::vector<std::uint32_t>& cells) {
  std::vector<std::string> words;
  for (const Factor id : {Factor::Loss, Factor::Delay}) {
    std::set<double> values;
    bool is_drawn = false;
    for (const std::uint32_t index : cells) {
      const CellRecord& cell = evidence.cells()[index];
      values.insert({cell.lowest[id], cell.highest[id]});
      is_drawn |= cell.lowest[id] != cell.highest[id];
    }
    const FactorInfo& factor = info_of(id);
    const double least = *values.begin(), most = *values.rbegin();
    words.push_back(is_drawn ? within(factor, least, most)
                    : values.size() > 2
                        ? fmt::format("{} {} to {}", factor.name, factor_text(factor, least), factor_text(factor, most))
                        : fmt::format("{} {}", factor.name, listed(factor, values)));
  }
  return joined(words, "; ");
}

std::string sampled(const Evidence& evidence, const std::vector<std::uint32_t>& cells) {
  std::set<Span> spans;
  std::set<std::string> layouts;
  std::set<std::uint32_t> fleets;
  Tally tally;
  for (const auto index : cells) {
    const auto& cell = evidence.cells()[index];
    spans.insert({cell.lowest, cell.highest});
    layouts.insert(cell.layout);
    fleets.insert(cell.fleet_size);
    tally.add(evidence.tally(index));
  }
  std::vector<std::string> sizes;
  for (const auto size : fleets) sizes.push_back(std::to_string(size));
  auto text =
      fmt::format("{}{} {}, {} {}, fleets of {}", held_before(evidence, layouts.size() * fleets.size()),
                  count_text(evidence.complete_replicates(), "world"), where(spans, evidence.plan().campaign.sampling),
                  layouts.size() == 1 ? "layout" : "layouts", listed(layouts), joined(sizes, " or "));
  if (tally.longest_ns > 0)
    text += fmt::format(", {} a run", seconds_text(static_cast<double>(tally.longest_ns) / 1e9));
  // A loss says little without the length of its bursts.
  const auto lossy = [](const Span& span) { return span.highest[Factor::Loss] > 0.0; };
  const auto bursty = [](const Span& span) { return span.highest[Factor::MeanOutage] > 0.0; };
  if (std::ranges::any_of(spans, lossy)) {
    text += "; the loss is the configured one";
    if (std::ranges::none_of(spans, bursty)) text += ", each loss independent of the others";
  }
  return text;
}

std::vector<Headline> reservations(const ReportInput& input) {
  std::vector<Headline> list;
  const auto& campaign = input.campaign;
  if (!campaign.exempt_purposes.empty()) {
    std::string purposes = printable(campaign.exempt_purposes, 80);
    for (auto at = purposes.find(' '); at != std::string::npos; at = purposes.find(' ', at + 2))
      purposes.replace(at, 1, ", ");
    list.push_back({"exempt",
                    fmt::format("AGVs within {:g} m of a station for {} may be closer than the safety distance: that "
                                "is not counted as a violation here. Contact is.",
                                campaign.exempt_radius_m, purposes),
                    {}});
  }
  for (const std::string& pair : campaign.exempt_pairs) {
    list.push_back({"exempt",
                    fmt::format("{} may be closer than the safety distance to each other: that is not counted as a "
                                "violation here. Contact is.",
                                printable(pair, 200)),
                    {}});
  }
  if (!campaign.held_streams.empty()) {
    list.push_back({"held",
                    fmt::format("every replicate has the {} of replicate {}: what follows speaks of {} alone.",
                                printable(joined(campaign.held_streams), 120), campaign.held_replicate,
                                held_world(input.evidence)),
                    {}});
  }
  if (has_several_programs(campaign.engine)) {
    std::string programs = printable(campaign.engine.libraries, 2000);
    list.push_back({"drift",
                    fmt::format("more than one program made the runs of this file (--allow-drift), so that they are no "
                                "evidence for any of them: {}.",
                                programs),
                    {}});
  }
  if (const auto recorded = recorded_radio(campaign.plan_json)) {
    list.push_back({"recorded",
                    fmt::format("the radio of {} of sender and receiver is a recording: the loss and delay that are "
                                "named below do not apply to their messages.",
                                count_text(recorded->pairs, "pair")),
                    {}});
  }
  return list;
}

}  // namespace fleetproof
