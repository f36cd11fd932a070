#include "reports/evidence/release_gate.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

constexpr double kMostGateUnits = 1e15;
constexpr double kShares[] = {10.0, 3.0};  // limit / q

// Whether the gate passes, with 50 decimal digits.
class ExactDecision {
 public:
  ExactDecision(std::uint64_t failing, double limit, Confidence confidence)
      : failing_(failing), log_passed_at_zero_(-log(1 - Exact(limit))), log_goal_(log(3 / Exact(confidence.risk()))) {
    for (std::size_t i = 0; i < std::size(kShares); ++i) {
      const Exact share = kShares[i];
      log_failed_[i] = -log(share);
      log_passed_[i] = log(1 - Exact(limit) / share) + log_passed_at_zero_;
    }
  }

  bool passes(std::uint64_t units) const {
    const Exact failed = failing_, passed = units - failing_;
    Exact sum = failing_ == 0 ? share_of_goal(passed * log_passed_at_zero_) : Exact(0);
    for (std::size_t i = 0; i < std::size(kShares); ++i)
      sum += share_of_goal(failed * log_failed_[i] + passed * log_passed_[i]);
    return sum >= 1;
  }

 private:
  // e^log_e as a part of the sum that the gate needs. Beyond these limits it decides alone, or not at all.
  Exact share_of_goal(const Exact& log_e) const {
    const Exact log_share = log_e - log_goal_;
    if (log_share > 1) return 2;
    return log_share < -200 ? Exact(0) : Exact(exp(log_share));
  }

  std::uint64_t failing_;
  Exact log_passed_at_zero_, log_goal_;
  Exact log_failed_[std::size(kShares)], log_passed_[std::size(kShares)];
};

// The number of trials as doubles see it: a few trials beside the exact one.
std::optional<std::uint64_t> units_nearby(std::uint64_t failing, double limit, Confidence confidence) {
  const auto passes = [&](double units) {
    return log_e_values(failing, static_cast<std::uint64_t>(units), limit).gate >= -std::log(confidence.risk());
  };
  double too_few = static_cast<double>(failing), plenty = too_few + 1.0;
  while (!passes(plenty)) {
    too_few = plenty;
    plenty *= 2.0;
    if (plenty > 2.0 * kMostGateUnits) return std::nullopt;
  }
  while (plenty - too_few > 1.0) {
    const double middle = std::floor((too_few + plenty) / 2.0);
    (passes(middle) ? plenty : too_few) = middle;
  }
  return static_cast<std::uint64_t>(plenty);
}

}  // namespace

LogEValues log_e_values(std::uint64_t failing, std::uint64_t units, double limit) {
  ensure(failing <= units, "no more trials fail than there are");
  ensure(limit > 0.0 && limit < 1.0, "a limit lies between 0 and 1");
  const auto failed = static_cast<double>(failing), passed = static_cast<double>(units - failing);
  const auto log_e = [&](double share) {
    const double q = limit / share;
    return -failed * std::log(share) + passed * std::log1p((limit - q) / (1.0 - limit));
  };
  LogEValues e;
  e.zero = failing == 0 ? -passed * std::log1p(-limit) : -std::numeric_limits<double>::infinity();
  e.tenth = log_e(kShares[0]);
  e.third = log_e(kShares[1]);
  const double largest = std::max({e.zero, e.tenth, e.third});
  e.gate = largest +
           std::log((std::exp(e.zero - largest) + std::exp(e.tenth - largest) + std::exp(e.third - largest)) / 3.0);
  return e;
}

std::optional<std::uint64_t> gate_units_needed(std::uint64_t failing, double limit, Confidence confidence) {
  auto units = units_nearby(failing, limit, confidence);
  if (!units) return std::nullopt;
  const ExactDecision decision(failing, limit, confidence);
  while (!decision.passes(*units)) ++*units;
  while (*units > failing && decision.passes(*units - 1)) --*units;
  if (static_cast<double>(*units) > kMostGateUnits) return std::nullopt;
  return units;
}

const std::vector<std::uint64_t>& ReleaseGate::table(std::uint64_t most_failing) {
  while (needed_.size() <= most_failing) {
    const auto next = gate_units_needed(needed_.size(), limit_, confidence_);
    if (!next) break;
    needed_.push_back(*next);
  }
  return needed_;
}

bool ReleaseGate::passes(std::uint64_t failing, std::uint64_t units) {
  ensure(failing <= units, "no more trials fail than there are");
  const auto& needed = table(failing);
  return failing < needed.size() && units >= needed[failing];
}

}  // namespace fleetproof
