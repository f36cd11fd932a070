#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "campaign/findings/circumstances.hpp"
#include "campaign/findings/failure_needs.hpp"

namespace fleetproof {

// A failure as it is kept: the smallest case, and the world that it was cut from, which still draws. Software
// that sends one message more meets other draws in the world; the case has nothing for it but the messages it names.
struct KeptFailure {
  Scenario smallest{}, world{};
  std::string end{};  // as end_of has it
  // What its finding needs, and what the first neighbours need that fail with the same end, of the case and of the
  // worlds: each as FailureNeeds has it.
  std::vector<std::vector<std::string>> ways{};
  // What the smallest case also shows: what its bodies do ("one turns"), that it needs a third AGV, and words that tell
  // its failure from others.
  std::vector<std::string> doings{}, says{};
  // Of other failures of the finding.
  std::vector<Scenario> other_worlds{};
  // Failing runs of the finding as their campaign had them: with all that the worlds have lost, so that faults show
  // which have nothing to work with in the worlds.
  std::vector<Scenario> runs{};

  // `world` and the others, in turn.
  const Scenario& world_of(std::uint32_t number) const {
    const auto place = number % (other_worlds.size() + 1);
    return place == 0 ? world : other_worlds[place - 1];
  }
};

using Words = std::vector<std::string>;  // sorted, each once
Words all_of(const Words& a, const Words& b);

// Whether a failure is the kept one, as far as its needs and what it shows can tell; its end is not looked at.
bool is_one_of(const KeptFailure& kept, const FailureNeeds& found);
bool is_one_of(const std::vector<std::vector<std::string>>& ways, const std::vector<std::string>& needs);
// Whether it shows what the kept one does, beside its needs.
bool shows_the_same(const KeptFailure& kept, const FailureNeeds& found);

// So many are tried, and more if hardly any fails: until kEnoughAlike of the world do, or kMostKept were tried. With
// 40, software that fails half as often is told from the same software three times in four.
inline constexpr std::uint32_t kNeighbours = 1000, kMostKept = 8000;
inline constexpr std::size_t kEnoughAlike = 40;

// The scenarios beside a kept failure. Of its worlds: orders and faults up to 1 s later, other draws of radio, agents
// and motion. Every fourth is of the smallest case instead: orders and faults up to 1 s earlier or later, and one more
// message lost. In every second, the software thinks half to twice as long; where calls cost nothing, each costs up to
// 0.2 ms. In some, the fleet is numbered otherwise: a mend may help some AGVs of a fleet, and not the others.
class Neighbourhood {
 public:
  // Plays the smallest case, to learn which messages the software sends in it. `kept` outlives the object.
  Neighbourhood(CaseHost& host, const KeptFailure& kept);
  // Beside its runs instead, which there are: with other draws, as its worlds.
  static Neighbourhood of_runs(const KeptFailure& kept) { return Neighbourhood(kept); }
  Scenario at(std::uint32_t number) const;
  bool is_of_case(std::uint32_t number) const;
  // Which of its worlds, or runs, it is beside. Requires: it is not of the case.
  std::size_t world_of(std::uint32_t number) const;

 private:
  explicit Neighbourhood(const KeptFailure& kept) : kept_(kept), is_of_runs_(true) {}
  std::size_t first_agv_of(std::uint32_t number, std::size_t fleet) const;
  void lose_one_more(Scenario& scenario, double draw) const;

  const KeptFailure& kept_;
  bool is_of_runs_ = false;
  std::vector<GivenDelivery> messages_{};  // that arrive in the smallest case, before it fails
};

// Words and probes of some runs, each list sorted.
struct WordsSaid {
  Words always{};           // by the AGVs of each failure alike, and not by nearly every fleet that does not fail
  Words usually{};          // by the AGVs of each failure alike, but by these, too
  Words ever{};             // by any fleet
  std::size_t passing = 0;  // runs that do not fail at all
  std::map<std::string, std::size_t> by_passing{};  // how many of these say a word
};

// How the software fares there.
struct NeighbourCounts {
  std::size_t of = 0;                            // were simulated
  std::size_t alike = 0;                         // fail with the same end
  std::map<std::string, std::size_t> otherwise;  // by the end with which they fail
  // The first few of these, and the first few of them that are of the worlds.
  std::vector<std::uint32_t> first_alike{}, first_alike_of_world{};
  // Of them, those of the worlds: software with another timing meets them as before. None: not known.
  std::size_t of_world = 0, alike_of_world = 0;
  std::uint64_t driven_m = 0;            // by the fleets of all of them; 0: not known
  std::uint64_t driven_elsewhere_m = 0;  // as driven_elsewhere_m has it; 0: not known
  WordsSaid said{};
  // Of each world, the first failures that end alike, and how they come about.
  std::vector<std::vector<std::uint32_t>> looked_at{};
  std::vector<Circumstances> circumstances{};
};
// On all workers; the same for any number.
NeighbourCounts try_neighbours(CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood,
                               std::uint32_t count);

// As many as it takes that some fail.
NeighbourCounts try_enough_neighbours(CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood);

// What the neighbours need that have these numbers.
std::vector<FailureNeeds> needs_of_neighbours(CaseHost& host, const Neighbourhood& neighbourhood,
                                              std::span<const std::uint32_t> numbers);

}  // namespace fleetproof
