#include "campaign/explain/shares.hpp"

#include <fmt/format.h>

#include <functional>
#include <set>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/fitness.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/surgery.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {
namespace {

constexpr const char* kNoFault = "no fault strikes";

struct WorldChange {
  std::string what;
  std::function<void(Scenario&)> edit;
  // Which deliveries that a case gives would be other ones; none: the change is not about the radio.
  std::function<bool(const GivenDelivery&)> spares{};
};

void scale_speeds(Scenario& scenario, double factor) {
  for (VehicleType& type : scenario.vehicle_types) {
    type.drive.speed_mps *= factor;
    type.reverse_speed_mps *= factor;
  }
}

void add_radio(std::vector<WorldChange>& changes, const RadioSetup& radio) {
  if (radio.loss > 0.0)
    changes.push_back({"no message is lost by chance", [](Scenario& s) { s.radio.loss = 0.0; }, &GivenDelivery::lost});
  if (radio.delay_s > 0.0)
    changes.push_back(
        {"no message is late", [](Scenario& s) { s.radio.delay_s = 0.0; },
         [](const GivenDelivery& delivery) { return !delivery.lost && delivery.delay > Duration::zero(); }});
  if (radio.duplicates > 0.0)
    changes.push_back(
        {"no message arrives twice", [](Scenario& s) { s.radio.duplicates = 0.0; }, &GivenDelivery::copied});
  changes.push_back({"the radio is perfect", [](Scenario& s) { s.radio = perfect(s.radio); },
                     [](const GivenDelivery&) { return true; }});
}

std::vector<WorldChange> changes_of(const Scenario& scenario) {
  std::vector<WorldChange> changes{{"as it is", [](Scenario&) {}}};
  add_radio(changes, scenario.radio);
  if (!scenario.faults.empty()) changes.push_back({kNoFault, [](Scenario& s) { s.faults.clear(); }});
  if (!scenario.obstacles.empty())
    changes.push_back({"there are no obstacles", [](Scenario& s) { s.obstacles.clear(); }});
  changes.push_back({"speeds are a tenth lower", [](Scenario& s) { scale_speeds(s, 0.9); }});
  changes.push_back({"loads change no body and no speed", [](Scenario& s) {
                       for (VehicleType& type : s.vehicle_types) type.loaded = {};
                     }});
  changes.push_back({"all batteries are full", [](Scenario& s) {
                       for (AgvSetup& agv : s.agvs) agv.battery = 1.0;
                     }});
  changes.push_back({"clocks and positions are right", [](Scenario& s) {
                       for (AgvSetup& agv : s.agvs) agv.sensing = {};
                     }});
  return changes;
}

// Where a change changes nothing, its share would say nothing.
bool changes_it(const WorldChange& change, const Scenario& scenario) {
  Scenario changed = scenario;
  change.edit(changed);
  return scenario_digest(changed) != scenario_digest(scenario);
}

bool fails_with(CaseHost& host, const FailingCase& small, const WorldChange& change, const FailurePattern& pattern) {
  Scenario changed = small.scenario;
  change.edit(changed);
  if (change.spares) std::erase_if(changed.deliveries, change.spares);
  return is_fair(changed) && pattern.match(host(changed)).has_value();
}

}  // namespace

void add_shares(CaseHost& host, const FailingCase& failing, const FailingCase& small, const FailurePattern& pattern,
                std::vector<Share>& found) {
  auto changes = changes_of(failing.scenario);
  std::erase_if(changes, [&, first = true](const WorldChange& change) mutable {
    return !std::exchange(first, false) && !changes_it(change, failing.scenario);
  });
  for (std::size_t i = 0; i < failing.scenario.agvs.size(); ++i) {
    if (EntityId{i} == failing.failure.a || EntityId{i} == failing.failure.b) continue;
    changes.push_back(
        {failing.scenario.agvs[i].name + " is not there", [name = failing.scenario.agvs[i].name](Scenario& s) {
           s = with_agvs(s, [&](std::size_t other) { return s.agvs[other].name != name; });
         }});
  }
  for (std::size_t i = 0; i < failing.scenario.computers.size(); ++i) {
    changes.push_back({failing.scenario.computers[i].name + " is not there",
                       [name = failing.scenario.computers[i].name](Scenario& s) {
                         s = with_computers(s, [&](std::size_t other) { return s.computers[other].name != name; });
                       }});
  }
  const auto draw = [](std::size_t rank) { return static_cast<std::uint32_t>(rank + 1); };
  for (const WorldChange& change : changes) {
    Share share{.what = change.what, .run = failing.scenario, .failing_draws = {}, .of = kRunsPerShare};
    change.edit(share.run);
    share.tells_why = change.spares != nullptr || change.what == kNoFault;
    if (!is_fair(share.run)) continue;
    const auto runs = all_runs(host, {kRunsPerShare, [&](std::size_t rank) {
                                        return std::optional(with_other_draws(share.run, draw(rank)));
                                      }});
    std::set<std::uint64_t> digests;
    for (const auto& run : runs) digests.insert(run->outcome.digest);
    if (digests.size() == 1) share.of = 1;
    for (std::size_t rank = 0; rank < share.of; ++rank) {
      if (pattern.match(*runs[rank])) share.failing_draws.push_back(draw(rank));
    }
    if (share.failing_draws.empty()) share.smallest_case_fails = fails_with(host, small, change, pattern);
    found.push_back(std::move(share));
  }
}

}  // namespace fleetproof
