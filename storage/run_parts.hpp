#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/outcome/outcome.hpp"

namespace fleetproof {

class Row;

// A table that holds parts of runs, by run and ordinal.
struct PartTable {
  const char* name;
  std::string (*values)(std::int32_t schema);  // its columns, to be read from a file of this schema
  // Parts of the run that the outcome held before are overwritten: their memory is used again.
  void (*take)(const Row& row, Outcome& outcome, std::size_t ordinal);
  void (*cut)(Outcome& outcome, std::size_t count);  // leaves out what another run has
};

const std::array<PartTable, 3>& part_tables();

}  // namespace fleetproof
