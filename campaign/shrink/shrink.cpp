#include "campaign/shrink/shrink.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/delivery_passes.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/shrinker.hpp"
#include "campaign/shrink/sparse_losses.hpp"
#include "campaign/shrink/surgery.hpp"
#include "core/scenario/order_table.hpp"

namespace fleetproof {

CaseSize CaseSize::of(const Scenario& scenario) {
  const RadioSetup& radio = scenario.radio;
  const bool is_perfect = radio.loss == 0.0 && radio.delay_s == 0.0 && radio.duplicates == 0.0 &&
                          radio.sources.empty() && radio.trace == nullptr && !radio.contention.interference;
  return {.agvs = scenario.agvs.size(),
          .computers = scenario.computers.size(),
          .transports = OrderTable(scenario).size(),
          .faults = scenario.faults.size(),
          .obstacles = scenario.obstacles.size(),
          .segments = scenario.map->segment_count(),
          .deliveries = scenario.deliveries.size(),
          .deliveries_are_drawn = !is_perfect,
          .horizon = scenario.horizon};
}

std::size_t CaseSize::price() const {
  constexpr std::size_t few_agvs = 3, of_an_agv = 4;
  return deliveries_are_drawn ? ~std::size_t{0} : deliveries + of_an_agv * (std::max(agvs, few_agvs) - few_agvs);
}

bool CaseSize::is_smaller_than(const CaseSize& other) const {
  const auto rank = [](const CaseSize& size) {
    return std::tuple(size.price(),
                      size.agvs + size.computers + size.transports + size.faults + size.obstacles + size.segments,
                      size.horizon);
  };
  return rank(*this) < rank(other);
}

namespace {

// So many ways in which the failure comes about are compared: with sparse losses, and with as many as there were.
constexpr std::size_t kSparseStarts = 4;
constexpr std::uint32_t kOtherStarts = 6;
constexpr std::uint32_t kTimelines = 12;  // on which a single adverse message is looked for
constexpr std::size_t kFew = 2;           // adverse messages: fewer are not looked for elsewhere
constexpr std::size_t kFewAgvs = 3;

// So long before the failure, at least, a run may start later. A failure that comes soon after the start may need more
// losses and delays at once, so all of them are tried: the last is the run from its beginning.
constexpr std::array<Duration, 3> kLeadUps = {std::chrono::seconds(10), std::chrono::seconds(3), kLongestDuration};

const OnSmaller kQuietly = [](const FailingCase&, std::string_view) {};

bool is_large(const FailingCase& failing) { return failing.scenario.agvs.size() > kFewAgvs; }
bool draws_deliveries(const FailingCase& failing) { return CaseSize::of(failing.scenario).deliveries_are_drawn; }

// What is taken away first: what is left then may need all of the other.
enum class First : bool { Radio, Fleet };

// While the radio draws, a run that takes another timeline meets losses and delays again. The shorter run comes last:
// on other timelines, it may fail later.
FailingCase with_radio_drawn(Trials& trials, const FailingCase& original, Duration lead_up, First first,
                             const OnSmaller& on_smaller) {
  Shrinker shrinker(trials, original, on_smaller, Shrinker::Timelines::Free);
  shrinker.end_with_slack();
  shrinker.start_later(lead_up);
  if (first == First::Radio) shrinker.improve_radio();
  shrinker.keep_the_involved();
  for (bool smaller = true; smaller && !trials.ended();) {
    smaller = shrinker.take_out_things();
    smaller |= shrinker.improve_radio();
    smaller |= shrinker.start_later(lead_up);
    shrinker.end_with_slack();
  }
  shrinker.shorten();
  return shrinker.best();
}

FailingCase with_deliveries_written(Trials& trials, const FailingCase& drawn, const OnSmaller& on_smaller) {
  Shrinker shrinker(trials, drawn, on_smaller);
  shrinker.narrow_losses();
  if (write_least_deliveries_down(shrinker)) take_out_deliveries(shrinker);
  return shrinker.best();
}

// Of the ways in which the failure comes about, the one that needs the fewest adverse messages, and not many AGVs
// instead. What is quick comes first.
class FewestLosses {
 public:
  FewestLosses(Trials& trials, const FailingCase& original, const OnSmaller& on_smaller)
      : trials_(trials), on_smaller_(on_smaller), best_(original) {}

  FailingCase find() {
    const FailingCase original = best_;
    try_lead_up(original, 0);
    for (std::size_t i = 1; i < kLeadUps.size() && !is_enough(); ++i) try_lead_up(original, i);
    for (std::size_t i = 0; i < kLeadUps.size() && is_large(best_) && !is_enough(); ++i)
      try_lead_up(original, i, First::Fleet);
    for (const FailingCase& way : ways_) {
      if (!is_enough()) compare(way);
    }
    for (const FailingCase& way : ways_) try_sparse_losses(way);
    for (const FailingCase& way : ways_) try_other_starts(way);
    return best_;
  }

 private:
  bool is_enough() const { return trials_.ended() || price_of(best_) <= kFew; }
  static std::size_t price_of(const FailingCase& failing) { return CaseSize::of(failing.scenario).price(); }

