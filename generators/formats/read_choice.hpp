#pragma once

#include "generators/formats/purpose_words.hpp"
#include "generators/map/antiparallel.hpp"

namespace fleetproof {

// What the readers of all foreign formats can be told.
struct ReadChoice {
  TwinPaths twins = TwinPaths::Merge;
  PurposeWords purposes{};  // before those that a reader knows
};

}  // namespace fleetproof
