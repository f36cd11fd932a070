#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// The first of two spellings that the object has. LIF 1.0 says vehicleType, its successor says mobileRobotType.
std::optional<JsonReader> either(const JsonReader& object, std::string_view old_key, std::string_view new_key);

// The word that a rule gives for the key, or `usual`. Throws InputError if it is none of `words`.
std::string word_of(const JsonReader& rule, std::string_view key, std::span<const std::string_view> words,
                    std::string_view usual);

// What a node or edge of LIF says for each type of vehicle; empty if it says nothing.
std::vector<JsonReader> rules_by_type(const JsonReader& element);

// The types for which one of these rules holds. An empty name: every type. The successor of LIF 1.0 lists types by
// manufacturer and series, of which "MANUFACTURER.SERIES" is made, as LIF 1.0 suggests for its identifiers.
std::vector<std::string> types_of(const JsonReader& rule);

// Who may drive the edges of a LIF layout, and with which loads. A type needs a rule at the edge and at both of its
// nodes, each of which may restrict its loads; a node or edge without any rule is for every type.
class LifTypes {
 public:
  // Throws InputError if the name of a type is no valid name.
  LifTypes(const std::vector<JsonReader>& nodes, const std::vector<JsonReader>& edges);

  // As a segment has it: empty if every type that the layout names may drive it, with a load and without one. None: no
  // AGV may.
  std::optional<std::vector<Permission>> permissions(const JsonReader& edge, const JsonReader& from,
                                                     const JsonReader& to) const;
  // An edge that became a segment with these permissions.
  void count(const std::vector<Permission>& permissions);

  // What happens to the names of types, as a sentence; empty if the layout names none.
  std::string sentence() const;
  // The same about nodes and edges without any rule, where others have rules; with two rules for one type; and with a
  // rule that names no type.
  std::vector<std::string> odd_rules() const;

 private:
  void note(const JsonReader& element, const char* id);

  std::vector<std::string> names_;  // in the order of the file
  std::size_t edges_ = 0, restricted_ = 0;
  std::size_t open_ = 0, empty_ = 0;           // nodes and edges without any rule; with an empty list of rules
  std::vector<std::string> twice_, nameless_;  // nodes and edges with two rules for one type; with one for none
};

}  // namespace fleetproof
