#include "campaign/shrink/shrinker.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/fitness.hpp"
#include "campaign/shrink/later_start.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "core/scenario/order_table.hpp"

namespace fleetproof {
namespace {

// A smaller case is tried with so many other timelines before it is given up. Whether others are involved, and whether
// the radio is, is asked more often: that decides most.
constexpr std::size_t kOtherTimelines = 23, kTimelinesOfTheFew = 64;
constexpr Duration kAfterwards = std::chrono::milliseconds(1), kShortest = std::chrono::milliseconds(10);
constexpr std::int64_t kSteps = 16;  // of a span of time that is narrowed

std::optional<Scenario> if_fair(Scenario scenario) {
  return is_fair(scenario) ? std::optional(std::move(scenario)) : std::nullopt;
}

Duration since_start(SimTime t) { return t - kStart; }

// On another timeline, a run may fail later.
Duration with_slack(Duration seen) { return seen + seen / 2 + std::chrono::seconds(10); }

// Timeline 0 is the present one.
Scenario on_timeline(Scenario scenario, std::size_t timeline) {
  return timeline == 0 ? scenario
                       : with_other_timeline(std::move(scenario), static_cast<std::uint32_t>(timeline), kLatest);
}

}  // namespace

bool Shrinker::accept(std::optional<Trials::Found> found, std::string_view pass) {
  if (!found) return false;
  best_ = std::move(found->is);
  on_smaller_(best_, pass);
  return true;
}

std::size_t Shrinker::attempts() const {
  const bool is_free = timelines_ == Timelines::Free || CaseSize::of(best_.scenario).deliveries_are_drawn;
  return is_free ? 1 + kOtherTimelines : 1;
}

// ---- time

bool Shrinker::end_with_slack() {
  const Duration end = with_slack(since_start(best_.failure.seen));
  if (end == best_.scenario.horizon) return false;
  return try_each("another end", 1, [&](Scenario& scenario, std::size_t) { scenario.horizon = end; });
}

// With the AGVs of the failure alone, and then with all. The latest start first.
bool Shrinker::start_later(Duration lead_up) {
  const auto has_script = [](const AgvSetup& agv) { return !agv.script.empty(); };
  if (std::ranges::any_of(best_.scenario.agvs, has_script)) return false;
  const Duration at = since_start(best_.failure.at), seen = since_start(best_.failure.seen);
  shortest_ = std::min(shortest_, best_.scenario.horizon);
  std::vector<Duration> starts;
  for (Duration before = lead_up; before < at; before *= 2) {
    if (10 * with_slack(seen - at + before) < 9 * shortest_) starts.push_back(at - before);
  }
  if (starts.empty()) return false;
  const Itinerary itinerary = trials_.host()(best_.scenario, Deliveries::Kept).itinerary;
  const std::size_t tries = attempts() == 1 ? 1 : kTimelinesOfTheFew, count = starts.size() * 2 * tries;
  const auto make = [&](std::size_t rank) {
    const Duration from = starts[rank % count / tries / 2];
    const Between between = rank / tries % 2 == 0 ? Between::Behind : Between::Ahead;
    Scenario later = with_later_start(best_.scenario, itinerary, from, between);
    later.horizon = with_slack(seen - from);
    if (rank < count) later = with_agvs(later, [&](std::size_t agv) { return is_involved(agv); });
    return if_fair(on_timeline(std::move(later), rank % tries));
  };
  auto found = trials_.first_failing({2 * count, make});
  if (found) shortest_ = found->is.scenario.horizon;
  return accept(std::move(found), "later start");
}

bool Shrinker::is_involved(std::size_t agv) const {
  return EntityId{agv} == best_.failure.a || EntityId{agv} == best_.failure.b;
}

bool Shrinker::shorten() {
  const Duration seen = since_start(best_.failure.seen) + kAfterwards;
  const bool at_once = seen < best_.scenario.horizon &&
                       try_each("shorter run", 1, [&](Scenario& scenario, std::size_t) { scenario.horizon = seen; });
  return end_earliest("shorter run") || at_once;
}

// The instant at which it was seen may lie behind the shortest run that shows it: a standstill is dated back, and a
// crash to the end of the run.
bool Shrinker::end_earliest(std::string_view pass) {
  const Duration at = since_start(best_.failure.at);
  Duration low = at < best_.scenario.horizon ? std::max(at, kShortest) : kShortest;
  bool smaller = false;
  while (best_.scenario.horizon - low > std::max(kShortest, best_.scenario.horizon / 100)) {
    const Duration step = (best_.scenario.horizon - low) / kSteps;
    auto found = trials_.first_failing({static_cast<std::size_t>(kSteps - 1), [&](std::size_t rank) {
                                          Scenario shorter = best_.scenario;
                                          shorter.horizon = low + step * static_cast<std::int64_t>(rank);
                                          return std::optional(std::move(shorter));
                                        }});
    if (!found) return smaller;
    const std::size_t rank = found->rank;
    smaller = accept(std::move(found), pass);
    if (rank == 0) return true;
    low += step * static_cast<std::int64_t>(rank - 1);
  }
  return smaller;
}

bool Shrinker::narrow_losses() {
  if (!CaseSize::of(best_.scenario).deliveries_are_drawn) return false;
  bool smaller = false;
  Duration high = since_start(best_.failure.at);
  for (Duration step = high / kSteps; step > std::chrono::milliseconds(100) && !trials_.ended(); step /= 4) {
    const Duration low = seconds(best_.scenario.radio.adverse.adverse_from_s);
    const auto count = static_cast<std::size_t>(std::max<std::int64_t>(0, (high - low) / step - 1));
    auto found = trials_.first_failing({count * attempts(), [&](std::size_t rank) {
                                          Scenario later = best_.scenario;
                                          const auto number = static_cast<std::int64_t>(rank / attempts());
                                          later.radio.adverse.adverse_from_s = to_seconds(high - step * (number + 1));
                                          return std::optional(on_timeline(std::move(later), rank % attempts()));
                                        }});
    smaller |= accept(std::move(found), "perfect radio at first");
    high = since_start(best_.failure.at);
  }
  return smaller;
}

// ---- radio

bool Shrinker::try_with_timelines(std::string_view pass, const Scenario& smaller) {
  if (scenario_digest(smaller) == scenario_digest(best_.scenario)) return false;
  const auto make = [&](std::size_t timeline) { return std::optional(on_timeline(smaller, timeline)); };
  return accept(trials_.first_failing({kTimelinesOfTheFew, make}), pass);
}

bool Shrinker::improve_radio() {
  if (!CaseSize::of(best_.scenario).deliveries_are_drawn) return false;
  if (try_with_timelines("perfect radio", with_deliveries_only(best_.scenario, {}))) return true;
  bool smaller = false;
  const auto without = [&](std::string_view pass, const std::function<void(RadioSetup&)>& edit) {
    Scenario better = best_.scenario;
    edit(better.radio);
    smaller |= try_with_timelines(pass, better);
  };
  without("no copies", [](RadioSetup& radio) { radio.duplicates = 0.0; });
  without("no delay", [](RadioSetup& radio) { radio.delay_s = 0.0; });
  without("no loss", [](RadioSetup& radio) { radio = without_loss(std::move(radio)); });
  return smaller;
}

// ---- things

bool Shrinker::try_each(std::string_view pass, std::size_t count,
                        const std::function<void(Scenario&, std::size_t)>& edit) {
  return accept(trials_.first_failing({count,
                                       [&](std::size_t rank) {
                                         Scenario changed = best_.scenario;
                                         edit(changed, rank);
                                         return if_fair(std::move(changed));
                                       }}),
                pass);
}

bool Shrinker::keep_the_involved() {
  const std::size_t fleet = best_.scenario.agvs.size();
  if (!best_.failure.a.valid() || fleet < 3) return false;
  // Rank 0: nobody else. Then each other AGV beside them.
  std::vector<std::size_t> others{fleet};
  for (std::size_t agv = 0; agv < fleet; ++agv) {
    if (!is_involved(agv)) others.push_back(agv);
  }
  const std::size_t tries = attempts() == 1 ? 1 : kTimelinesOfTheFew;
  return accept(trials_.first_failing({others.size() * tries,
                                       [&](std::size_t rank) {
                                         const std::size_t also = others[rank / tries];
                                         Scenario few = with_agvs(best_.scenario, [&](std::size_t agv) {
                                           return is_involved(agv) || agv == also;
                                         });
                                         return if_fair(on_timeline(std::move(few), rank % tries));
                                       }}),
                "fewer AGVs");
}

// Runs of things, long runs first, from the back: what comes late disturbs less.
bool Shrinker::take_out(std::string_view pass, const Count& count, const Edit& edit) {
  bool smaller = false;
  for (std::size_t length = count(best_.scenario); length >= 1; length /= 2) {
    std::size_t end = count(best_.scenario);
    while (end > 0 && !trials_.ended()) {
      const std::size_t tries = attempts(), runs = (end + length - 1) / length;
      const auto run_of = [&](std::size_t rank) {
        const std::size_t last = end - rank / tries * length;
        return std::pair(last > length ? last - length : 0, last);
      };
      auto found = trials_.first_failing({runs * tries, [&](std::size_t rank) {
                                            const auto [from, to] = run_of(rank);
                                            Scenario less = edit(best_.scenario, [from = from, to = to](std::size_t i) {
                                              return i < from || i >= to;
                                            });
                                            return if_fair(on_timeline(std::move(less), rank % tries));
                                          }});
      if (!found) break;
      end = run_of(found->rank).first;
      smaller = accept(std::move(found), pass);
    }
  }
  return smaller;
}

bool Shrinker::take_out_things() {
  const auto list = [](auto Scenario::*items) {
    return std::pair<Count, Edit>([items](const Scenario& s) { return (s.*items).size(); },
                                  [items](const Scenario& s, const Keeps& keeps) {
                                    Scenario less = s;
                                    less.*items = kept(s.*items, keeps);
                                    return less;
                                  });
  };
  bool smaller = take_out("fewer AGVs", list(&Scenario::agvs).first, with_agvs);
  smaller |= take_out("fewer computers", list(&Scenario::computers).first, with_computers);
  smaller |= take_out(
      "fewer transports", [](const Scenario& s) { return OrderTable(s).size(); }, with_transports);
  const auto [fault_count, fewer_faults] = list(&Scenario::faults);
  smaller |= take_out("fewer faults", fault_count, fewer_faults);
  const auto [obstacle_count, fewer_obstacles] = list(&Scenario::obstacles);
  smaller |= take_out("fewer obstacles", obstacle_count, fewer_obstacles);
  smaller |= take_out(
      "fewer sources of noise", [](const Scenario& s) { return s.radio.sources.size(); },
      [](const Scenario& s, const Keeps& keeps) {
        Scenario less = s;
        less.radio.sources = kept(s.radio.sources, keeps);
        return less;
      });
  return smaller;
}

bool Shrinker::take_out_segments() {
  if (std::ranges::any_of(best_.scenario.agvs, [](const AgvSetup& agv) { return !agv.script.empty(); })) return false;
  return take_out(
      "smaller plant", [](const Scenario& s) { return s.map->segment_count(); }, with_segments);
}

}  // namespace fleetproof
