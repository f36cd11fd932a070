#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Lets every type of vehicle drive what one of them may. What a segment asks of loads stays, unless one type may drive
// it with a load and one without. Returns the names of the segments that it changed.
std::vector<std::string> lift_types(Layout& layout);

// A permission for a vehicle type that the fleet does not have.
struct ForeignType {
  std::size_t segment = 0, permission = 0;  // where the layout names it first
  std::string name{};
  std::string meant{};  // a type of the fleet that no permission names, if it is spelled nearly alike; else empty
};

// By name, in the order of the layout. `fleet`: the names of its vehicle types.
std::vector<ForeignType> foreign_types(const Layout& layout, std::span<const std::string> fleet);

// `segment "a-b" is for vehicle type "tuger", which this fleet does not have ("tugger"); did you mean "tugger"?`
std::string sentence_on(const ForeignType& type, const Layout& layout, std::span<const std::string> fleet);

// What to add to an error about a way that a fleet has not: `; permissions name "tuger", which this fleet does not have
// ("pallet-agv")`. Empty if the fleet has all types.
std::string foreign_types_hint(const Layout& layout, std::span<const std::string> fleet);

}  // namespace fleetproof
