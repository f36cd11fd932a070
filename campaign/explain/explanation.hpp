#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "campaign/explain/last_stop.hpp"
#include "campaign/explain/necessity.hpp"
#include "campaign/explain/no_return.hpp"
#include "campaign/explain/set_offs.hpp"
#include "campaign/explain/shares.hpp"
#include "campaign/shrink/shrink.hpp"

namespace fleetproof {

// Why a run fails. All that is said of single messages, things, stops and drives is about `small`, the smallest case
// that fails in the same way; shares and the curve are about the run itself.
struct Explanation {
  FailingCase original, small;
  FailurePattern pattern;
  std::vector<MessageNeed> messages;
  std::vector<Claim> things;
  std::vector<LastStop> stops;
  std::vector<SetOff> set_offs;
  std::vector<Departure> past_drives;  // of those AGVs of the failure that were on no drive: the last before it
  CaseNotes notes;                     // of the smallest case
  bool has_notes = true;               // false: there was no time for them
  std::vector<std::string> doing;      // what its AGVs did when it failed, as CaseRun has it
  std::vector<std::string> shapes;     // what in the shapes of its bodies broke the distance, as shape_sentences has it
  std::string ended;                   // of a crash or a hang: what the engine says of it, after the name of the agent
  // All words of its agents on a perfect radio, sorted; none if it fails there, too.
  std::vector<std::string> undisturbed_words;
  std::vector<Share> shares;
  NoReturn no_return;
  bool is_smallest = true;             // the search for the smallest case ended by itself
  std::vector<std::string> not_tried;  // questions for which there was no time: "which messages it needs"
};

// Hears of each question before it is asked.
using OnQuestion = std::function<void(std::string_view question)>;

// Requires: both fail in the way of the pattern, and the result of the search is `small`. If the time of the host is
// over, the explanation has what was found until then, and names what was not tried.
Explanation explain(
    CaseHost& host, const FailingCase& original, const ShrinkResult& small, const FailurePattern& pattern,
    const OnQuestion& on_question = [](std::string_view) {});

// The runs that show what is said of single messages, things, stops and drives, in this order.
std::vector<const Claim*> claims_of(const Explanation& explanation);

}  // namespace fleetproof
