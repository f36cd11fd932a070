#include "campaign/findings/neighbourhood.hpp"

#include <algorithm>
#include <iterator>

#include "campaign/findings/ingredients.hpp"
#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/surgery.hpp"
#include "core/base/random.hpp"

namespace fleetproof {
namespace {

constexpr Duration kShift = std::chrono::seconds(1);
constexpr double kFreeCallCost_s = 0.0002;
constexpr std::uint32_t kEveryCase = 4, kEveryThird = 3, kNeighbourKey = 7;
constexpr std::size_t kFewAlike = 5, kMostLookedAt = 20, kEnoughPassing = 10;

// Draws in [0, 1) for one neighbour.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint32_t number) : seed_(seed), number_(number) {}
  double next() { return unit_interval(word64(philox(seed_, {number_, drawn_++, kNeighbourKey, 0}), 0)); }

 private:
  std::uint64_t seed_;
  std::uint32_t number_, drawn_ = 0;
};

// One shift for each AGV, and one for the open transports: what belongs together stays together.
Scenario shifted(Scenario scenario, Dice& dice) {
  const auto later = [](Duration at, Duration by) { return std::max(Duration::zero(), at + by); };
  const auto shift = [&](std::vector<TransportOrder>& orders, Duration by) {
    for (TransportOrder& order : orders) {
      order.release = later(order.release, by);
      if (order.withdrawn != kLongestDuration) order.withdrawn = later(order.withdrawn, by);
    }
  };
  std::vector<Duration> shifts;
  for (AgvSetup& agv : scenario.agvs) {
    shifts.push_back(seconds(to_seconds(kShift) * (2.0 * dice.next() - 1.0)));
    shift(agv.transports, shifts.back());
  }
  if (!scenario.open_orders.empty())
    shift(scenario.open_orders, seconds(to_seconds(kShift) * (2.0 * dice.next() - 1.0)));
  for (Fault& fault : scenario.faults) {
    if (!fault.transport && scenario.is_agv(fault.agv)) fault.at = later(fault.at, shifts[fault.agv.index()]);
  }
  return scenario;
}

Words shared_by(const Words& a, const Words& b) {
  Words shared;
  std::ranges::set_intersection(a, b, std::back_inserter(shared));
  return shared;
}

void think_otherwise(Scenario& scenario, Dice& dice) {
  double& cost_s = scenario.agent_clock.call_cost_s;
  cost_s = cost_s > 0.0 ? cost_s * (0.5 + 1.5 * dice.next()) : kFreeCallCost_s * dice.next();
}

}  // namespace

Words all_of(const Words& a, const Words& b) {
  Words all;
  std::ranges::set_union(a, b, std::back_inserter(all));
  return all;
}

bool is_one_of(const std::vector<std::vector<std::string>>& ways, const std::vector<std::string>& needs) {
  return std::ranges::any_of(
      ways, [&](const std::vector<std::string>& way) { return way.empty() ? needs.empty() : names_all(needs, way); });
}

bool shows_the_same(const KeptFailure& kept, const FailureNeeds& found) {
  const auto is_shown = [&](const std::string& doing) {
    return names_all(found.doings, {doing}) || names_all(found.traits, {doing});
  };
  return std::ranges::all_of(kept.doings, is_shown) && names_all(found.said, kept.says);
}

bool is_one_of(const KeptFailure& kept, const FailureNeeds& found) {
  return shows_the_same(kept, found) && is_one_of(kept.ways, found.needs);
}

Neighbourhood::Neighbourhood(CaseHost& host, const KeptFailure& kept) : kept_(kept) {
  const CaseRun run = host(kept.smallest, Deliveries::Kept);
  const auto failure = failure_of(run);
  for (const MessageDelivery& message : run.deliveries) {
    if (!message.delivery.lost && (!failure || kStart + message.delivery.sent < failure->at))
      messages_.push_back(message.delivery);
  }
}

void Neighbourhood::lose_one_more(Scenario& scenario, double draw) const {
  if (messages_.empty()) return;
  GivenDelivery lost = messages_[static_cast<std::size_t>(draw * static_cast<double>(messages_.size()))];
  lost.lost = true;
  lost.copied = false;
  lost.delay = lost.copy_delay = Duration::zero();
  std::erase_if(scenario.deliveries, [&](const GivenDelivery& delivery) { return is_same_message(delivery, lost); });
  scenario.deliveries.push_back(lost);
}

bool Neighbourhood::is_of_case(std::uint32_t number) const { return !is_of_runs_ && number % kEveryCase == 0; }

std::size_t Neighbourhood::world_of(std::uint32_t number) const {
  return is_of_runs_ ? number / 2 % kept_.runs.size() : number / kEveryCase % (kept_.other_worlds.size() + 1);
}

// Of whole runs, each AGV is the first equally often. Of worlds, another one than in the world is in every third: a
// failure may need that one of two AGVs goes first.
std::size_t Neighbourhood::first_agv_of(std::uint32_t number, std::size_t fleet) const {
  if (is_of_runs_) return number / 2 / kept_.runs.size() % fleet;
  const std::size_t round = number / kEveryCase / (kept_.other_worlds.size() + 1);
  return is_of_case(number) || round % kEveryThird > 0 || fleet < 2 ? 0 : 1 + round / kEveryThird % (fleet - 1);
}

