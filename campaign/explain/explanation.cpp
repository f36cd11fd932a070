#include "campaign/explain/explanation.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"

namespace fleetproof {
namespace {

// A run that ends with its failure would not show a failure that comes a little later.
constexpr Duration kLonger = std::chrono::seconds(30);

// The smallest case with time for the failure to come later. If it fails otherwise then, the case as it is.
FailingCase with_more_time(CaseHost& host, const FailingCase& small, const FailingCase& original,
                           const FailurePattern& pattern) {
  FailingCase longer = small;
  longer.scenario.horizon = std::min(small.scenario.horizon + kLonger, original.scenario.horizon);
  const auto failure = pattern.match(host(longer.scenario));
  if (!failure) return small;
  longer.failure = *failure;
  return longer;
}

// Of the AGVs of the failure that were on no drive then.
std::vector<Departure> past_drives(const CaseRun& run, const Failure& failure) {
  const auto on_drives = failed_drives(run, failure);
  std::vector<Departure> found;
  for (const EntityId body : {failure.a, failure.b}) {
    if (!body.valid() || std::ranges::count(on_drives, body, &Departure::agv) > 0) continue;
    const Departure* last = last_departure(run.itinerary.departures, body, failure.at);
    if (last != nullptr) found.push_back(*last);
  }
  return found;
}

// Asks one question after the other until the time is over.
class Asking {
 public:
  Asking(std::vector<std::string>& not_tried, const OnQuestion& on_question)
      : not_tried_(not_tried), on_question_(on_question) {}

  void ask(const std::string& question, const std::function<void()>& find) {
    if (!not_tried_.empty()) return not_tried_.push_back(question);
    on_question_(question);
    try {
      find();
    } catch (const GivenUp&) {
      not_tried_.push_back(question + " (begun, not finished)");
    }
  }

 private:
  std::vector<std::string>& not_tried_;
  const OnQuestion& on_question_;
};

void look_at_small_case(CaseHost& host, Explanation& found) {
  CaseRun run = host(found.small.scenario, Deliveries::Kept);
  found.past_drives = past_drives(run, found.small.failure);
  found.notes = std::move(run.notes);
  found.doing = std::move(run.doing);
  found.ended = std::move(run.outcome.message);
  CaseRun undisturbed = host(with_deliveries_only(found.small.scenario, {}));
  if (!failure_of(undisturbed)) found.undisturbed_words = std::move(undisturbed.all_words);
}

}  // namespace

Explanation explain(CaseHost& host, const FailingCase& original, const ShrinkResult& small,
                    const FailurePattern& pattern, const OnQuestion& on_question) {
  Explanation found;
  found.original = original;
  found.pattern = pattern;
  found.small = small.best;
  found.is_smallest = !small.ended;
  found.has_notes = false;
  Asking asking(found.not_tried, on_question);
  asking.ask("what the AGVs did, said and knew", [&] {
    found.small = with_more_time(host, small.best, original, pattern);
    look_at_small_case(host, found);
    found.has_notes = true;
  });
  asking.ask("which messages it needs", [&] { add_message_needs(host, found.small, pattern, found.messages); });
  asking.ask("which AGVs, orders, faults and obstacles it needs",
             [&] { found.things = without_each_thing(host, found.small, pattern); });
  // A fleet that stalls has nothing to brake for.
  if (found.small.failure.is_violation)
    asking.ask("until when braking avoids it", [&] { add_last_stops(host, found.small, pattern, found.stops); });
  asking.ask("what let the AGVs set off", [&] { add_set_offs(host, found.small, pattern, found.set_offs); });
  asking.ask("how often the run fails with other draws",
             [&] { add_shares(host, original, found.small, pattern, found.shares); });
  asking.ask("from when on it was certain", [&] { found.no_return = curve_of_no_return(host, original, pattern); });
  return found;
}

std::vector<const Claim*> claims_of(const Explanation& explanation) {
  std::vector<const Claim*> claims;
  const auto add = [&](const std::vector<Claim>& more) {
    for (const Claim& claim : more) claims.push_back(&claim);
  };
  for (const MessageNeed& need : explanation.messages) add(need.claims);
  add(explanation.things);
  for (const LastStop& stop : explanation.stops) add(stop.claims);
  for (const SetOff& set_off : explanation.set_offs) {
    for (const Leave& leave : set_off.leaves) {
      add(leave.claims);
      if (leave.without_others) claims.push_back(&*leave.without_others);
      for (const GoAhead& key : leave.keys) claims.push_back(&key.claim);
    }
  }
  return claims;
}

}  // namespace fleetproof
