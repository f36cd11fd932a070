#include "reports/evidence/coverage.hpp"

#include <algorithm>
#include <utility>

#include "core/outcome/probe_names.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kPlaces = 64, kLookAhead = 8;

void note(Seen& seen, std::uint64_t times) {
  ++seen.runs;
  seen.times += times;
}

void move_all(Seen& from, Seen& to) {
  to.runs += from.runs;
  to.times += from.times;
  from = {};
}

}  // namespace

const Coverage::Place* Coverage::place_of(const ProbeCount& probe, std::size_t& next) {
  std::vector<Place>& list = places_.list;
  for (std::size_t i = next; i < std::min(list.size(), next + kLookAhead); ++i) {
    if (list[i].source == probe.source && *list[i].name == probe.name) return next = i + 1, &list[i];
  }
  const bool world = probe.source == ProbeSource::World;
  if (!world && is_world_probe(probe.name)) return nullptr;
  if (list.size() == kPlaces) places_.lose(), next = 0;
  const auto at = (world ? by_the_world_ : by_agents_).try_emplace(probe.name).first;
  const Place place{probe.source, &at->first, &at->second, world && is_encounter_probe(probe.name)};
  return &*list.insert(list.begin() + static_cast<std::ptrdiff_t>(next++), place);
}

void Coverage::add(const Outcome& outcome) {
  ++runs_;
  std::uint64_t encounters = 0;
  std::size_t next = 0;
  for (const ProbeCount& probe : outcome.probes) {
    const Place* const place = place_of(probe, next);
    if (place == nullptr) continue;
    note(*place->seen, probe.count);
    if (place->is_encounter) encounters += probe.count;
  }
  static const ProbeCount kEncounter{ProbeSource::World, std::string(kEncounterProbe), 1},
      kSafeMode{ProbeSource::World, std::string(kSafeModeProbe), 1};
  if (encounters > 0) note(*place_of(kEncounter, next)->seen, encounters);
  if (outcome.counters.safe_mode_ns > 0) note(*place_of(kSafeMode, next)->seen, 1);
}

void Coverage::add(const Coverage& other) {
  places_.all = false;
  runs_ += other.runs_;
  for (const auto& [mine, theirs] :
       {std::pair(&by_the_world_, &other.by_the_world_), std::pair(&by_agents_, &other.by_agents_)}) {
    for (const auto& [name, seen] : *theirs) {
      (*mine)[name].runs += seen.runs;
      (*mine)[name].times += seen.times;
    }
  }
}

// Replicates meet the same again and again: to find each name in `other` costs more than all else here.
void Coverage::empty_into(Coverage& other) {
  other.runs_ += std::exchange(runs_, 0);
  if (!places_.all) return empty_by_name(other);
  if (std::exchange(places_.into, &other) != &other) {
    for (Place& place : places_.list) place.total = nullptr;
  }
  for (Place& place : places_.list) {
    if (place.seen->runs == 0) continue;
    auto& theirs = place.source == ProbeSource::World ? other.by_the_world_ : other.by_agents_;
    if (place.total == nullptr) place.total = &theirs[*place.name];
    move_all(*place.seen, *place.total);
  }
}

void Coverage::empty_by_name(Coverage& other) {
  for (const auto& [mine, theirs] :
       {std::pair(&by_the_world_, &other.by_the_world_), std::pair(&by_agents_, &other.by_agents_)}) {
    for (auto& [name, seen] : *mine) {
      if (seen.runs > 0) move_all(seen, (*theirs)[name]);
    }
  }
  places_.all = true;  // nothing is counted
}

void Coverage::add(const QuietRuns& quiet) {
  runs_ += quiet.runs;
  places_.all = false;
  if (quiet.in_safe_mode == 0) return;
  Seen& seen = by_the_world_[std::string(kSafeModeProbe)];
  seen.runs += quiet.in_safe_mode;
  seen.times += quiet.in_safe_mode;
}

void Coverage::add(const std::vector<MetTotal>& met) {
  places_.all = false;
  for (const MetTotal& total : met) {
    const bool world = total.source == ProbeSource::World;
    if (!world && is_world_probe(total.name)) continue;
    Seen& seen = (world ? by_the_world_ : by_agents_)[total.name];
    seen.runs += total.runs;
    seen.times += total.times;
  }
}

Seen Coverage::seen(std::string_view probe) const {
  const auto& told = is_world_probe(probe) ? by_the_world_ : by_agents_;
  const auto found = told.find(probe);
  return found == told.end() ? Seen{} : found->second;
}

std::uint64_t runs_alone(const Coverage& coverage) { return coverage.runs() - coverage.seen(kEncounterProbe).runs; }

std::optional<std::uint64_t> runs_beyond_following(const Coverage& coverage) {
  if (coverage.seen(kEncounterProbe).runs == 0) return std::nullopt;
  std::uint64_t most = 0;
  for (const EncounterKind kind : kValuesOf<EncounterKind>) {
    if (kind != EncounterKind::Following) most = std::max(most, coverage.seen(name_of(kind)).runs);
  }
  return most;
}

std::vector<MissingProbe> missing_probes(const Coverage& coverage, const std::vector<std::string>& required) {
  std::vector<MissingProbe> missing;
  for (std::string name : required) {
    if (name.ends_with('?')) {
      if (!coverage.agents_declare_anything()) continue;
      name.pop_back();
    }
    const auto with = coverage.seen(name).runs;
    if (with == 0 || with * kRunsPerProbe < coverage.runs())
      missing.push_back({name, with, coverage.runs(), name == kEncounterProbe});
  }
  return missing;
}

}  // namespace fleetproof
