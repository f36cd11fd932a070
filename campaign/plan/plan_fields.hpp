#pragma once

#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/worlds/drawn_faults.hpp"
#include "generators/worlds/drawn_sources.hpp"

namespace fleetproof {

// A number of a plan's table: its key in campaign files and plan texts, where it is kept, and what it may be. Reading,
// writing and checking all go over these lists, so that no number can be missing from one of them.
struct NumberField {
  const char* key;
  double* value;
  double least, most;
};

std::vector<NumberField> number_fields(VehicleType& vehicle);
std::vector<NumberField> number_fields(FaultRates& rates);
std::vector<NumberField> number_fields(ScannerSetup& scanner);
std::vector<NumberField> number_fields(OperatorSetup& help);
std::vector<NumberField> number_fields(DrawnSources& sources);  // of the table `radio`

}  // namespace fleetproof
