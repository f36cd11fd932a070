#include "campaign/shrink/fate_passes.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "campaign/shrink/adverse_fates.hpp"
#include "campaign/shrink/number_edits.hpp"
#include "campaign/shrink/other_luck.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostPairs = 40'000;
constexpr Duration kDelayStep = std::chrono::milliseconds(100), kWindow = std::chrono::milliseconds(500);
constexpr Duration kStretches[] = {16 * kWindow, 8 * kWindow, 4 * kWindow, 2 * kWindow, kWindow};
constexpr std::size_t kLuckOfAWindow = 96;

std::vector<GivenFate> fates_of(const std::vector<MessageFate>& messages) {
  std::vector<GivenFate> fates;
  for (const MessageFate& message : messages) fates.push_back(message.fate);
  return fates;
}

// The way from front to back: the messages before `from_` have their fates, those behind it are drawn.
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
  // A stretch without bad luck, as long as possible.
  bool heal() {
    const auto found = try_committing(
        std::size(kStretches), [&](std::size_t i) { return Commitment{.until = from_ + kStretches[i], .window = {}}; });
    if (found) from_ += kStretches[*found];
    return found.has_value();
  }

  // As few adverse messages of the next window as suffice. With all of them the run stays as it is.
  bool commit_window() {
    const Duration until = from_ + kWindow;
    std::vector<GivenFate> window = window_of_best(until);
    const auto commits = [&](const std::vector<GivenFate>& messages) {
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

  std::vector<GivenFate> window_of_best(Duration until) const {
    std::vector<GivenFate> window;
    for (const MessageFate& message : shrinker_.trials().host()(shrinker_.best().scenario, Fates::Kept).fates) {
      if (message.is_adverse() && message.fate.sent >= from_ && message.fate.sent < until)
        window.push_back(message.fate);
    }
    return window;
  }

  struct Commitment {
    Duration until;
    std::vector<GivenFate> window;
  };
  // Each commitment is tried with much luck behind it. Luck 0 keeps what was drawn there, as far as the same messages
  // are sent.
  std::optional<std::size_t> try_committing(std::size_t count, const std::function<Commitment(std::size_t)>& make) {
    const Scenario best = shrinker_.best().scenario;
    auto found = shrinker_.trials().first_failing(
        {count * kLuckOfAWindow, [&](std::size_t rank) {
           const Commitment commitment = make(rank / kLuckOfAWindow);
           Scenario committed = best;
           std::erase_if(committed.fates, [&](const GivenFate& fate) { return fate.sent >= from_; });
           committed.fates.insert(committed.fates.end(), commitment.window.begin(), commitment.window.end());
           committed.radio.adverse.adverse_from_s = to_seconds(commitment.until);
           const auto luck = static_cast<std::uint32_t>(rank % kLuckOfAWindow);
           return std::optional(luck == 0 ? std::move(committed) : with_other_radio(std::move(committed), luck));
         }});
    if (!found) return std::nullopt;
    const std::size_t which = found->rank / kLuckOfAWindow;
    shrinker_.accept(std::move(found), "bad luck written down");
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
                                                            less.fates = kept(less.fates, [&](std::size_t i) {
                                                              return groups[i] != order[rank];
                                                            });
                                                            return std::optional(std::move(less));
                                                          }}),
                         "fewer adverse messages");
}

// Late messages as little late as suffices, in steps of 0.1 s; second copies gone.
bool weaken_fates(Shrinker& shrinker) {
  bool smaller = false;
  for (std::size_t i = 0; i < shrinker.best().scenario.fates.size(); ++i) {
    const GivenFate fate = shrinker.best().scenario.fates[i];  // a smaller case takes the place of the best one
    if (fate.copied)
      smaller |= shrinker.try_each("fewer adverse messages", 1, [&](Scenario& s, std::size_t) {
        s.fates[i].copied = false;
        s.fates[i].copy_delay = Duration::zero();
      });
    const auto steps = static_cast<std::size_t>((fate.delay - Duration{1}) / kDelayStep);
    if (fate.lost || fate.delay <= kDelayStep) continue;
    smaller |= shrinker.try_each("shorter delays", steps, [&](Scenario& s, std::size_t rank) {
      s.fates[i].delay = kDelayStep * static_cast<std::int64_t>(rank + 1);
    });
  }
  return smaller;
}

}  // namespace

std::vector<GivenFate> troubles_of(const std::vector<MessageFate>& messages, SimTime until, Duration late) {
  std::vector<GivenFate> troubles;
  for (const MessageFate& message : messages) {
    if (kStart + message.fate.sent > until) break;
    GivenFate fate = message.fate;
    fate.lost = true;
    fate.delay = Duration::zero();
    troubles.push_back(fate);
    if (late == Duration::zero()) continue;
    fate.lost = false;
    fate.delay = late;
    troubles.push_back(fate);
  }
  std::ranges::reverse(troubles);
  return troubles;
}

bool write_fates_down(Shrinker& shrinker) {
  const auto messages = adverse_of(shrinker.trials().host()(shrinker.best().scenario, Fates::Kept).fates);
  return shrinker.accept(
      shrinker.trials().first_failing(
          {1,
           [&](std::size_t) { return std::optional(with_fates_only(shrinker.best().scenario, fates_of(messages))); }}),
      "fates written down");
}

bool write_least_fates_down(Shrinker& shrinker) {
  if (!CaseSize::of(shrinker.best().scenario).fates_are_drawn) return false;
  FrontToBack(shrinker).run();
  return write_fates_down(shrinker);
}

bool take_out_fates(Shrinker& shrinker) {
  if (shrinker.best().scenario.fates.empty()) return false;
  bool smaller = false;
  const auto link_of = [](const GivenFate& fate) {
    return std::uint64_t{fate.sender.value} << 32 | fate.receiver.value;
  };
  const auto late_or_lost = [](const GivenFate& fate) -> std::uint64_t { return fate.lost ? 1 : fate.copied ? 2 : 3; };
  for (const auto& group_of :
       std::initializer_list<std::function<std::uint64_t(const GivenFate&)>>{late_or_lost, link_of}) {
    for (bool again = true; again;) {
      std::vector<std::uint64_t> groups;
      for (const GivenFate& fate : shrinker.best().scenario.fates) groups.push_back(group_of(fate));
      again = take_out_groups(shrinker, groups);
      smaller |= again;
    }
  }
  smaller |= shrinker.take_out(
      "fewer adverse messages", [](const Scenario& s) { return s.fates.size(); },
      [](const Scenario& s, const Keeps& keeps) {
        Scenario less = s;
        less.fates = kept(s.fates, keeps);
        return less;
      });
  return weaken_fates(shrinker) || smaller;
}

bool find_fewer_fates(Shrinker& shrinker) {
  const std::vector<GivenFate> now = shrinker.best().scenario.fates;
  if (now.size() < 2) return false;
  Duration latest{};
  for (const GivenFate& fate : now) latest = std::max(latest, fate.delay);
  const Scenario lucky = with_fates_only(shrinker.best().scenario, {});
  const auto troubles =
      troubles_of(shrinker.trials().host()(lucky, Fates::Kept).fates, shrinker.best().failure.at, latest);
  const auto with = [&](std::vector<GivenFate> fates) {
    Scenario few = lucky;
    few.fates = std::move(fates);
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
                                                            const GivenFate &a = troubles[i], &b = troubles[j];
                                                            const auto key = [](const GivenFate& f) {
                                                              return std::tuple(f.sender, f.receiver, f.sent,
                                                                                f.ordinal);
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
