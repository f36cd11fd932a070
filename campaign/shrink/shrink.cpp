#include "campaign/shrink/shrink.hpp"

#include <algorithm>

#include "campaign/shrink/adverse_fates.hpp"
#include "campaign/shrink/fate_passes.hpp"
#include "campaign/shrink/other_luck.hpp"
#include "campaign/shrink/shrinker.hpp"
#include "campaign/shrink/sparse_luck.hpp"
#include "campaign/shrink/surgery.hpp"

namespace fleetproof {

CaseSize CaseSize::of(const Scenario& scenario) {
  const RadioSetup& radio = scenario.radio;
  const bool is_perfect = radio.loss == 0.0 && radio.delay_s == 0.0 && radio.duplicates == 0.0 &&
                          radio.sources.empty() && radio.trace == nullptr && !radio.contention.interference;
  return {.agvs = scenario.agvs.size(),
          .transports = transports_of(scenario).size(),
          .faults = scenario.faults.size(),
          .obstacles = scenario.obstacles.size(),
          .segments = scenario.map->segment_count(),
          .fates = scenario.fates.size(),
          .fates_are_drawn = !is_perfect,
          .horizon = scenario.horizon};
}

namespace {

// So many ways in which the failure comes about are compared: with sparse luck, and with as much luck as there was.
constexpr std::size_t kSparseStarts = 4;
constexpr std::uint32_t kOtherStarts = 6;
constexpr std::uint32_t kCourses = 12;  // on which a single adverse message is looked for
constexpr std::size_t kFew = 2;         // adverse messages: fewer are not looked for elsewhere

// While the radio draws, a run that takes another course meets bad luck again. The shorter run comes last: on other
// courses, it may fail later.
FailingCase with_luck_drawn(Trials& trials, const FailingCase& original, const OnSmaller& on_smaller) {
  Shrinker shrinker(trials, original, on_smaller, Shrinker::Courses::Free);
  shrinker.end_with_slack();
  shrinker.improve_radio();
  shrinker.keep_the_involved();
  for (bool smaller = true; smaller && !trials.ended();) {
    smaller = shrinker.take_out_things();
    smaller |= shrinker.improve_radio();
    shrinker.end_with_slack();
  }
  shrinker.shorten();
  return shrinker.best();
}

FailingCase with_luck_written(Trials& trials, const FailingCase& drawn, const OnSmaller& on_smaller) {
  Shrinker shrinker(trials, drawn, on_smaller);
  shrinker.narrow_bad_luck();
  if (write_least_fates_down(shrinker)) take_out_fates(shrinker);
  return shrinker.best();
}

// Of the ways in which the failure comes about, the one that needs the fewest adverse messages.
class LeastBadLuck {
 public:
  LeastBadLuck(Trials& trials, const FailingCase& drawn, const OnSmaller& on_smaller)
      : trials_(trials), drawn_(drawn), on_smaller_(on_smaller), best_(drawn) {}

  FailingCase find() {
    if (!CaseSize::of(drawn_.scenario).fates_are_drawn) return best_;
    try_single_messages();
    if (!is_enough()) compare(drawn_);
    try_sparse_luck();
    for (std::uint32_t luck = 1; luck <= kOtherStarts && !is_enough(); ++luck) {
      const auto start = trials_.first_failing(
          {1, [&](std::size_t) { return std::optional(with_other_course(drawn_.scenario, luck, kLatest)); }});
      if (start) compare(start->is);
    }
    return best_;
  }

 private:
  bool is_enough() const { return trials_.ended() || fates_of(best_) <= kFew; }
  // While they are drawn, more than any list has.
  static std::size_t fates_of(const FailingCase& failing) {
    const CaseSize size = CaseSize::of(failing.scenario);
    return size.fates_are_drawn ? ~std::size_t{0} : size.fates;
  }

  void try_single_messages() {
    for (std::uint32_t course = 0; course < kCourses && !is_enough(); ++course) {
      Scenario lucky = with_fates_only(drawn_.scenario, {});
      lucky.horizon = longer(lucky.horizon);
      if (course > 0) lucky = with_other_course(std::move(lucky), course, kLatest);
      const auto troubles = troubles_of(trials_.host()(lucky, Fates::Kept).fates, kStart + lucky.horizon,
                                        seconds(drawn_.scenario.radio.delay_s));
      const auto found = trials_.first_failing({troubles.size(), [&](std::size_t rank) {
                                                  Scenario unlucky = lucky;
                                                  unlucky.fates = {troubles[rank]};
                                                  return std::optional(std::move(unlucky));
                                                }});
      if (found) compare(found->is);
    }
  }

  // With less bad luck, a run may fail later.
  static Duration longer(Duration horizon) { return horizon * 5 / 4; }

  void try_sparse_luck() {
    const auto cases = with_sparse_luck(drawn_.scenario, drawn_.failure.at);
    std::size_t from = 0;
    for (std::size_t start = 0; start < kSparseStarts && from < cases.size() && !is_enough(); ++start) {
      auto found = trials_.first_failing({cases.size() - from, [&](std::size_t rank) {
                                            Scenario sparse = cases[from + rank];
                                            sparse.horizon = longer(drawn_.scenario.horizon);
                                            return std::optional(std::move(sparse));
                                          }});
      if (!found) return;
      from += found->rank + 1;
      compare(found->is);
    }
  }

  void compare(const FailingCase& start) {
    const OnSmaller quietly = [](const FailingCase&, std::string_view) {};
    FailingCase other = with_luck_written(trials_, start, quietly);
    if (fates_of(other) >= fates_of(best_)) return;
    best_ = std::move(other);
    on_smaller_(best_, "fewer adverse messages");
  }

  Trials& trials_;
  const FailingCase& drawn_;
  const OnSmaller& on_smaller_;
  FailingCase best_;
};

// Why it is not known whether something of the case could be left out alone; empty if it is known.
std::string why_not_known(const ShrinkResult& result, bool ended) {
  if (ended) return "the time or the trials that were allowed ended before all had been tried";
  if (result.after.fates_are_drawn)
    return "the radio still draws: with its fates written down, the run fails otherwise";
  const auto has_script = [](const AgvSetup& agv) { return !agv.script.empty(); };
  if (std::ranges::any_of(result.best.scenario.agvs, has_script)) return "segments that a script may name stay";
  return "";
}

}  // namespace

// When the fates of messages are written down, each further step must keep the course of the run up to them.
ShrinkResult shrink(CaseHost& host, TrialCache& cache, const FailingCase& original, const FailurePattern& pattern,
                    const TrialLimits& limits, const OnSmaller& on_smaller) {
  Trials trials(host, cache, pattern, limits);
  const FailingCase drawn = with_luck_drawn(trials, original, on_smaller);
  Shrinker shrinker(trials, LeastBadLuck(trials, drawn, on_smaller).find(), on_smaller);
  for (bool smaller = true; smaller && !trials.ended();) {
    smaller = take_out_fates(shrinker);
    smaller |= find_fewer_fates(shrinker);
    smaller |= shrinker.take_out_things();
    smaller |= shrinker.take_out_segments();
    smaller |= shrinker.shorten();
    smaller |= simplify_numbers(shrinker);
  }
  ShrinkResult result;
  result.best = shrinker.best();
  result.before = CaseSize::of(original.scenario);
  result.after = CaseSize::of(result.best.scenario);
  result.trials = trials.count();
  result.why_not = why_not_known(result, trials.ended());
  result.one_minimal = result.why_not.empty();
  return result;
}

}  // namespace fleetproof
