#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/outcome/outcome.hpp"
#include "storage/folded_rows.hpp"

namespace fleetproof {

// The number of runs that met something, and how often it was met in total.
struct Seen {
  std::uint64_t runs = 0, times = 0;
};

// What a set of runs met.
//
// The world's probes are listed in core/outcome/probe_names.hpp; "encounter" and "safe-mode" are derived here from the
// others and from a counter. All other names are declared by agents. If an agent declares a name of the world, the
// declaration is ignored.
class Coverage {
 public:
  void add(const Outcome& outcome);
  void add(const Coverage& other);
  // Adds all to `other` and counts from zero again. Keeps its names: the next replicate meets the same. Requires: if it
  // was emptied into `other` before, the names of `other` are where they were (it was not copied to or moved).
  void empty_into(Coverage& other);
  // Without what they met, which follows apart.
  void add(const QuietRuns& quiet);
  // What runs met that were added already, but without their probes: they were folded.
  void add(const std::vector<MetTotal>& met);

  std::uint64_t runs() const { return runs_; }
  bool agents_declare_anything() const { return !by_agents_.empty(); }
  Seen seen(std::string_view probe) const;
  const std::map<std::string, Seen, std::less<>>& by_the_world() const { return by_the_world_; }
  const std::map<std::string, Seen, std::less<>>& by_agents() const { return by_agents_; }

 private:
  // Where a probe of the world or of agents is counted. Runs meet much the same probes in much the same order, so the
  // place after the last one is most often the next one.
  struct Place {
    ProbeSource source = ProbeSource::World;
    const std::string* name = nullptr;
    Seen* seen = nullptr;
    bool is_encounter = false;
    Seen* total = nullptr;  // where `empty_into` adds it; null: not found yet
  };
  // They lie in the maps of one object. A copy begins without them.
  struct Places {
    Places() = default;
    Places(const Places&) { lose(); }
    Places(Places&& other) noexcept { lose(), other.lose(); }
    Places& operator=(const Places&) { return lose(), *this; }
    Places& operator=(Places&& other) noexcept { return lose(), other.lose(), *this; }
    ~Places() = default;

    void lose() { list.clear(), all = false; }

    std::vector<Place> list;
    bool all = true;                 // whatever was counted has a place
    const Coverage* into = nullptr;  // to which the totals belong
  };
  void empty_by_name(Coverage& other);
  // None: an agent declares a name of the world.
  const Place* place_of(const ProbeCount& probe, std::size_t& next);

  std::uint64_t runs_ = 0;
  std::map<std::string, Seen, std::less<>> by_the_world_, by_agents_;
  Places places_;
};

// A required probe that no run met, or too few runs.
struct MissingProbe {
  std::string name;
  std::uint64_t runs_with = 0, runs = 0;
  bool is_encounter = false;  // any encounter: the drives of two AGVs
};

// A probe that fewer than one of this many runs met is too rare to have tested anything. A probe that was never met is
// missing, also if there are only few runs.
inline constexpr std::uint64_t kRunsPerProbe = 20'000;

// The runs in which no two AGVs met.
std::uint64_t runs_alone(const Coverage& coverage);

// The runs that met the most frequent of head-on, crossing and merging: what an encounter is besides one AGV behind
// another. Empty: no run had an encounter.
std::optional<std::uint64_t> runs_beyond_following(const Coverage& coverage);

// Required of agents on board that declare any probe; central fleets (Evidence::computers_of) need not meet it.
inline constexpr std::string_view kNegotiationOnBoard = "negotiation?";

// A required name that ends in "?" is required only of agents that declare any probe.
std::vector<MissingProbe> missing_probes(const Coverage& coverage, const std::vector<std::string>& required);

// Incidents of one kind over many runs.
struct IncidentTally {
  std::uint64_t runs = 0, incidents = 0;
  std::uint64_t example_run = 0;  // the first run with such an incident
};

}  // namespace fleetproof
