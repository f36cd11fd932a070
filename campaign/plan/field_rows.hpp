#pragma once

#include <string>
#include <vector>

namespace fleetproof {

// One line of the tables of keys that users read: `fleetproof list fields` and campaign/fields.md.
struct FieldRow {
  std::string file;      // "campaign" or "scenario"
  std::string key;       // "law.reaction_s"; items of a list are "agvs[].battery"
  std::string fallback;  // the default as a file would give it; empty: there is none, or it is empty
  std::string expected;  // bounds, or words, with the unit
  std::string unit;      // "m/s"; empty for shares, counts and words
  std::string named;     // which values are named at the head of a report, as "below 0.2"; or why none is
  std::string text;      // one line of explanation
};

// All fields of campaign files and of scenario files, in the order of the files.
std::vector<FieldRow> field_rows();

}  // namespace fleetproof
