#include "laws/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "laws/battery_law.hpp"
#include "laws/congestion_law.hpp"
#include "laws/containment_law.hpp"
#include "laws/coverage_law.hpp"
#include "laws/exempting_law.hpp"
#include "laws/fault_record_law.hpp"
#include "laws/normal_operation_law.hpp"
#include "laws/progress_law.hpp"
#include "laws/published_law.hpp"

namespace fleetproof {
namespace {

// Which laws watch a run of a campaign.
enum class LawUse : std::uint8_t {
  Judge,      // of violations: the first law of every run
  Default,    // beside it, unless the campaign leaves the law out
  ToCompare,  // a published law: a judge that no campaign runs
};

struct LawLine {
  LawUse use;
  Entry<MakeLaw> entry;
};

constexpr LawLine kLines[] = {
    {LawUse::Judge,
     {"safety-distance",
      "Finds every episode of time in which an AGV is closer than the safety distance to another body, exact to the "
      "microsecond and the micrometre. It does not see dips of less than 1 micrometre, and may join episodes less "
      "than "
      "0.1 s apart.",
      make_safety_distance_law}},
    {LawUse::Default,
     {"battery",
      "Finds every AGV whose battery runs empty away from a charging station, exact to the nanosecond. It does not see "
      "what the world does not record.",
      make_battery_law}},
    {LawUse::Default,
     {"containment",
      "Finds every load that two AGVs hold, that vanishes, lies at a station its transport does not name, is taken by "
      "a "
      "loaded AGV, moves without an AGV, or is delivered twice, exact to the nanosecond. It does not see a load that "
      "moves without a record.",
      make_containment_law}},
    {LawUse::Default,
     {"progress",
      "Finds deadlocks (with the AGV for which each AGV waits), livelocks and starving AGVs. It looks every twelfth of "
      "stuck_after for AGVs that have open transports and make no progress. It does not see why. On a long way it "
      "accuses a "
      "livelock later.",
      make_progress_law}},
    {LawUse::Default,
     {"normal-operation",
      "Finds safe mode and standstill while the radio keeps its contract, judged every second by the last 10 s of "
      "every "
      "link, and too little throughput if a floor is set. It does not see safe mode that no agent declares.",
      make_normal_operation_law}},
    {LawUse::Default,
     {"congestion",
      "Finds seconds in which the fleet uses half of the radio channel or more, or loses a tenth of its receptions by "
      "interference. It counts the whole floor as one channel and does not see messages that are only late.",
      make_congestion_law}},
    {LawUse::Default,
     {"coverage",
      "Accuses nothing. It counts what a run met: encounters of two AGVs by kind (drives no more than 10 s apart, by "
      "whole tracks), near misses below 0.3 m, and faults. It does not see AGVs that wait for each other without "
      "driving.",
      make_coverage_law}},
    {LawUse::Default,
     {"faults",
      "Accuses nothing. It notes when each injected fault struck which AGV, and each fallen load or obstacle that came "
      "onto the floor, so that a report can say what came before a failure. It does not see whether that was the "
      "cause. It also notes what the scenario asked for and did not get.",
      make_fault_record_law}},
    {LawUse::ToCompare,
     {"paper",
      "Finds what the published rule of Figure 5 finds, by axis-aligned perimeters of whole drives and, between two "
      "drives, snapshots (1 cm at the default 2.5 ms). It does not see turns, an AGV that rests for part of a drive, "
      "arrivals, or what happens between two snapshots.",
      make_paper_law}},
    {LawUse::ToCompare,
     {"global-step",
      "Finds what the baseline of the paper finds, by checks of every other body at every step of every drive (1 cm at "
      "the default 2.5 ms) with square-cornered perimeters. It does not see turns beside standing bodies, arrivals, or "
      "what happens between two steps.",
      make_global_step_law}},
};

// Those of one use. The judge is the first line, so that it is the first law of every set.
template <class Is>
consteval auto entries_of(Is is) {
  struct Counted {
    std::array<Entry<MakeLaw>, std::size(kLines)> entries{};
    std::size_t count = 0;
  } found;
  for (const LawLine& line : kLines) {
    if (is(line.use)) found.entries.at(found.count++) = line.entry;
  }
  return found;
}
constexpr auto kAll = entries_of([](LawUse) { return true; });
constexpr auto kDefault = entries_of([](LawUse use) { return use != LawUse::ToCompare; });
static_assert(kLines[0].use == LawUse::Judge && entries_of([](LawUse use) { return use == LawUse::Judge; }).count == 1,
              "the judge is the first law, and the only one");

}  // namespace

std::span<const Entry<MakeLaw>> laws() { return std::span(kAll.entries).first(kAll.count); }
std::span<const Entry<MakeLaw>> default_laws() { return std::span(kDefault.entries).first(kDefault.count); }
const Entry<MakeLaw>& judge_of_violations() { return laws().front(); }

bool is_to_compare_with(const Entry<MakeLaw>& law) { return find_entry(default_laws(), law.name) == nullptr; }

const Entry<MakeLaw>* find_law(std::string_view name) {
  return find_entry(laws(), name == "exact" ? judge_of_violations().name : name);
}

std::string why_not_left_out(std::string_view name) {
  const auto names = names_of(default_laws());
  if (name == judge_of_violations().name)
    return fmt::format("names \"{}\", the judge of violations; without it there is nothing to count", name);
  if (std::ranges::find(names, name) != names.end()) return {};
  return fmt::format("names \"{}\", which no campaign runs{}", name, name_hint(name, names));
}

std::vector<std::unique_ptr<Law>> make_default_laws(const Scenario& scenario, std::span<const std::string> left_out) {
  std::vector<std::unique_ptr<Law>> set;
  set.reserve(default_laws().size());
  for (const auto& entry : default_laws()) {
    if (std::ranges::find(left_out, entry.name) == left_out.end()) set.push_back(entry.make(scenario));
  }
  return set;
}

}  // namespace fleetproof
