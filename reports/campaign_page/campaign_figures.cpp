#include "reports/campaign_page/campaign_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostCurves = 12;  // gates whose bound is followed
constexpr double kNextRecord = 1.2;      // points of a curve are so far apart
constexpr std::int64_t kStep_um = 10'000;

}  // namespace

void ClearanceCounts::add(const Outcome& outcome) {
  if (outcome.contact) {
    ++contact;
  } else if (!outcome.min_clearance_um) {
    ++(has_measured_clearance(outcome) ? farther : unmeasured);
  } else {
    const auto step = std::max<std::int64_t>(*outcome.min_clearance_um + 1, 0) / kStep_um;
    if (step < static_cast<std::int64_t>(kSteps)) {
      ++steps[static_cast<std::size_t>(step)];
    } else {
      ++farther;
    }
  }
}

std::uint64_t ClearanceCounts::runs() const { return farther + unmeasured + closer_than(kSteps); }

std::uint64_t ClearanceCounts::closer_than(std::size_t centimetres) const {
  const auto end = steps.begin() + static_cast<std::ptrdiff_t>(std::min(centimetres, kSteps));
  return std::accumulate(steps.begin(), end, contact);
}

void Discoveries::add(const std::string& name, std::uint64_t run) {
  if (seen.size() < kMost && seen.insert(name).second) first_seen.push_back(run);
}

void CampaignFigures::add(const RunRecord& run, const Evidence& evidence) {
  const auto& cells = evidence.cells();
  const std::string& agent = cells[run.cell].agent;
  AgentFigures& figures = agents_[agent];
  ++figures.runs;
  (run.factors.in_contract() ? figures.in_contract : figures.beyond).add(run.outcome);
  if (const auto failing = FailingRun::of(run))
    figures.failures.add(std::string(failing->severity()) + ": " + failing->cause.what, figures.runs);
  Coverage met;  // by the rules of the table of what the runs met, so that both have the same names
  met.add(run.outcome);
  for (const auto* names : {&met.by_the_world(), &met.by_agents()}) {
    for (const auto& [name, seen] : *names) figures.situations.add(name, figures.runs);
  }
  pending_time_.resize(cells.size());
  auto& time = pending_time_[run.cell];
  time.safe_mode_s += static_cast<double>(run.outcome.counters.safe_mode_ns) * 1e-9;
  time.all_s += static_cast<double>(run.outcome.simulated_ns) * 1e-9 * run.outcome.agv_count;
  if (run.cell + 1 == cells.size()) finish_replicate(evidence);
}

void CampaignFigures::finish_replicate(const Evidence& evidence) {
  time_.resize(pending_time_.size());
  for (std::size_t i = 0; i < time_.size(); ++i) {
    const Time done = std::exchange(pending_time_[i], Time{});
    time_[i].safe_mode_s += done.safe_mode_s;
    time_[i].all_s += done.all_s;
  }
  const auto replicates = evidence.complete_replicates();
  if (replicates < next_record_) return;
  record_bounds(evidence);
  next_record_ = std::max(replicates + 1, static_cast<std::uint64_t>(static_cast<double>(replicates) * kNextRecord));
}

void CampaignFigures::record_bounds(const Evidence& evidence) {
  const auto& gates = evidence.gates();
  bounds_.resize(gates.size());
  recorded_at_ = evidence.complete_replicates();
  std::size_t followed = 0;
  for (std::size_t i = 0; i < gates.size() && followed < kMostCurves; ++i) {
    if (!gates[i].decides || gates[i].method != GateMethod::AnyTime || evidence.cells_of(i).empty()) continue;
    ++followed;
    const GateResult result = evidence.judge(i);
    // A bound per AGV-hour is infinite as long as there are events and no time.
    if (result.claim && std::isfinite(result.claim->upper)) bounds_[i].push_back({recorded_at_, result.claim->upper});
  }
}

void CampaignFigures::finish(const Evidence& evidence) {
  bounds_.resize(evidence.gates().size());
  if (recorded_at_ != evidence.complete_replicates()) record_bounds(evidence);
}

std::optional<double> CampaignFigures::safe_mode_share(const std::vector<std::uint32_t>& cells) const {
  Time sum;
  for (const auto cell : cells) {
    if (cell >= time_.size()) continue;
    sum.safe_mode_s += time_[cell].safe_mode_s;
    sum.all_s += time_[cell].all_s;
  }
  if (sum.all_s <= 0.0) return std::nullopt;
  return sum.safe_mode_s / sum.all_s;
}

}  // namespace fleetproof::html
