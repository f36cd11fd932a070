#include "campaign/shrink/delivery_passes.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/number_edits.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostPairs = 40'000;
constexpr Duration kDelayStep = std::chrono::milliseconds(100), kWindow = std::chrono::milliseconds(500);
constexpr Duration kPerfectSpans[] = {16 * kWindow, 8 * kWindow, 4 * kWindow, 2 * kWindow, kWindow};
constexpr std::size_t kDrawsPerWindow = 96;

std::vector<GivenDelivery> deliveries_of(const std::vector<MessageDelivery>& messages) {
  std::vector<GivenDelivery> deliveries;
  for (const MessageDelivery& message : messages) deliveries.push_back(message.delivery);
  return deliveries;
}

// The way from front to back: the messages before `from_` have their deliveries, those behind it are drawn.
class FrontToBack {
 public:
  explicit FrontToBack(Shrinker& shrinker)
      : shrinker_(shrinker), from_(seconds(shrinker.best().scenario.radio.adverse.adverse_from_s)) {}

  // False if the end could not be reached.
  bool run() {
    while (kStart + from_ <= shrinker_.best().failure.at) {
      if (!heal() && !commit_window()) return false;
    }
    return true;
  }

 private:
  // A span of time without losses and delays, as long as possible.
  bool heal() {
    const auto found = try_committing(std::size(kPerfectSpans), [&](std::size_t i) {
      return Commitment{.until = from_ + kPerfectSpans[i], .window = {}};
    });
    if (found) from_ += kPerfectSpans[*found];
    return found.has_value();
  }

  // As few adverse messages of the next window as suffice. With all of them the run stays as it is.
  bool commit_window() {
    const Duration until = from_ + kWindow;
    std::vector<GivenDelivery> window = window_of_best(until);
    const auto commits = [&](const std::vector<GivenDelivery>& messages) {
      return try_committing(1, [&](std::size_t) { return Commitment{until, messages}; }).has_value();
    };
    if (!commits(window)) return false;
    for (std::size_t length = (window.size() + 1) / 2; length >= 1; length = length == 1 ? 0 : (length + 1) / 2) {
      for (std::size_t end = window.size(); end > 0;) {
        const std::size_t begin = end > length ? end - length : 0;
        const auto fewer = kept(window, [&](std::size_t place) { return place < begin || place >= end; });
        if (commits(fewer)) window = fewer;
        end = begin;
      }
    }
    from_ = until;
    return true;
  }

  std::vector<GivenDelivery> window_of_best(Duration until) const {
    std::vector<GivenDelivery> window;
    for (const MessageDelivery& message :
         shrinker_.trials().host()(shrinker_.best().scenario, Deliveries::Kept).deliveries) {
      if (message.is_adverse() && message.delivery.sent >= from_ && message.delivery.sent < until)
        window.push_back(message.delivery);
    }
    return window;
  }

  struct Commitment {
    Duration until;
    std::vector<GivenDelivery> window;
  };
  // Each commitment is tried with many draws behind it. Draw 0 keeps what was drawn there, as far as the same messages
  // are sent.
  std::optional<std::size_t> try_committing(std::size_t count, const std::function<Commitment(std::size_t)>& make) {
    const Scenario best = shrinker_.best().scenario;
    auto found = shrinker_.trials().first_failing(
        {count * kDrawsPerWindow, [&](std::size_t rank) {
           const Commitment commitment = make(rank / kDrawsPerWindow);
           Scenario committed = best;
           std::erase_if(committed.deliveries, [&](const GivenDelivery& delivery) { return delivery.sent >= from_; });
           committed.deliveries.insert(committed.deliveries.end(), commitment.window.begin(), commitment.window.end());
           committed.radio.adverse.adverse_from_s = to_seconds(commitment.until);
           const auto draw = static_cast<std::uint32_t>(rank % kDrawsPerWindow);
           return std::optional(draw == 0 ? std::move(committed) : with_other_radio(std::move(committed), draw));
         }});
    if (!found) return std::nullopt;
    const std::size_t which = found->rank / kDrawsPerWindow;
    shrinker_.accept(std::move(found), "losses and delays written down");
    return which;
  }

  Shrinker& shrinker_;
  Duration from_;
};

bool take_out_groups(Shrinker& shrinker, const std::vector<std::uint64_t>& groups) {
  const std::set<std::uint64_t> all(groups.begin(), groups.end());
  const std::vector<std::uint64_t> order(all.begin(), all.end());
  if (order.size() < 2) return false;
  return shrinker.accept(shrinker.trials().first_failing({order.size(),
                                                          [&](std::size_t rank) {
                                                            Scenario less = shrinker.best().scenario;
                                                            less.deliveries = kept(less.deliveries, [&](std::size_t i) {
                                                              return groups[i] != order[rank];
                                                            });
                                                            return std::optional(std::move(less));
                                                          }}),
                         "fewer adverse messages");
}

// Late messages as little late as suffices, in steps of 0.1 s; second copies gone.
bool weaken_deliveries(Shrinker& shrinker) {
  bool smaller = false;
  for (std::size_t i = 0; i < shrinker.best().scenario.deliveries.size(); ++i) {
    const GivenDelivery delivery =
        shrinker.best().scenario.deliveries[i];  // a smaller case takes the place of the best one
    if (delivery.copied)
      smaller |= shrinker.try_each("fewer adverse messages", 1, [&](Scenario& s, std::size_t) {
        s.deliveries[i].copied = false;
        s.deliveries[i].copy_delay = Duration::zero();
      });
    const auto steps = static_cast<std::size_t>((delivery.delay - Duration{1}) / kDelayStep);
    if (delivery.lost || delivery.delay <= kDelayStep) continue;
    smaller |= shrinker.try_each("shorter delays", steps, [&](Scenario& s, std::size_t rank) {
      s.deliveries[i].delay = kDelayStep * static_cast<std::int64_t>(rank + 1);
    });
  }
  return smaller;
}

}  // namespace

