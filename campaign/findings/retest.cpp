#include "campaign/findings/retest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "campaign/findings/finding.hpp"
#include "campaign/findings/ingredients.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/fisher.hpp"

namespace fleetproof {
namespace {

constexpr double kNewKindChance = 0.001;
// If software that fails as before had fewer failing neighbours than this in the mean, that none fails says little:
// with 10, it is chance once in 20 000 times.
constexpr std::size_t kEnoughBefore = 10, kOften = 10;

// Whether a failure that needs this may be the one that was kept.
bool is_one_of(const std::vector<std::vector<std::string>>& ways, const std::vector<std::string>& needs) {
  return std::ranges::any_of(
      ways, [&](const std::vector<std::string>& way) { return way.empty() ? needs.empty() : names_all(needs, way); });
}

bool is_of_radio(const std::string& need) {
  return need == kLateMessages || need == kLostMessages || need == kCopiedMessages;
}

// The smallest case names the messages that are lost or late in it, but not their kinds.
bool is_kept_one(const KeptFailure& kept, const FailureNeeds& of_case) {
  return of_case.end == kept.end && std::ranges::any_of(kept.ways, [&](const std::vector<std::string>& way) {
           const auto named = without_kinds(way);
           const bool any_bad_luck = named.empty() && !way.empty();
           if (any_bad_luck) return !of_case.needs.empty() && std::ranges::all_of(of_case.needs, is_of_radio);
           return is_one_of({named}, of_case.needs);
         });
}

// What neighbours need that fail with the same end, if the failure that was kept is not among them. Empty: it is.
std::string other_mechanism(CaseHost& host, const KeptFailure& kept, const Neighbourhood& neighbourhood,
                            const NeighbourCounts& now) {
  const auto ways = ways_of(host, neighbourhood, now);
  if (ways.empty() || std::ranges::any_of(ways, [&](const auto& needs) { return is_one_of(kept.ways, needs); }))
    return {};
  return Mechanism{kept.end, ways.front(), {}, {}}.text();
}

// Where neighbours failed often, less than three quarters of that is no accident of timing: something was mended, not
// all.
bool is_rarer(const NeighbourCounts& now, const NeighbourCounts& before) {
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

}  // namespace

Retest retest(CaseHost& host, const KeptFailure& kept, const NeighbourCounts& before, std::uint32_t neighbours) {
  Retest result;
  const auto of_case = needs_of(host, kept.smallest);
  const Neighbourhood neighbourhood(host, kept);
  result.now = try_neighbours(host, kept, neighbourhood, neighbours);
  const NeighbourCounts& now = result.now;
  result.upper_bound = upper_bound(now.alike, now.of, Confidence{0.95});
  if (of_case && is_kept_one(kept, *of_case)) {
    result.verdict = RetestVerdict::StillThere;
  } else if (of_case && of_case->end == kept.end) {
    result.new_kind = Mechanism{of_case->end, of_case->needs, {}, {}}.text();
    result.verdict = RetestVerdict::NewKind;
  } else if (now.alike > 0) {
    result.new_kind = other_mechanism(host, kept, neighbourhood, now);
    result.verdict = !result.new_kind.empty() ? RetestVerdict::NewKind
                     : is_rarer(now, before)  ? RetestVerdict::StillThere
                                              : RetestVerdict::Dodged;
  } else {
    result.new_kind = more_often(now, before);
    const bool is_telling = before.of > 0 && now.of * before.alike >= kEnoughBefore * before.of;
    result.verdict = !result.new_kind.empty() ? RetestVerdict::NewKind
                     : is_telling             ? RetestVerdict::Fixed
                                              : RetestVerdict::NotKnown;
  }
  return result;
}

}  // namespace fleetproof
