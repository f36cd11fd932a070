#include "campaign/findings/retest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "campaign/findings/elsewhere.hpp"
#include "campaign/findings/finding.hpp"
#include "campaign/findings/ingredients.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/fisher.hpp"

namespace fleetproof {
namespace {

constexpr double kNewKindChance = 0.001, kRarerChance = 0.005;
// If software that fails as before had fewer failing neighbours than this in the mean, that none fails says little:
// with 10, it is chance once in 20 000 times.
constexpr std::size_t kEnoughBefore = 10, kOften = 10;
// Runs that fail in a new way: fewer may have failed so before, unseen among all others that failed.
constexpr std::size_t kFewestNew = 3;

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
           const bool any_loss = named.empty() && !way.empty();
           if (any_loss) return !of_case.needs.empty() && std::ranges::all_of(of_case.needs, is_of_radio);
           return is_one_of({named}, of_case.needs);
         });
}

// What the AGVs of each failure had said before, and no fleet ever says now: the software no longer does what the word
// names. None if no fleet says any word as before: it speaks another language.
Words words_no_longer_said(const Words& ever_said, const Words& always_said_before, const Words& usually_said_before) {
  const auto is_gone = [&](const std::string& word) { return !names_all(ever_said, {word}); };
  Words gone;
  std::ranges::copy_if(always_said_before, std::back_inserter(gone), is_gone);
  const bool is_other_language =
      gone.size() == always_said_before.size() && std::ranges::all_of(usually_said_before, is_gone);
  return is_other_language ? Words{} : gone;
}

// What the AGVs of each failure say now, and no fleet said before; nor does nearly every fleet say it that does not
// fail (those words stand apart), or it would be chance that all that fail do. Empty if nothing is known of before.
std::string new_word(const NeighbourCounts& now, const Words& ever_said_before) {
  if (now.alike < kFewestNew || ever_said_before.empty()) return {};
  const auto is_new = [&](const std::string& word) {
    const auto said = now.said.by_passing.find(word);
    const double share = said == now.said.by_passing.end()
                             ? 0.0
                             : static_cast<double>(said->second) / static_cast<double>(now.said.passing);
    return !names_all(ever_said_before, {word}) && std::pow(share, static_cast<double>(now.alike)) < kNewKindChance;
  };
  const auto found = std::ranges::find_if(now.said.always, is_new);
  return found == now.said.always.end() ? std::string() : fmt::format("it {}", trait_of_word(*found));
}

// It says them in each failure that is the kept one.
KeptFailure with_words(KeptFailure kept, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (!names_all(kept.says, {word})) kept.says.push_back(word);
  }
  return kept;
}

// What neighbours need that fail with the same end, if no failure that was known is among them, or cannot be most of
// them. Empty: it is.
std::string other_mechanism(CaseHost& host, const KeptFailure& kept, const std::vector<OtherKind>& others_known,
                            const Neighbourhood& neighbourhood, const NeighbourCounts& now, Retest& result) {
  const auto first = needs_of_neighbours(host, neighbourhood, now.first_alike);
  const auto is_kept = [&](const FailureNeeds& found) {
    return is_one_of(kept, found) ||
           std::ranges::any_of(others_known, [&](const OtherKind& known) { return is_one_of(known.failure, found); });
  };
  const auto is_other = [&](const FailureNeeds& found) {
    return !found.is_rare && !is_kept(found) && !may_be(kept, found);
  };
  const auto others = static_cast<std::size_t>(std::ranges::count_if(first, is_other));
  result.looked_at = first.size();
  result.known_other = others;
  result.known_kept = static_cast<std::size_t>(
      std::ranges::count_if(first, [&](const FailureNeeds& found) { return is_one_of(kept, found); }));
  if (now.alike < kFewestNew) return "";
  const auto known = static_cast<std::size_t>(std::ranges::count_if(first, is_kept));
  if (2 * others > first.size() || others > known) return text_of_new(kept, *std::ranges::find_if(first, is_other));
  return std::ranges::any_of(first, is_kept) ? "" : text_of_new(kept, first.front());
}