  void try_lead_up(const FailingCase& original, std::size_t i, First first = First::Radio) {
    const bool is_first = i == 0 && first == First::Radio;
    const FailingCase way = with_radio_drawn(trials_, original, kLeadUps[i], first, is_first ? on_smaller_ : kQuietly);
    if (is_first) best_ = way;
    if (!is_first && price_of(way) < price_of(best_)) {
      best_ = way;
      on_smaller_(best_, "perfect radio");
    }
    if (!draws_deliveries(way)) return;
    ways_.push_back(way);
    try_single_messages(way);
  }

  void try_other_starts(const FailingCase& way) {
    for (std::uint32_t draw = 1; draw <= kOtherStarts && !is_enough(); ++draw) {
      const auto start = trials_.first_failing(
          {1, [&](std::size_t) { return std::optional(with_other_timeline(way.scenario, draw, kLatest)); }});
      if (start) compare(start->is);
    }
  }

  void try_single_messages(const FailingCase& way) {
    for (std::uint32_t timeline = 0; timeline < kTimelines && !is_enough(); ++timeline) {
      Scenario undisturbed = with_deliveries_only(way.scenario, {});
      undisturbed.horizon = longer(undisturbed.horizon);
      if (timeline > 0) undisturbed = with_other_timeline(std::move(undisturbed), timeline, kLatest);
      const auto troubles = troubles_of(trials_.host()(undisturbed, Deliveries::Kept).deliveries,
                                        kStart + undisturbed.horizon, seconds(way.scenario.radio.delay_s));
      const auto found = trials_.first_failing({troubles.size(), [&](std::size_t rank) {
                                                  Scenario disturbed = undisturbed;
                                                  disturbed.deliveries = {troubles[rank]};
                                                  return std::optional(std::move(disturbed));
                                                }});
      if (found) compare(found->is);
    }
  }

  // With fewer losses and delays, a run may fail later.
  static Duration longer(Duration horizon) { return horizon * 5 / 4; }

  void try_sparse_losses(const FailingCase& way) {
    const auto cases = with_sparse_losses(way.scenario, way.failure.at);
    std::size_t from = 0;
    for (std::size_t start = 0; start < kSparseStarts && from < cases.size() && !is_enough(); ++start) {
      auto found = trials_.first_failing({cases.size() - from, [&](std::size_t rank) {
                                            Scenario sparse = cases[from + rank];
                                            sparse.horizon = longer(way.scenario.horizon);
                                            return std::optional(std::move(sparse));
                                          }});
      if (!found) return;
      from += found->rank + 1;
      compare(found->is);
    }
  }

  void compare(const FailingCase& start) {
    FailingCase other = with_deliveries_written(trials_, start, kQuietly);
    if (price_of(other) >= price_of(best_)) return;
    best_ = std::move(other);
    on_smaller_(best_, "fewer adverse messages");
  }

  Trials& trials_;
  std::vector<FailingCase> ways_;  // the radio still draws
  const OnSmaller& on_smaller_;
  FailingCase best_;
};

// Why it is not known whether something of the case could be left out alone; empty if it is known.
std::string why_not_known(const ShrinkResult& result, bool ended) {
  if (ended) return "the time or the trials that were allowed ended before all had been tried";
  if (result.after.deliveries_are_drawn)
    return "the radio still draws: with its deliveries written down, the run fails otherwise";
  const auto has_script = [](const AgvSetup& agv) { return !agv.script.empty(); };
  if (std::ranges::any_of(result.best.scenario.agvs, has_script)) return "segments that a script may name stay";
  return "";
}

// When the deliveries of messages are written down, each further step must keep the timeline of the run up to them.
FailingCase smallest_of(Trials& trials, const FailingCase& original, const OnSmaller& on_smaller) {
  Shrinker shrinker(trials, FewestLosses(trials, original, on_smaller).find(), on_smaller);
  for (bool smaller = true; smaller && !trials.ended();) {
    smaller = take_out_deliveries(shrinker);
    smaller |= find_fewer_deliveries(shrinker);
    smaller |= shrinker.take_out_things();
    smaller |= shrinker.take_out_segments();
    smaller |= shrinker.shorten();
    smaller |= simplify_numbers(shrinker);
  }
  return shrinker.best();
}

}  // namespace

ShrinkResult shrink(CaseHost& host, TrialCache& cache, const FailingCase& original, const FailurePattern& pattern,
                    const TrialLimits& limits, const OnSmaller& on_smaller) {
  Trials trials(host, cache, pattern, limits);
  ShrinkResult result;
  result.best = original;
  const OnSmaller keep = [&](const FailingCase& smaller, std::string_view pass) {
    result.best = smaller;
    on_smaller(smaller, pass);
  };
  try {
    result.best = smallest_of(trials, original, keep);
    result.ended = trials.ended();
  } catch (const GivenUp&) {  // in the middle of a pass: what was found until then stands
    result.ended = true;
  }
  result.before = CaseSize::of(original.scenario);
  // A search that was broken off may have made the run longer, so that it fails on other timelines, and nothing
  // smaller.
  if (result.before.is_smaller_than(CaseSize::of(result.best.scenario))) result.best = original;
  result.after = CaseSize::of(result.best.scenario);
  result.trials = trials.count();
  result.why_not = why_not_known(result, result.ended);
  result.one_minimal = result.why_not.empty();
  return result;
}

}  // namespace fleetproof
