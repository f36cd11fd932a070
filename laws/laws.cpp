#include "laws/laws.hpp"

#include <fmt/format.h>

#include <algorithm>

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

constexpr Entry<MakeLaw> kLaws[] = {
    {"safety-distance",
     "Finds every stretch of time in which an AGV is closer than the safety distance to another body, exact to the "
     "microsecond and the micrometre. It does not see dips of less than 1 micrometre, and may join stretches less than "
     "0.1 s apart.",
     make_safety_distance_law},
    {"battery",
     "Finds every AGV whose battery runs empty away from a charging station, exact to the nanosecond. It does not see "
     "what the world does not record.",
     make_battery_law},
    {"containment",
     "Finds every load that two AGVs hold, that vanishes, lies at a station its transport does not name, is taken by a "
     "loaded AGV, moves without an AGV, or is delivered twice, exact to the nanosecond. It does not see a load that "
     "moves without a record.",
     make_containment_law},
    {"progress",
     "Finds deadlocks (with the AGV for which each AGV waits), livelocks and starving AGVs. It looks every twelfth of "
     "stuck_after for AGVs that have open transports and make no progress. It does not see why. On a long way it "
     "accuses a "
     "livelock later.",
     make_progress_law},
    {"normal-operation",
     "Finds safe mode and standstill while the radio keeps its contract, judged every second by the last 10 s of every "
     "link, and too little throughput if a floor is set. It does not see safe mode that no agent declares.",
     make_normal_operation_law},
    {"congestion",
     "Finds seconds in which the fleet uses half of the radio channel or more, or loses a tenth of its receptions by "
     "interference. It counts the whole floor as one channel and does not see messages that are only late.",
     make_congestion_law},
    {"coverage",
     "Accuses nothing. It counts what a run met: encounters of two AGVs by kind (drives no more than 10 s apart, by "
     "whole tracks), near misses below 0.3 m, and faults. It does not see AGVs that wait for each other without "
     "driving.",
     make_coverage_law},
    {"faults",
     "Accuses nothing. It notes when each injected fault struck which AGV, and each fallen load or obstacle that came "
     "onto the floor, so that a report can say what came before a failure. It does not see whether that was the cause.",
     make_fault_record_law},
    {"paper",
     "Finds what the published rule of Figure 5 finds, by axis-aligned perimeters of whole drives and, between two "
     "drives, snapshots (1 cm at the default 2.5 ms). It does not see turns, an AGV that rests for part of a drive, "
     "arrivals, or what happens between two snapshots.",
     make_paper_law},
    {"global-step",
     "Finds what the baseline of the paper finds, by checks of every other body at every step of every drive (1 cm at "
     "the default 2.5 ms) with square-cornered perimeters. It does not see turns beside standing bodies, arrivals, or "
     "what happens between two steps.",
     make_global_step_law},
};

constexpr std::size_t kToCompareWith = 2;  // the last entries of the table

}  // namespace

std::span<const Entry<MakeLaw>> laws() { return kLaws; }
std::span<const Entry<MakeLaw>> default_laws() { return laws().first(std::size(kLaws) - kToCompareWith); }

bool is_to_compare_with(const Entry<MakeLaw>& law) { return &law >= default_laws().data() + default_laws().size(); }

const Entry<MakeLaw>* find_law(std::string_view name) {
  return find_entry(laws(), name == "exact" ? "safety-distance" : name);
}

std::string why_not_left_out(std::string_view name) {
  const auto names = names_of(default_laws());
  if (name == names.front())
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