bool is_rarer_share(std::size_t alike, std::size_t of, std::size_t alike_before, std::size_t of_before) {
  return of_before > 0 && fisher_exact(alike, of, alike_before, of_before).first_smaller < kRarerChance;
}

// Something was mended, not all. Worlds still draw, so their share does not change with the timing of the
// software. Where only all neighbours were counted: below three quarters is no accident of timing.
bool is_rarer(const NeighbourCounts& now, const NeighbourCounts& before) {
  if (before.of_world > 0)
    return is_rarer_share(now.alike_of_world, now.of_world, before.alike_of_world, before.of_world);
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

// What most of the first whole runs show that fail with the same end: the kept failure, or a new one. Others that were
// known do not count.
void look_at_whole_failures(CaseHost& host, const KeptFailure& kept, const std::vector<KeptFailure>& others,
                            Retest& result) {
  std::string new_kind;
  std::size_t kept_ones = 0, new_ones = 0;
  for (const FailureNeeds& found :
       needs_of_neighbours(host, Neighbourhood::of_runs(kept), result.whole_runs.first_alike)) {
    if (found.is_rare) continue;
    if (may_be(kept, found)) {
      ++kept_ones;
    } else if (std::ranges::none_of(others, [&](const KeptFailure& other) { return may_be(other, found); })) {
      ++new_ones;
      if (new_kind.empty()) new_kind = text_of_new(kept, found);
    }
  }
  if (new_ones > kept_ones && result.whole_runs.alike >= kFewestNew) {
    result.new_kind = std::move(new_kind);
    result.verdict = RetestVerdict::NewKind;
  } else if (kept_ones > 0) {
    result.verdict = RetestVerdict::StillThere;
  }
}

// What fails needs what the kept failure needs, and comes about in another way, or says a word of its own.
void compare_signs(const NeighbourCounts& before, Retest& result, const NeighbourCounts& now,
                   const std::vector<OtherKind>& others = {}) {
  // Where nothing is known of another finding, it may be that one.
  const auto may_be_other = [&](const OtherKind& other) {
    return other.circumstances.empty() || std::ranges::any_of(other.circumstances, [&](const Circumstances& known) {
             return std::ranges::any_of(now.circumstances, [&](const Circumstances& some) {
               return !some.empty() && told_apart_by(known, some).empty();
             });
           });
  };
  std::string sign = new_word(now, before.said.ever);
  if (sign.empty() && std::ranges::none_of(others, may_be_other)) {
    const std::string apart = told_apart_by(before.circumstances, now.circumstances);
    if (!apart.empty()) sign = fmt::format("{} (medians; \"later\" is the AGV that set off last)", apart);
  }
  if (sign.empty()) return;
  result.new_kind = std::move(sign);
  result.verdict = RetestVerdict::NewKind;
}

// Neighbours that pass, or fail as often as before, may have nothing left with which other faults or half a mend show.
void judge_whole_runs(CaseHost& host, const KeptFailure& found, const NeighbourCounts& before, std::uint32_t runs,
                      const KnownRuns& known, Retest& result) {
  const NeighbourCounts& now = result.whole_runs = try_whole_runs(host, found, runs);
  if (now.of == 0) return;
  if (result.verdict == RetestVerdict::Dodged) {
    const auto worlds = [](const NeighbourCounts& all) { return std::pair(all.alike_of_world, all.of_world); };
    const auto [alike, of] = worlds(result.now);
    const auto [alike_before, of_before] = worlds(before);
    const NeighbourCounts& then = known.counts;
    if (then.of == 0) return;
    compare_signs(then, result, now, known.others);
    if (result.verdict == RetestVerdict::NewKind) return;
    if (is_rarer_share(now.alike, now.of, then.alike, then.of) ||
        is_rarer_share(now.alike + alike, now.of + of, then.alike + alike_before, then.of + of_before))
      result.verdict = RetestVerdict::StillThere;
    return;
  }
  result.new_kind = more_often(now, known.counts);
  if (!result.new_kind.empty()) {
    result.verdict = RetestVerdict::NewKind;
    return;
  }
  const auto kept_now = [&](const KeptFailure& kept, const Words& always_said, const Words& usually_said) {
    return with_words(kept,
                      words_no_longer_said(all_of(now.said.ever, result.now.said.ever), always_said, usually_said));
  };
  std::vector<KeptFailure> others;
  // What was known before does not explain that many more fail now.
  const bool is_more =
      known.counts.of > 0 &&
      fisher_exact(known.counts.alike, known.counts.of, now.alike, now.of).first_smaller < kNewKindChance;
  if (!is_more) {
    for (const OtherKind& other : known.others)
      others.push_back(kept_now(other.failure, other.always_said, other.usually_said));
  }
  look_at_whole_failures(host, kept_now(found, before.said.always, before.said.usually), others, result);
  if (result.verdict == RetestVerdict::StillThere) compare_signs(known.counts, result, now, known.others);
}

RetestVerdict verdict_of_none(CaseHost& host, const KeptFailure& kept, const NeighbourCounts& before, Retest& result) {
  const NeighbourCounts& now = result.now;
  result.new_kind = more_often(now, before);
  const StandingFleets standing = standing_fleets(host, kept, now, before);
  result.standing = standing.text;
  const bool is_telling = before.of > 0 && now.of * before.alike >= kEnoughBefore * before.of;
  return !result.new_kind.empty()                ? RetestVerdict::NewKind
         : is_telling && !standing.is_everywhere ? RetestVerdict::Fixed
                                                 : RetestVerdict::NotKnown;
}

}  // namespace

