#include "reports/sample_sentence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "reports/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostListed = 8;

template <class Values>
std::string listed(const Values& values, std::string (*text)(double)) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(text(value));
  if (words.size() > kMostListed) words = {words.front(), "...", words.back()};
  return joined(words);
}

std::string listed(const std::set<std::string>& names) {
  std::vector<std::string> words;
  for (const auto& name : names) words.push_back(printable(name, 40));
  const auto all = words.size();
  if (all > kMostListed) words.resize(kMostListed);
  return joined(words) + (all > kMostListed ? fmt::format(" and {} more", all - kMostListed) : "");
}

struct Bounds {
  double from = 0.0, to = 0.0;
  friend auto operator<=>(const Bounds&, const Bounds&) = default;
};

// Loss, delay, mean outage.
using Radio = std::tuple<Bounds, Bounds, Bounds>;

bool is_drawn(const Radio& radio) {
  return std::apply([](const auto&... bounds) { return ((bounds.from != bounds.to) || ...); }, radio);
}

// The lists of losses, delays and outages if every combination of them was run, else the combinations. Outages only
// where there are any.
std::string combinations(const std::set<Radio>& radios) {
  std::set<double> losses, delays_s, outages_s;
  for (const auto& [loss, delay_s, outage_s] : radios) {
    losses.insert(loss.from);
    delays_s.insert(delay_s.from);
    outages_s.insert(outage_s.from);
  }
  if (radios.size() == losses.size() * delays_s.size() * outages_s.size()) {
    const bool has_outages = *outages_s.rbegin() > 0.0;
    return fmt::format("loss {}; delay {}{}", listed(losses, percent), listed(delays_s, seconds_text),
                       has_outages ? "; mean outage " + listed(outages_s, seconds_text) : "");
  }
  std::vector<std::string> words;
  for (const auto& [loss, delay_s, outage_s] : radios) {
    if (words.size() < kMostListed)
      words.push_back(
          fmt::format("{} with {}{}", percent(loss.from), seconds_text(delay_s.from), outage_text(outage_s.from)));
  }
  return joined(words, "; ") +
         (radios.size() > kMostListed ? fmt::format("; and {} more", radios.size() - kMostListed) : "");
}

// "loss <= 40 %", "10 % <= loss <= 40 %", "loss = 40 %".
std::string within(const char* name, const Bounds& bounds, std::string (*text)(double)) {
  if (bounds.from == bounds.to) return fmt::format("{} = {}", name, text(bounds.from));
  return fmt::format("{}{} <= {}", bounds.from == 0.0 ? "" : text(bounds.from) + " <= ", name, text(bounds.to));
}

std::string region(const Radio& radio) {
  const auto& [loss, delay_s, outage_s] = radio;
  auto text = fmt::format("{} and {}", within("loss", loss, percent), within("delay", delay_s, seconds_text));
  if (outage_s.to > 0.0) text += " and " + within("mean outage", outage_s, seconds_text);
  return text;
}

std::string how_drawn(const std::string& sampling) {
  if (sampling == "uniform") return "drawn uniformly";
  return fmt::format("drawn evenly ({}), not independently", printable(sampling, 20));
}

std::string where(const std::set<Radio>& radios, const std::string& sampling) {
  if (std::ranges::none_of(radios, is_drawn)) {
    return fmt::format("at {} ({})",
                       radios.size() == 1 ? "this combination" : fmt::format("these {} combinations", radios.size()),
                       combinations(radios));
  }
  const std::string average = "; a rate is the mean over that region, not that of its worst point";
  if (radios.size() == 1)
    return fmt::format("wherever {} ({}{})", region(*radios.begin()), how_drawn(sampling), average);
  std::vector<std::string> words;
  for (const auto& radio : radios) {
    if (words.size() < kMostListed) words.push_back(region(radio));
  }
  const auto more = radios.size() > kMostListed ? fmt::format("; or {} more", radios.size() - kMostListed) : "";
  return fmt::format("wherever {}{} ({}{})", joined(words, "; or "), more, how_drawn(sampling), average);
}

// "in one warehouse, with the placement of replicate 3 throughout, "
std::string held_before(const Evidence& evidence, std::size_t worlds) {
  auto others = evidence.held_streams();
  const bool one_layout = std::erase(others, "layout") > 0;
  std::string text;
  if (one_layout)
    text += worlds == 1 ? "in one warehouse, "
                        : fmt::format("in one warehouse for each of {} layouts and fleet sizes, ", worlds);
  if (!others.empty())
    text += fmt::format("with the {} of replicate {} throughout, ", joined(others), evidence.held_replicate());
  return text;
}

std::string held_world(const Evidence& evidence) {
  if (std::ranges::find(evidence.held_streams(), "layout") == evidence.held_streams().end())
    return "that one draw of them";
  std::set<std::pair<std::string, std::uint32_t>> worlds;
  for (const auto& cell : evidence.cells()) worlds.emplace(cell.layout, cell.fleet_size);
  return worlds.size() == 1 ? "one warehouse" : "one warehouse for each layout and fleet size";
}

}  // namespace

std::string sampled(const Evidence& evidence, const std::vector<std::uint32_t>& cells) {
  std::set<Radio> radios;
  std::set<std::string> layouts;
  std::set<std::uint32_t> fleets;
  Tally tally;
  for (const auto index : cells) {
    const auto& cell = evidence.cells()[index];
    radios.emplace(Bounds{cell.loss, cell.loss_to}, Bounds{cell.delay_s, cell.delay_to_s},
                   Bounds{cell.mean_outage_s, cell.mean_outage_to_s});
    layouts.insert(cell.layout);
    fleets.insert(cell.fleet_size);
    tally.add(evidence.tally(index));
  }
  std::vector<std::string> sizes;
  for (const auto size : fleets) sizes.push_back(std::to_string(size));
  auto text = fmt::format("{}{} {}, {} {}, fleets of {}", held_before(evidence, layouts.size() * fleets.size()),
                          count_text(evidence.complete_replicates(), "replicate"), where(radios, evidence.sampling()),
                          layouts.size() == 1 ? "layout" : "layouts", listed(layouts), joined(sizes, " or "));
  if (tally.longest_ns > 0)
    text += fmt::format(", {} a run", seconds_text(static_cast<double>(tally.longest_ns) * 1e-9));
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
  return list;
}

}  // namespace fleetproof
