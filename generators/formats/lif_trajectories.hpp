#pragma once

#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// Reads how the edges of a LIF layout are drawn.
class LifTrajectories {
 public:
  // Draws the segment, which leads from `from_m` to `to_m`, as the first of these rules says that has a trajectory.
  // Throws InputError if a trajectory is no NURBS curve, or begins or ends far beside its node (kFarBeside_m).
  void bend(const std::vector<JsonReader>& rules, const Vec2& from_m, const Vec2& to_m, Segment& segment);

  // Adds what was guessed or changed, one sentence for each kind of thing.
  void tell(std::vector<std::string>& warnings) const;

 private:
  struct Changed {
    std::string place;               // of the first
    std::vector<std::string> edges;  // names
    double most = 0.0;               // m or rad

    void add(const JsonReader& at, const std::string& edge, double much = 0.0);
  };
  Changed drawn_by_type_, turned_, rounded_, replaced_, beside_, aligned_;
};

}  // namespace fleetproof
