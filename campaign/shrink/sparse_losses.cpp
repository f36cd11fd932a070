#include "campaign/shrink/sparse_losses.hpp"

#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/other_draws.hpp"

namespace fleetproof {
namespace {

constexpr double kWindows_s[] = {0.25, 0.5, 1.0, 2.0, 4.0};
constexpr double kLosses[] = {0.02, 0.05, 0.1, 0.2};
constexpr std::uint32_t kDrawsOfALoss = 100;

// The kinds of trouble that the radio of a scenario makes, each alone and at its worst.
std::vector<RadioSetup> troubles_of(const RadioSetup& radio) {
  std::vector<RadioSetup> troubles;
  if (radio.loss > 0.0) troubles.emplace_back(perfect(radio)).loss = 1.0;
  if (radio.delay_s > 0.0) troubles.emplace_back(perfect(radio)).delay_s = radio.delay_s;
  if (radio.duplicates > 0.0) {
    RadioSetup& doubled = troubles.emplace_back(perfect(radio));
    doubled.duplicates = 1.0;
    doubled.delay_s = radio.delay_s;
    doubled.delay_model = RadioSetup::DelayModel::Uniform;
  }
  return troubles;
}

}  // namespace

std::vector<Scenario> with_sparse_losses(const Scenario& scenario, SimTime failure) {
  std::vector<Scenario> cases;
  const auto troubles = troubles_of(scenario.radio);
  const double end_s = to_seconds(failure - kStart);
  for (const double window_s : kWindows_s) {
    for (double from_s = end_s - window_s; from_s > -window_s; from_s -= window_s / 2.0) {
      for (const RadioSetup& trouble : troubles) {
        Scenario& sparse = cases.emplace_back(scenario);
        sparse.radio = trouble;
        sparse.radio.adverse = {from_s > 0.0 ? from_s : 0.0, from_s + window_s};
      }
    }
  }
  if (scenario.radio.loss == 0.0) return cases;
  for (const double loss : kLosses) {
    for (std::uint32_t draw = 1; draw <= kDrawsOfALoss; ++draw) {
      Scenario sparse = scenario;
      sparse.radio = perfect(scenario.radio);
      sparse.radio.loss = loss;
      cases.push_back(with_other_draws(std::move(sparse), draw));
    }
  }
  return cases;
}

}  // namespace fleetproof