Scenario Neighbourhood::at(std::uint32_t number) const {
  Dice dice(kept_.world.seed, number);
  const bool of_case = is_of_case(number);
  const Scenario& world = is_of_runs_ ? kept_.runs[world_of(number)] : kept_.world_of(number / kEveryCase);
  Scenario beside = of_case ? shifted(kept_.smallest, dice) : with_other_timeline(world, number, kShift);
  if (const std::size_t first = first_agv_of(number, beside.agvs.size()); first > 0)
    beside = with_fleet_renumbered(beside, first);
  if (of_case) lose_one_more(beside, dice.next());
  if (number % 2 == 1) think_otherwise(beside, dice);
  return beside;
}

namespace {

void count_in(NeighbourCounts& counts, const CaseRun& run, std::uint32_t number, const Neighbourhood& neighbourhood,
              const std::string& end) {
  const bool is_of_world = !neighbourhood.is_of_case(number);
  ++counts.of;
  if (is_of_world) ++counts.of_world;
  counts.said.ever = all_of(counts.said.ever, run.all_words);
  const auto failure = failure_of(run);
  if (!failure) {
    ++counts.said.passing;
    for (const std::string& word : run.all_words) ++counts.said.by_passing[word];
    return;
  }
  if (end_of(*failure) != end) {
    ++counts.otherwise[end_of(*failure)];
    return;
  }
  counts.said.always = counts.alike == 0 ? run.words : shared_by(counts.said.always, run.words);
  ++counts.alike;
  if (is_of_world) ++counts.alike_of_world;
  if (counts.first_alike.size() < kFewAlike) counts.first_alike.push_back(number);
  if (is_of_world && counts.first_alike_of_world.size() < kFewAlike) counts.first_alike_of_world.push_back(number);
  if (!is_of_world) return;
  const std::size_t world = neighbourhood.world_of(number);
  if (counts.looked_at.size() <= world) counts.looked_at.resize(world + 1);
  if (counts.looked_at[world].size() < kMostLookedAt) counts.looked_at[world].push_back(number);
}

// As if all up to number `to` had been tried at once.
void try_up_to(std::uint32_t to, CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood,
               NeighbourCounts& counts) {
  const auto from = static_cast<std::uint32_t>(counts.of);
  const auto runs = all_runs(host, {to - from, [&](std::size_t i) {
                                      return std::optional(neighbourhood.at(from + static_cast<std::uint32_t>(i)));
                                    }});
  std::uint64_t driven_um = 0;
  for (std::uint32_t i = 0; i < to - from; ++i) {
    driven_um += runs[i]->outcome.counters.distance_um;
    count_in(counts, *runs[i], from + i, neighbourhood, kept.end);
  }
  counts.driven_m += driven_um / 1'000'000;
}

// What AGVs also say when all is well: another timing may be enough for them not to say it.
void set_usual_words_apart(NeighbourCounts& counts) {
  if (counts.said.passing < kEnoughPassing) return;
  const auto is_usual = [&](const std::string& word) {
    const auto said = counts.said.by_passing.find(word);
    return said != counts.said.by_passing.end() && 10 * said->second > 9 * counts.said.passing;
  };
  std::ranges::copy_if(counts.said.always, std::back_inserter(counts.said.usually), is_usual);
  std::erase_if(counts.said.always, is_usual);
}

void look_closer(CaseHost& host, const Neighbourhood& neighbourhood, NeighbourCounts& counts) {
  for (const auto& numbers : counts.looked_at) {
    const auto make = [&](std::size_t i) { return std::optional(neighbourhood.at(numbers[i])); };
    const auto runs = all_runs(host, {numbers.size(), make}, Deliveries::Kept);
    std::vector<std::map<std::string, double>> failures;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      failures.push_back(circumstances_of(*runs[i], neighbourhood.at(numbers[i])));
    counts.circumstances.push_back(circumstances_of(failures));
  }
}

}  // namespace

NeighbourCounts try_neighbours(CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood,
                               std::uint32_t count) {
  NeighbourCounts counts;
  try_up_to(count, host, kept, neighbourhood, counts);
  set_usual_words_apart(counts);
  look_closer(host, neighbourhood, counts);
  return counts;
}

NeighbourCounts try_enough_neighbours(CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood) {
  NeighbourCounts counts;
  for (std::uint32_t count = kNeighbours;; count *= 2) {
    try_up_to(count, host, kept, neighbourhood, counts);
    if (counts.alike_of_world >= kEnoughAlike || count >= kMostKept) break;
  }
  set_usual_words_apart(counts);
  look_closer(host, neighbourhood, counts);
  return counts;
}

std::vector<FailureNeeds> needs_of_neighbours(CaseHost& host, const Neighbourhood& neighbourhood,
                                              std::span<const std::uint32_t> numbers) {
  std::vector<FailureNeeds> all;
  for (const std::uint32_t number : numbers) {
    if (auto needs = needs_of(host, neighbourhood.at(number))) all.push_back(*std::move(needs));
  }
  return all;
}

}  // namespace fleetproof
