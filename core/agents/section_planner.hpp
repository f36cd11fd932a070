#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/lane_prices.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"
#include "core/agents/routes.hpp"
#include "core/agents/waiting_places.hpp"

namespace fleetproof::agents {

// One controller call: drives a lane, or picks, drops or charges where the AGV stands. Inherited: the action that the
// agent began before its restart.
struct Leg {
  enum class Kind : std::uint8_t { Drive, Pick, Drop, Charge, Inherited };
  Kind kind = Kind::Drive;
  std::uint32_t lane = FP_NONE;
  std::uint32_t order = FP_NONE;  // Pick, Drop: whose load
  friend bool operator==(const Leg&, const Leg&) = default;
};
constexpr const char* name_of(Leg::Kind kind) {
  switch (kind) {
    case Leg::Kind::Drive:
      return "driving";
    case Leg::Kind::Pick:
      return "picking";
    case Leg::Kind::Drop:
      return "dropping";
    case Leg::Kind::Charge:
      return "connecting to a charger";
    case Leg::Kind::Inherited:
      return "finishing what its former self began";
  }
  return "?";
}

// A station to go to, and what to do there.
struct Goal {
  std::uint32_t station = FP_NONE;
  Leg::Kind transfer = Leg::Kind::Pick;
  std::uint32_t order = FP_NONE;
  friend bool operator==(const Goal&, const Goal&) = default;
};

// Whether an AGV with these goals ahead carries a load: the next load that it transfers is put down.
bool carries_load(std::span<const Goal> goals);

// What is locked at once: a path, and the legs that drive it. The transfers on the path are legs too.
struct Section {
  Path path;
  std::vector<Leg> legs;
  std::uint32_t goals = 0;            // the number of goals that the section reaches
  std::vector<std::uint32_t> onward;  // the lanes that the AGV means to drive afterwards
  bool empty() const { return path.empty(); }
};

// Leaves the first lane, and the transfers before it.
void cut_after_first_lane(Section& section);

// How far a section may reach. Lanes that are already held count.
struct Budget {
  double length_m = 0.0;
  std::uint32_t lanes = 0;
  friend bool operator==(const Budget&, const Budget&) = default;
};

// Chooses the next section. A section ends at a safe waiting place, so that no AGV blocks the AGV for which it waits.
// It is long enough to be worth its messages, and it ends before the floor that other AGVs are known to hold. Knowledge
// about other AGVs may be old: a bad choice costs time, never safety.
class SectionPlanner {
 public:
  using GoesFirst = std::function<bool(std::uint32_t agv, const Neighbour&)>;

  // `vehicle_type`: of the own AGV, by which the plant permits lanes.
  SectionPlanner(const MapView& map, HullGeometry& geometry, Neighbours& neighbours, std::uint32_t vehicle_type,
                 const ProgressOptions& options = {});

  WaitingPlaces& places() { return places_; }

  // A section from `standing` towards the goals. Empty if there is no way to the first goal.
  Section towards(const Path& standing, Budget budget, std::span<const Goal> goals);
  // What the AGV announces of its way beyond the section: the lanes to its next goals. Requires: the section is what
  // `towards` returned last, and nothing was planned since.
  std::vector<std::uint32_t> way_on_from(const Section& section, std::span<const Goal> goals);
  // A section to a place where the AGV blocks no other AGV, as far as is known. Empty if there is none. `draw` in [0,
  // 1) varies the choice. The place keeps clear of the requests of all AGVs that go first, and the way keeps clear of
  // these AGVs while they wait. If there is no such way, it may lead through other waiting AGVs: they make way in turn.
  Section out_of_the_way(const Path& standing, Budget budget, bool loaded, bool prefer_parking, double draw,
                         const GoesFirst& goes_first);
  // The charging station that is quickest to reach and at which no other AGV is known to be; if possible one at which
  // this AGV blocks no other AGV. If it is `urgent` and there is none, any that can be reached: an AGV that is charged
  // enough makes room. FP_NONE if there is none.
  std::uint32_t free_charger(const Path& standing, bool loaded, bool urgent);

 private:
  struct Walk;
  // What the last section towards goals followed from.
  struct Question {
    Path standing;
    Budget budget;
    std::vector<Goal> goals;
    std::uint64_t changes = 0;  // of the neighbours
  };
  // An AGV that holds floor which a walk may reach, not before this length.
  struct Reachable {
    std::uint32_t agv;
    const Neighbour* neighbour;
    double after_m;
  };

  bool is_asked_again(const Path& standing, Budget budget, std::span<const Goal> goals) const;
  Section find_section(const Path& standing, Budget budget, std::span<const Goal> goals);
  // From there to a goal, at the costs of the lanes.
  void search(const Path& from, std::uint32_t goal);
  std::uint32_t end_of_search(std::uint32_t goal) const;
  void price_lanes(bool loaded, double waiting_s, double idle_s, const GoesFirst& goes_first);
  std::uint32_t best_place(const Path& standing, bool prefer_parking, double draw, const GoesFirst& goes_first);
  double price_of_staying(std::uint32_t station, double limit_s, const GoesFirst& goes_first);
  bool may_turn_back(std::uint32_t station) const;
  bool leads_on(std::uint32_t station) const;
  bool leads_back(std::uint32_t station) const;
  bool is_cramped(std::uint32_t station, std::uint32_t agv, const Neighbour& n);
  bool is_taken(std::uint32_t station);
  bool follow(Walk& walk, std::uint32_t to);

  const MapView& map_;
  HullGeometry& geometry_;
  Neighbours& neighbours_;
  std::vector<Reachable> reachable_;  // by the present walk
  WaitingPlaces places_;
  DriveRules rules_;
  Routes routes_;
  std::span<const double> lane_times_s_;  // by lane
  LanePrices prices_;
  std::optional<Question> last_asked_;  // none if lanes have had other prices since: way_on_from() needs those
  Section last_answer_;
  std::uint32_t model_;         // of the own AGV
  bool knows_remaining_costs_;  // the usual costs are those of remaining_costs_s()
};

}  // namespace fleetproof::agents
