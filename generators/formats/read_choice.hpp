#pragma once

#include <cstdint>
#include <string>

#include "core/base/words.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/antiparallel.hpp"

namespace fleetproof {

// Where points stand that a file draws elsewhere than in the plant. ByFile: where its curves fit.
enum class Positions : std::uint8_t { ByFile = 0, Plant = 1, Drawing = 2 };
constexpr const char* name_of(Positions positions) {
  switch (positions) {
    case Positions::ByFile:
      return "by-file";
    case Positions::Plant:
      return "plant";
    case Positions::Drawing:
      return "drawing";
  }
  return kNoWord;
}

// What the readers of all foreign formats can be told.
struct ReadChoice {
  TwinPaths twins = TwinPaths::Merge;
  PurposeWords purposes{};  // before those that a reader knows
  std::string level{};      // of LIF: the id or level of the layout to read; of RMF: the name of the level; empty: none
  Positions positions = Positions::ByFile;  // of openTCS
  bool takes_vehicles = false;              // the vehicles of the file are read, too, by another reader
};

}  // namespace fleetproof
