#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {

// The next lane of the quickest way to a station, asked for again at every station of the way. It is the lane with
// which the way of Routes::search begins, but most answers need no search:
// * One search from the goal backwards, at the first question, gives the time that remains from every station that can
//   lie on a quickest way. It looks towards the AGV first: landmarks bound the time to each station from below.
// * Only one lane of most stations leaves that time unchanged. If several do, a search forward along such lanes decides
//   as Routes::search does.
// Not for plants with rules. Requires: facts, map and routes outlive it.
class QuickestWay {
 public:
  QuickestWay(const fp_facts& facts, const MapView& map, const Routes& routes, std::uint32_t agv);

  // FP_NONE: there is no way. Requires: the stations differ.
  std::uint32_t next_lane(std::uint32_t from, std::uint32_t to);

 private:
  struct Open {
    double bound_s, so_far_s;
    std::uint32_t station;
  };
  // What the searches have found out about a station: the time that remains from it, by the search backward; the time
  // up to it and the lane by which the way arrives, by the search forward.
  struct Station {
    std::uint32_t number = FP_NONE;
    std::uint32_t arrival = FP_NONE;
    double remains_s = INFINITY, cost_s = INFINITY;
  };
  // The stations that the last searches have seen: few of a large map.
  class Known {
   public:
    explicit Known(std::uint32_t station_count) : places_(station_count) {}
    void clear();
    // Adds the station if it is not known. Valid until the next station is added.
    Station& at(std::uint32_t number) {
      std::uint32_t& place = places_[number];
      if (place == 0) {
        stations_.push_back({number});
        place = static_cast<std::uint32_t>(stations_.size());
      }
      return stations_[place - 1];
    }
    const Station* find(std::uint32_t number) const {  // null: it is not known
      return places_[number] == 0 ? nullptr : &stations_[places_[number] - 1];
    }
    void forget_costs();

   private:
    std::vector<std::uint32_t> places_;  // by station: in stations_, from 1 on; 0: not known
    std::vector<Station> stations_;
  };
  double remains_s(std::uint32_t station) const {
    const Station* known = known_.find(station);
    return known == nullptr ? INFINITY : known->remains_s;
  }
  void search_back(std::uint32_t from, std::uint32_t to);
  double least_s(std::uint32_t from, std::uint32_t station) const;
  std::uint32_t search_forward(std::uint32_t from, std::uint32_t to);
  // Whether a lane to a station, and what remains from there, is as quick as anything from the place where this much
  // remains.
  bool is_quick(double lane_s, std::uint32_t to, double remains_s) const;
  void push(Open open);
  Open pop();

  const MapView& map_;
  const Routes& routes_;
  std::span<const double> times_s_;              // by lane
  std::span<const double> landmarks_s_;          // by station: from each landmark, and to it
  std::uint32_t landmark_count_;                 // 0: the map is small
  std::uint32_t goal_ = FP_NONE, at_ = FP_NONE;  // of the last answer, and the station to which it leads
  Known known_;
  std::vector<Open> open_;  // heap, least bound first
};

}  // namespace fleetproof::agents