std::vector<GivenDelivery> troubles_of(const std::vector<MessageDelivery>& messages, SimTime until, Duration late) {
  std::vector<GivenDelivery> troubles;
  for (const MessageDelivery& message : messages) {
    if (kStart + message.delivery.sent > until) break;
    GivenDelivery delivery = message.delivery;
    delivery.lost = true;
    delivery.delay = Duration::zero();
    troubles.push_back(delivery);
    if (late == Duration::zero()) continue;
    delivery.lost = false;
    delivery.delay = late;
    troubles.push_back(delivery);
  }
  std::ranges::reverse(troubles);
  return troubles;
}

bool write_deliveries_down(Shrinker& shrinker) {
  const auto messages = adverse_of(shrinker.trials().host()(shrinker.best().scenario, Deliveries::Kept).deliveries);
  return shrinker.accept(shrinker.trials().first_failing({1,
                                                          [&](std::size_t) {
                                                            return std::optional(with_deliveries_only(
                                                                shrinker.best().scenario, deliveries_of(messages)));
                                                          }}),
                         "deliveries written down");
}

bool write_least_deliveries_down(Shrinker& shrinker) {
  if (!CaseSize::of(shrinker.best().scenario).deliveries_are_drawn) return false;
  FrontToBack(shrinker).run();
  return write_deliveries_down(shrinker);
}

bool take_out_deliveries(Shrinker& shrinker) {
  if (shrinker.best().scenario.deliveries.empty()) return false;
  bool smaller = false;
  const auto link_of = [](const GivenDelivery& delivery) {
    return std::uint64_t{delivery.sender.value} << 32 | delivery.receiver.value;
  };
  const auto late_or_lost = [](const GivenDelivery& delivery) -> std::uint64_t {
    return delivery.lost ? 1 : delivery.copied ? 2 : 3;
  };
  for (const auto& group_of :
       std::initializer_list<std::function<std::uint64_t(const GivenDelivery&)>>{late_or_lost, link_of}) {
    for (bool again = true; again;) {
      std::vector<std::uint64_t> groups;
      for (const GivenDelivery& delivery : shrinker.best().scenario.deliveries) groups.push_back(group_of(delivery));
      again = take_out_groups(shrinker, groups);
      smaller |= again;
    }
  }
  smaller |= shrinker.take_out(
      "fewer adverse messages", [](const Scenario& s) { return s.deliveries.size(); },
      [](const Scenario& s, const Keeps& keeps) {
        Scenario less = s;
        less.deliveries = kept(s.deliveries, keeps);
        return less;
      });
  return weaken_deliveries(shrinker) || smaller;
}

bool find_fewer_deliveries(Shrinker& shrinker) {
  const std::vector<GivenDelivery> now = shrinker.best().scenario.deliveries;
  if (now.size() < 2) return false;
  Duration latest{};
  for (const GivenDelivery& delivery : now) latest = std::max(latest, delivery.delay);
  const Scenario undisturbed = with_deliveries_only(shrinker.best().scenario, {});
  const auto troubles = troubles_of(shrinker.trials().host()(undisturbed, Deliveries::Kept).deliveries,
                                    shrinker.best().failure.at, latest);
  const auto with = [&](std::vector<GivenDelivery> deliveries) {
    Scenario few = undisturbed;
    few.deliveries = std::move(deliveries);
    return std::optional(std::move(few));
  };
  if (shrinker.accept(
          shrinker.trials().first_failing({troubles.size(), [&](std::size_t rank) { return with({troubles[rank]}); }}),
          "fewer adverse messages"))
    return true;
  const std::size_t n = troubles.size();
  if (now.size() < 3 || n * n / 2 > kMostPairs) return false;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = 1; j < n; ++j) {
    for (std::size_t i = 0; i < j; ++i) pairs.emplace_back(i, j);
  }
  return shrinker.accept(shrinker.trials().first_failing({pairs.size(),
                                                          [&](std::size_t rank) {
                                                            const auto& [i, j] = pairs[rank];
                                                            const GivenDelivery &a = troubles[i], &b = troubles[j];
                                                            const auto key = [](const GivenDelivery& given) {
                                                              return std::tuple(given.sender, given.receiver,
                                                                                given.sent, given.ordinal);
                                                            };
                                                            return key(a) == key(b) ? std::nullopt : with({a, b});
                                                          }}),
                         "fewer adverse messages");
}

bool simplify_numbers(Shrinker& shrinker) {
  bool smaller = false;
  const Duration wait = earliest_instant(shrinker.best().scenario);
  if (wait > Duration::zero()) {
    smaller = shrinker.accept(
        shrinker.trials().first_failing({1,
                                         [&](std::size_t) {
                                           Scenario earlier = earlier_by(shrinker.best().scenario, wait);
                                           earlier.horizon = std::max(earlier.horizon - wait, Duration{1});
                                           return std::optional(std::move(earlier));
                                         }}),
        "earlier");
  }
  for (const NumberEdit& edit : number_edits(shrinker.best().scenario)) {
    Scenario simpler = shrinker.best().scenario;
    edit.apply(simpler);
    if (scenario_digest(simpler) == scenario_digest(shrinker.best().scenario)) continue;
    smaller |= shrinker.try_each("simpler numbers", 1, [&](Scenario& scenario, std::size_t) { edit.apply(scenario); });
  }
  return smaller;
}

}  // namespace fleetproof
