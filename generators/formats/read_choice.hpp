#pragma once

#include <string>

#include "generators/formats/purpose_words.hpp"
#include "generators/map/antiparallel.hpp"

namespace fleetproof {

// What the readers of all foreign formats can be told.
struct ReadChoice {
  TwinPaths twins = TwinPaths::Merge;
  PurposeWords purposes{};  // before those that a reader knows
  std::string level{};      // of LIF: the id or level of the layout to read; of RMF: the name of the level; empty: none
};

}  // namespace fleetproof
