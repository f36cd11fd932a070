#pragma once

#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// Contact is physics: the first touch of two bodies is predicted from their pieces. If the scenario says so, AGVs that
// touch stop for good, and the operator is called.
class Contacts {
 public:
  struct Ports {
    ActionsPort actions;
    OperatorActions& operator_actions;
  };
  Contacts(RunContext& run, const Ports& ports);

  // Sets an event for each touch that the body's current piece leads to.
  void predict(EntityId body);
  // Whether a touch of these two is predicted.
  bool foresees(EntityId one, EntityId other) const;
  // The event of the prediction with this number. Nothing happens if a body has another piece since.
  void bodies_touch(std::uint64_t prediction);

 private:
  bool is_current(const TouchPrediction& touch) const;
  void stop(EntityId body);

  RunContext& run_;
  Ports ports_;
  std::vector<TouchPrediction> predictions_;
};

}  // namespace fleetproof
