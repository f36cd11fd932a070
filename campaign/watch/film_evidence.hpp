#pragma once

#include <span>
#include <string>
#include <vector>

#include "campaign/watch/film_clearances.hpp"
#include "core/scenario/scenario.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// "2 messages (1 lost, 1 delivered twice)"; empty: the scenario decides no delivery.
std::string given_deliveries_text(std::span<const GivenDelivery> deliveries);

// "(30.53, 0.00) m", without a minus before a zero.
std::string place_text(const Vec2& place_m);

// What speaks for the cause of a failure, each in a sentence: what the bodies did, what their agents believed and said
// to each other, which faults struck them before. An empty sentence or list: there is nothing to say.
class FilmEvidence {
 public:
  // Requires: film, scenario and bodies outlive the object.
  FilmEvidence(const web::Film& film, const Scenario& scenario, const PiecesOfBodies& bodies)
      : film_(film), scenario_(scenario), bodies_(bodies) {}

  std::string doing(EntityId body, SimTime at) const;
  // Where the agent of `agv` took `other` to be.
  std::vector<std::string> belief(EntityId agv, EntityId other, SimTime at) const;
  // That the two sent each other nothing, if it is so.
  std::vector<std::string> messages(EntityId one, EntityId other, SimTime at) const;
  // What each computer of the scenario had said to it.
  std::vector<std::string> from_computers(EntityId agv, SimTime at) const;
  std::string faults(const std::vector<std::size_t>& bodies, SimTime at) const;

 private:
  std::string name(EntityId id) const;
  std::string named_place(const Vec2& place_m) const;
  bool is_agv(EntityId id) const { return id.index() < scenario_.agvs.size(); }

  const web::Film& film_;
  const Scenario& scenario_;
  const PiecesOfBodies& bodies_;
};

}  // namespace fleetproof
