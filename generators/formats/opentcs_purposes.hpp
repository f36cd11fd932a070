#pragma once

#include <string>
#include <vector>

#include "generators/formats/purpose_words.hpp"

namespace fleetproof {

// What a plant model says about a type of locations, in words that its author chose.
struct LocationWords {
  std::string name;
  std::vector<std::string> operations;  // "LOAD", "Unload cargo", "CHARGE", "NOP"
  std::string symbol;                   // "LOAD_TRANSFER_GENERIC"
};

// What locations of a type are for.
struct LocationPurpose {
  Purposes purposes;                // routing alone: nothing that is known here
  const char* source = nullptr;     // "user", "operations", "name" or "symbol"; null: none of them says anything
  const char* overruled = nullptr;  // "name" or "symbol", if it says something else than the operations
};

// Whether an operation says anything.
bool says_purpose(const std::string& operation, const PurposeWords& own);

// The first source that says something decides: a word of the user for name or symbol, the operations, the name, the
// symbol. A word of the user for an operation stands for what that operation says itself. `own` are the words of the
// user; they have to be the whole name, operation or symbol. Other words only have to occur: "load" in "Unload cargo".
LocationPurpose purpose_of(const LocationWords& words, const PurposeWords& own);

inline constexpr const char* kNothingAllowed = "no operation";

// The same of a link to a location, which may allow some operations of the type only. If the type tells by its
// operations what it is for, name and symbol say nothing of a link that allows others: the source is kNothingAllowed.
LocationPurpose purpose_of_link(const LocationWords& type, const LocationWords& link, const PurposeWords& own);

}  // namespace fleetproof