Retest retest(CaseHost& host, const KeptFailure& found, const NeighbourCounts& before, std::uint32_t neighbours,
              const KnownRuns& known) {
  Retest result;
  const auto of_case = needs_of(host, found.smallest);
  const Neighbourhood neighbourhood(host, found);
  result.now = try_neighbours(host, found, neighbourhood, neighbours);
  const NeighbourCounts& now = result.now;
  const auto ever_said = of_case ? all_of(now.said.ever, of_case->said) : now.said.ever;
  const KeptFailure kept = with_words(found, words_no_longer_said(ever_said, before.said.always, before.said.usually));
  result.upper_bound = upper_bound(now.alike, now.of, Confidence{0.95});
  result.case_fails = of_case && is_kept_one(kept, *of_case);
  if (result.case_fails) {
    result.verdict = RetestVerdict::StillThere;
  } else if (of_case && of_case->end == kept.end) {
    result.new_kind = text_of_new(kept, *of_case);
    result.verdict = RetestVerdict::NewKind;
  } else if (now.alike > 0) {
    result.new_kind = other_mechanism(host, kept, known.others, neighbourhood, now, result);
    result.verdict = !result.new_kind.empty() ? RetestVerdict::NewKind
                     : is_rarer(now, before)  ? RetestVerdict::StillThere
                                              : RetestVerdict::Dodged;
  }
  // Too few for a kind of their own, and none of them is the kept failure.
  const bool are_all_others = result.new_kind.empty() && result.known_other == now.alike;
  if (!result.case_fails && are_all_others) {
    result.upper_bound = upper_bound(0, now.of, Confidence{0.95});
    result.verdict = verdict_of_none(host, kept, before, result);
  }
  if (result.verdict != RetestVerdict::NewKind && now.alike > 0) compare_signs(before, result, now);
  const bool is_sure = result.verdict == RetestVerdict::NewKind ||
                       (result.verdict == RetestVerdict::StillThere && (result.case_fails || now.alike >= kFewestNew));
  if (!is_sure) judge_whole_runs(host, found, before, neighbours, known, result);
  return result;
}

}  // namespace fleetproof
