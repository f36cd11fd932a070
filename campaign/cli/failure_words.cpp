#include "campaign/cli/failure_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/shown_time.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::size_t kMostOthers = 6;

// What a run can be looked at for.
std::vector<std::string> end_point_words() {
  std::vector<std::string> words;
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if (end_point != EndPoint::Throughput) words.emplace_back(name_of(end_point));
  }
  return words;
}

EndPoint end_point_of(const std::string& word) {
  const auto found = value_of<EndPoint>(word);
  if (found && *found != EndPoint::Throughput) return *found;
  throw InputError("--failure", fmt::format("{} is no failure of a run; it is one of {}", in_quotes(word),
                                            fmt::join(end_point_words(), ", ")));
}

// How near two bodies came, the mildest first. A run with one of them has those before it, too: each contact is also a
// violation.
constexpr std::array kLevels = {EndPoint::Violation, EndPoint::Contact, EndPoint::HazardousContact};

// A contact is none the less for being over.
bool has_passed(const RunFailure& failure) {
  return failure.end_point && failure.weight() < info_of(*failure.end_point).weight;
}

}  // namespace

void add_failure_option(Options& options, std::string& word) {
  options.option("--failure", word,
                 "look at this failure of the run: violation, contact, deadlock, ... (default: the heaviest)");
}

FailureChoice choice_of(const std::string& word) {
  return word.empty() ? FailureChoice{} : FailureChoice{bit_of(end_point_of(word))};
}

FailureChoice choice_of(const std::string& word, const Outcome& outcome) {
  if (word.empty()) return {};
  const EndPoint wanted = end_point_of(word);
  std::vector<EndPoint> meant{wanted};
  const auto* const level = std::ranges::find(kLevels, wanted);
  if (level != kLevels.end()) meant.assign(level, kLevels.end());
  for (const EndPoint end_point : meant) {
    if (chosen_failure(outcome, {bit_of(end_point)})) return {bit_of(end_point)};
  }
  std::set<std::string> present;
  for (const RunFailure& failure : failures_of(outcome)) {
    if (failure.end_point) present.insert(name_of(*failure.end_point));
  }
  throw InputError("--failure", fmt::format("the run has no failure {}; it has {}", in_quotes(word),
                                            present.empty() ? "none" : fmt::format("{}", fmt::join(present, ", "))));
}

std::string told(const RunFailure& failure) {
  std::string bodies;
  if (failure.a.valid()) bodies = fmt::format("body {}", failure.a.value);
  if (failure.b.valid()) bodies = fmt::format("bodies {} and {}", failure.a.value, failure.b.value);
  return fmt::format("{} at {:.3f} s{}", failure.what, shown_seconds(failure.at),
                     bodies.empty() ? "" : " (" + bodies + ")");
}

std::string others_line(const Outcome& outcome, const RunFailure& told, OptionNamed option) {
  std::vector<std::string> parts;
  std::set<std::string> named;
  std::set<EndPoint> reached;  // by the option: the first of each end point
  if (told.end_point) reached.insert(*told.end_point);
  std::size_t more = 0;
  for (const RunFailure& failure : failures_of(outcome)) {
    const bool is_it = is_same_failure(failure, told) && failure.at == told.at;
    if (is_it || !named.insert(fmt::format("{}{}{}", failure.what, failure.is_judged, failure.is_over)).second)
      continue;
    if (parts.size() == kMostOthers) {
      ++more;
      continue;
    }
    std::string part = fmt::format("{} from {:.3f} s", failure.what, shown_seconds(failure.at));
    if (has_passed(failure)) part += ", over before the end";
    if (!failure.is_judged) part += ", not judged";
    if (failure.end_point && option == OptionNamed::Yes && reached.insert(*failure.end_point).second)
      part += fmt::format(" (--failure {})", name_of(*failure.end_point));
    parts.push_back(std::move(part));
  }
  if (parts.empty()) return "";
  return fmt::format("also in this run: {}{}", fmt::join(parts, "; "), more == 0 ? "" : fmt::format("; {} more", more));
}

}  // namespace fleetproof::cli
