#pragma once

#include <string>
#include <vector>

#include "core/base/json_text.hpp"
#include "reports/page/page.hpp"

namespace fleetproof {

// A field of the plan with a value that makes it easier to pass than the usual one.
struct LenientCondition {
  std::string field;  // "law.reaction_s"; of gates that the campaign does not write, with a word that says so
  std::string value;  // as a file gives it, with the unit; of several values, the ones that are easier
  std::string usual;  // empty: a plan has none of it unless it says so
};

// Those of a campaign, the heaviest first. Reports cannot read plans: a caller adds them.
struct LenientConditions {
  std::vector<LenientCondition> list;
  std::string floor;    // a sentence on a floor of throughput that the campaign does not name; empty: it names one
  std::string trouble;  // why they are not known
};

// At the head: the eight heaviest, and how many more there are. Empty if there is none.
std::vector<Headline> lenient_headlines(const LenientConditions& conditions);

Json waived_json(const LenientConditions& waived);

// "stuck_after_s = 1000000 s (usual: 120 s)".
std::string lenient_text(const LenientCondition& condition);

}  // namespace fleetproof
