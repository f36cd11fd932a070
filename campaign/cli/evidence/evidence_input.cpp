#include "campaign/cli/evidence/evidence_input.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::array kArguments = {
    EvidenceArgument{"failing", "trials that failed"},
    EvidenceArgument{"units", "independent trials: runs, replicates or layouts"},
    EvidenceArgument{"confidence", "such as 0.95 (the default)"},
    EvidenceArgument{"alpha", "the risk, instead of the confidence, such as 0.05"},
    EvidenceArgument{"limit", "largest tolerated probability of failure, or rate"},
    EvidenceArgument{"events", "events that were counted"},
    EvidenceArgument{"exposure", "hours, or another unit of exposure"},
    EvidenceArgument{"prior-a", "first parameter of the beta prior (0.05)"},
    EvidenceArgument{"prior-b", "second parameter of the beta prior (1)"},
    EvidenceArgument{"prior-shape", "shape of the gamma prior (0.05)"},
    EvidenceArgument{"prior-rate", "rate of the gamma prior, in the unit of the exposure (1)"},
    EvidenceArgument{"at", "probability at which ln M is printed (0.01)"},
    EvidenceArgument{"true-rate", "probability with which each trial fails"},
    EvidenceArgument{"cap", "trials after which a campaign ends"},
    EvidenceArgument{"failing1", "trials of the first group that failed"},
    EvidenceArgument{"units1", "trials of the first group"},
    EvidenceArgument{"failing2", "trials of the second group that failed"},
    EvidenceArgument{"units2", "trials of the second group"},
    EvidenceArgument{"events1", "events in the first exposure"},
    EvidenceArgument{"exposure1", "first exposure"},
    EvidenceArgument{"events2", "events in the second exposure"},
    EvidenceArgument{"exposure2", "second exposure"},
    EvidenceArgument{"both", "pairs that fail in both releases"},
    EvidenceArgument{"only-old", "pairs that fail in the old release only"},
    EvidenceArgument{"only-new", "pairs that fail in the new release only"},
    EvidenceArgument{"neither", "pairs that fail in no release"},
    EvidenceArgument{"weights", "shares of operation, as in 0.9,0.1"},
    EvidenceArgument{"path", "cells loss:delay in the order of tests, as in 0:0,0:1,1:1"},
};

constexpr std::uint64_t kMostUnits = 1'000'000'000'000'000;
// Beyond this number of failures or events, the inverses of the beta and gamma functions are not found.
constexpr std::uint64_t kMostCounted = 1'000'000'000;

[[noreturn]] void refuse(const std::string& name, std::string_view value, std::string_view allowed) {
  throw InputError("--" + name, fmt::format("{} is refused; allowed: {}", in_quotes(value), allowed));
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::uint64_t count_in(const std::string& name, std::string_view text, std::uint64_t least, std::uint64_t most) {
  const auto value = number_in(text);
  const bool allowed = value && *value >= static_cast<double>(least) && *value <= static_cast<double>(most) &&
                       *value == std::floor(*value);
  if (!allowed) refuse(name, text, fmt::format("a whole number from {} to {}", least, most));
  return static_cast<std::uint64_t>(*value);
}

double number_between(double least, double most, const std::string& name, std::string_view text) {
  const auto value = number_in(text);
  if (!value || *value < least || *value > most)
    refuse(name, text, fmt::format("a number from {:g} to {:g}", least, most));
  return *value;
}

// Far enough from the largest and smallest doubles for every product and quotient of two.
double positive_in(const std::string& name, std::string_view text) { return number_between(1e-15, 1e18, name, text); }

double probability_in(const std::string& name, std::string_view text) {
  const auto value = number_in(text);
  if (!value || *value < 1e-15 || *value >= 1.0) refuse(name, text, "a number from 1e-15 to below 1");
  return *value;
}

std::vector<std::string_view> parts_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find_first_of(separators);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

constexpr std::string_view kInList = ",|";

}  // namespace

std::span<const EvidenceArgument> evidence_arguments() { return kArguments; }

const std::string& EvidenceInput::word(const std::string& name) const {
  const auto found = given_.find(name);
  if (found == given_.end()) throw InputError("--" + name, "is missing");
  return found->second;
}

