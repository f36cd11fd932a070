#include "campaign/findings/retest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "campaign/findings/elsewhere.hpp"
#include "campaign/findings/finding.hpp"
#include "campaign/findings/ingredients.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/fisher.hpp"

namespace fleetproof {
namespace {

constexpr double kNewKindChance = 0.001, kRarerChance = 0.01;
// If software that fails as before had fewer failing neighbours than this in the mean, that none fails says little:
// with 10, it is chance once in 20 000 times.
constexpr std::size_t kEnoughBefore = 10, kOften = 10;

bool is_of_radio(const std::string& need) {
  return need == kLateMessages || need == kLostMessages || need == kCopiedMessages;
}

// What sets it apart from the kept one, in words.
std::string text_of_new(const KeptFailure& kept, const FailureNeeds& found) {
  std::string text = Mechanism{found.end, found.needs, fmt::format("{}", fmt::join(found.doings, "; ")), {}}.text();
  if (names_all(kept.doings, {kThirdAgvTrait}) && !names_all(found.traits, {kThirdAgvTrait}))
    text += "; needs no third AGV";
  for (const std::string& word : kept.says) {
    if (!names_all(found.said, {word})) text += fmt::format("; never says \"{}\"", word);
  }
  return text;
}

// The smallest case names the messages that are lost or late in it, but not their kinds.
bool is_kept_one(const KeptFailure& kept, const FailureNeeds& of_case) {
  return of_case.end == kept.end && shows_the_same(kept, of_case) &&
         std::ranges::any_of(kept.ways, [&](const std::vector<std::string>& way) {
           const auto named = without_kinds(way);
           const bool any_bad_luck = named.empty() && !way.empty();
           if (any_bad_luck) return !of_case.needs.empty() && std::ranges::all_of(of_case.needs, is_of_radio);
           return is_one_of({named}, of_case.needs);
         });
}

// What the AGVs of each failure had said before, and no fleet ever says now: the software no longer does what the word
// names. None if all such words are gone: it speaks another language.
std::vector<std::string> words_no_longer_said(const NeighbourCounts& now, const std::optional<FailureNeeds>& of_case,
                                              const NeighbourCounts& before) {
  std::vector<std::string> gone = before.always_said;
  std::erase_if(gone, [&](const std::string& word) {
    return names_all(now.ever_said, {word}) || (of_case && names_all(of_case->said, {word}));
  });
  return gone.size() < before.always_said.size() ? gone : std::vector<std::string>{};
}

// What neighbours need that fail with the same end, if the failure that was kept is not among them. Empty: it is.
std::string other_mechanism(CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood,
                            const NeighbourCounts& now) {
  const auto first = needs_of_first(host, neighbourhood, now);
  const auto is_kept = [&](const FailureNeeds& found) { return is_one_of(kept, found); };
  return first.empty() || std::ranges::any_of(first, is_kept) ? "" : text_of_new(kept, first.front());
}

// Something was mended, not all. Worlds draw their luck, so their share does not change with the timing of the
// software. Where only all neighbours were counted: below three quarters is no accident of timing.
bool is_rarer(const NeighbourCounts& now, const NeighbourCounts& before) {
  if (before.of_world > 0)
    return fisher_exact(now.alike_of_world, now.of_world, before.alike_of_world, before.of_world).first_smaller <
           kRarerChance;
  return before.of > 0 && kOften * before.alike >= before.of && 4 * now.alike * before.of < 3 * before.alike * now.of;
}

// More often than before, of the runs that did not fail as the kept one did.
std::string more_often(const NeighbourCounts& now, const NeighbourCounts& before) {
  for (const auto& [end, count] : now.otherwise) {
    const auto then = before.otherwise.find(end);
    const std::size_t past = then == before.otherwise.end() ? 0 : then->second;
    const std::size_t open_before = before.of - before.alike, open_now = now.of - now.alike;
    if (open_before > 0 && fisher_exact(past, open_before, count, open_now).first_smaller < kNewKindChance)
      return fmt::format("{} in {} of {} neighbours ({} of {} before)", end, count, open_now, past, open_before);
  }
  return {};
}

bool is_half_as_far(std::uint64_t driven, std::uint64_t of, std::uint64_t driven_before, std::uint64_t of_before) {
  return of_before > 0 && driven_before > 0 && 2 * driven * of_before >= driven_before * of;
}

// Fleets that stand fail nowhere. If they stand elsewhere, too, nothing is shown about the fault; if not, they wait.
struct StandingFleets {
  std::string text;
  bool is_everywhere = false;
};
StandingFleets standing_fleets(CaseHost& host, const KeptFailure& kept, const NeighbourCounts& now,
                               const NeighbourCounts& before) {
  if (before.driven_m == 0 || is_half_as_far(now.driven_m, now.of, before.driven_m, before.of)) return {};
  const auto mean_m = [](std::uint64_t driven, std::size_t of) {
    return static_cast<double>(driven) / static_cast<double>(of);
  };
  StandingFleets standing{fmt::format("in each neighbour in the mean {:.1f} m, {:.1f} m before",
                                      mean_m(now.driven_m, now.of), mean_m(before.driven_m, before.of)),
                          true};
  if (before.driven_elsewhere_m == 0) return standing;
  const std::uint64_t elsewhere_m = driven_elsewhere_m(host, kept);
  standing.text +=
      fmt::format("; from other stations on a perfect radio {} m, {} m before", elsewhere_m, before.driven_elsewhere_m);
  standing.is_everywhere = !is_half_as_far(elsewhere_m, 1, before.driven_elsewhere_m, 1);
  return standing;
}

}  // namespace

Retest retest(CaseHost& host, const KeptFailure& found, const NeighbourCounts& before, std::uint32_t neighbours) {
  Retest result;
  const auto of_case = needs_of(host, found.smallest);
  const Neighbourhood neighbourhood(host, found);
  result.now = try_neighbours(host, found, neighbourhood, neighbours);
  const NeighbourCounts& now = result.now;
  KeptFailure kept = found;
  for (std::string& word : words_no_longer_said(now, of_case, before)) {
    if (!names_all(kept.says, {word})) kept.says.push_back(std::move(word));
  }
  result.upper_bound = upper_bound(now.alike, now.of, Confidence{0.95});
  result.case_fails = of_case && is_kept_one(kept, *of_case);
  if (result.case_fails) {
    result.verdict = RetestVerdict::StillThere;
  } else if (of_case && of_case->end == kept.end) {
    result.new_kind = text_of_new(kept, *of_case);
    result.verdict = RetestVerdict::NewKind;
  } else if (now.alike > 0) {
    result.new_kind = other_mechanism(host, kept, neighbourhood, now);
    result.verdict = !result.new_kind.empty() ? RetestVerdict::NewKind
                     : is_rarer(now, before)  ? RetestVerdict::StillThere
                                              : RetestVerdict::Dodged;
  } else {
    result.new_kind = more_often(now, before);
    const StandingFleets standing = standing_fleets(host, kept, now, before);
    result.standing = standing.text;
    const bool is_telling = before.of > 0 && now.of * before.alike >= kEnoughBefore * before.of;
    result.verdict = !result.new_kind.empty()                ? RetestVerdict::NewKind
                     : is_telling && !standing.is_everywhere ? RetestVerdict::Fixed
                                                             : RetestVerdict::NotKnown;
  }
  return result;
}

}  // namespace fleetproof