std::uint64_t EvidenceInput::count(const std::string& name, std::uint64_t most) const {
  return count_in(name, word(name), 0, most);
}

std::uint64_t EvidenceInput::units(const std::string& name) const { return count(name, kMostUnits); }

std::uint64_t EvidenceInput::units_from_one(const std::string& name) const {
  return count_in(name, word(name), 1, kMostUnits);
}

std::uint64_t EvidenceInput::failures(const std::string& name) const { return count(name, kMostCounted); }

std::uint64_t EvidenceInput::failures(const std::string& name, const std::string& units) const {
  const std::uint64_t all = count(units, kMostUnits), value = failures(name);
  if (value > all) refuse(name, word(name), fmt::format("at most the {} of --{}", all, units));
  return value;
}

double EvidenceInput::positive(const std::string& name) const { return positive_in(name, word(name)); }

double EvidenceInput::positive(const std::string& name, double fallback) const {
  return has(name) ? positive(name) : fallback;
}

double EvidenceInput::prior(const std::string& name, double fallback) const {
  return has(name) ? number_between(1e-9, 1e6, name, word(name)) : fallback;
}

double EvidenceInput::probability(const std::string& name) const { return probability_in(name, word(name)); }

double EvidenceInput::probability(const std::string& name, double fallback) const {
  return has(name) ? probability(name) : fallback;
}

Confidence EvidenceInput::confidence() const {
  if (has("confidence") && has("alpha")) throw InputError("--alpha", "says the same as --confidence; leave one out");
  if (has("alpha")) return Confidence::with_risk(probability("alpha"));
  return Confidence(probability("confidence", 0.95));
}

std::vector<std::uint64_t> EvidenceInput::list(const std::string& name, std::uint64_t most) const {
  std::vector<std::uint64_t> values;
  for (const auto part : parts_of(word(name), kInList)) values.push_back(count_in(name, part, 0, most));
  return values;
}

std::vector<std::uint64_t> EvidenceInput::unit_list(const std::string& name) const { return list(name, kMostUnits); }

std::vector<std::uint64_t> EvidenceInput::failure_list(const std::string& name) const {
  return list(name, kMostCounted);
}

std::vector<double> EvidenceInput::positives(const std::string& name) const {
  std::vector<double> values;
  for (const auto part : parts_of(word(name), kInList)) values.push_back(positive_in(name, part));
  return values;
}

std::vector<double> EvidenceInput::weights(const std::string& name) const {
  std::vector<double> values;
  double sum = 0.0;
  for (const auto part : parts_of(word(name), kInList)) {
    values.push_back(number_between(0.0, 1.0, name, part));
    sum += values.back();
  }
  constexpr double kRounding = 1e-9;
  if (std::abs(sum - 1.0) > kRounding) refuse(name, word(name), fmt::format("weights with the sum 1, not {:g}", sum));
  return values;
}

std::vector<std::vector<std::uint64_t>> EvidenceInput::rows(const std::string& name, std::uint64_t most) const {
  std::vector<std::vector<std::uint64_t>> rows;
  for (const auto row : parts_of(word(name), "/")) {
    auto& values = rows.emplace_back();
    for (const auto part : parts_of(row, kInList)) values.push_back(count_in(name, part, 0, most));
    if (values.size() != rows.front().size()) refuse(name, word(name), "rows of one length, as in 1,2/3,4");
  }
  return rows;
}

std::vector<std::vector<std::uint64_t>> EvidenceInput::unit_rows(const std::string& name) const {
  return rows(name, kMostUnits);
}

std::vector<std::vector<std::uint64_t>> EvidenceInput::failure_rows(const std::string& name) const {
  return rows(name, kMostCounted);
}

std::vector<std::pair<std::size_t, std::size_t>> EvidenceInput::pairs(const std::string& name, std::size_t end_of_first,
                                                                      std::size_t end_of_second) const {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto part : parts_of(word(name), kInList)) {
    const auto numbers = parts_of(part, ":");
    if (numbers.size() != 2) refuse(name, part, "two whole numbers, as in 0:1");
    pairs.emplace_back(count_in(name, numbers[0], 0, end_of_first - 1),
                       count_in(name, numbers[1], 0, end_of_second - 1));
  }
  return pairs;
}

}  // namespace fleetproof::cli
