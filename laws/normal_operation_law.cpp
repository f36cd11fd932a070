#include "laws/normal_operation_law.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/outcome/trace_records.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "laws/fault_watch.hpp"
#include "laws/link_quality.hpp"

namespace fleetproof {
namespace {

constexpr Duration kSecond = std::chrono::seconds(1);
// Records of messages that wait: less than three megabytes, or 82 kilobytes for each AGV.
constexpr std::size_t kMostWaiting = 65'536, kMostWaitingOfAgv = 2'048;

class NormalOperationLaw final : public Law {
 public:
  explicit NormalOperationLaw(const Scenario& scenario)
      : scenario_(scenario),
        reaction_(seconds(scenario.law.reaction_s)),
        quality_(scenario.agvs.size()),
        most_waiting_(std::max(kMostWaiting, kMostWaitingOfAgv * scenario.agvs.size())),
        agvs_(scenario.agvs.size()),
        faults_(scenario) {}

  void piece_ended(const Piece&) override {}
  TraceKinds reads() const override {
    return LinkQuality::reads() |
           TraceKinds{TraceKind::SafeMode,       TraceKind::OrderReleased, TraceKind::TransportDone,
                      TraceKind::ActivityBegins, TraceKind::ActivityEnds,  TraceKind::LoadMoves} |
           FaultWatch::reads();
  }
  void happened(const TraceRecord& record) override;
  bool hears_messages_together() const override { return true; }
  void messages(std::span<const TraceRecord> records) override {
    quality_.note(records);
    if (quality_.waiting() >= most_waiting_) seconds_before(records.back().at);
  }
  void finish(SimTime end) override;
  LawFindings findings() const override;

 private:
  struct AgvState {
    bool safe = false, busy = false;
    SimTime in_contract_since = kStart;
    std::optional<std::size_t> incident;  // its safe mode, being accused
  };

  void seconds_before(SimTime t);
  bool needs_quality(SimTime now) const;
  bool stands_still(SimTime now) const;
  void follow_links(SimTime now);
  void look(SimTime now);
  void look_at_safe_mode(std::size_t agv, SimTime now);
  void look_at_standstill(SimTime now);

  const Scenario& scenario_;
  Duration reaction_;
  LinkQuality quality_;
  std::size_t most_waiting_;
  std::vector<AgvState> agvs_;
  FaultWatch faults_;
  std::uint64_t open_ = 0, done_ = 0;
  SimTime active_at_ = kStart, all_in_contract_since_ = kStart, next_ = kStart + kSecond, followed_ = kStart;
  bool always_in_contract_ = true;
  std::optional<std::size_t> standstill_;
  std::vector<Incident> incidents_;
};

void NormalOperationLaw::happened(const TraceRecord& record) {
  seconds_before(record.at);
  if (faults_.note(record)) return;
  switch (record.kind) {
    case TraceKind::SafeMode:
      agvs_[record.entity.index()].safe = read<traced::SafeMode>(record).on;
      break;
    case TraceKind::OrderReleased:
      if (open_++ == 0) active_at_ = record.at;  // from now on there are open transports
      break;
    case TraceKind::TransportDone:
      open_ -= open_ > 0 ? 1 : 0;
      ++done_;
      break;
    case TraceKind::LoadMoves:
      if (read<traced::LoadMoves>(record).to.kind == Holder::Kind::ClearedAway)
        open_ -= open_ > 0 ? 1 : 0;  // no AGV can carry it out any more
      break;
    case TraceKind::ActivityBegins:
    case TraceKind::ActivityEnds: {
      if (!is_work(traced::activity_of(record))) break;
      agvs_[record.entity.index()].busy = record.kind == TraceKind::ActivityBegins;
      active_at_ = record.at;
      break;
    }
    default:
      break;
  }
}

// A look at the end of every second that is over before `t`.
void NormalOperationLaw::seconds_before(SimTime t) {
  for (; next_ < t; next_ += kSecond) look(next_);
}

// Whether it matters now how good the links are, and have been.
bool NormalOperationLaw::needs_quality(SimTime now) const {
  return scenario_.law.min_transports_per_agv_hour > 0.0 || stands_still(now) ||
         std::ranges::any_of(agvs_, &AgvState::safe) || quality_.waiting() >= most_waiting_;
}

bool NormalOperationLaw::stands_still(SimTime now) const {
  return open_ > 0 && !faults_.holds_anybody() && now - std::max(active_at_, faults_.last()) >= scenario_.stuck_after &&
         std::ranges::none_of(agvs_, &AgvState::busy);
}

// Second by second.
void NormalOperationLaw::follow_links(SimTime now) {
  while (followed_ < now) {
    followed_ += kSecond;
    quality_.end_second((to_ns(followed_) - 1) / 1'000'000'000);
    bool all = true;
    for (std::size_t i = 0; i < agvs_.size(); ++i) {
      const bool kept = quality_.all_in_contract(i);
      if (!kept) agvs_[i].in_contract_since = followed_;
      all = all && kept;
    }
    if (!all) all_in_contract_since_ = followed_;
    always_in_contract_ = always_in_contract_ && all;
  }
}

void NormalOperationLaw::look(SimTime now) {
  if (needs_quality(now)) follow_links(now);
  for (std::size_t i = 0; i < agvs_.size(); ++i) look_at_safe_mode(i, now);
  look_at_standstill(now);
}

void NormalOperationLaw::look_at_safe_mode(std::size_t agv, SimTime now) {
  AgvState& state = agvs_[agv];
  if (!state.safe || now - state.in_contract_since <= reaction_) {
    state.incident.reset();
    return;
  }
  const std::int64_t loss_ppm = quality_.worst_loss_ppm(agv);
  if (!state.incident) {
    state.incident = incidents_.size();
    incidents_.push_back({IncidentKind::SafeModeInContract, EntityId{agv}, {}, now, now, loss_ppm});
  }
  Incident& incident = incidents_[*state.incident];
  incident.last = now;
  incident.value = std::max(incident.value, loss_ppm);
}

void NormalOperationLaw::look_at_standstill(SimTime now) {
  const SimTime since = std::max({active_at_, all_in_contract_since_, faults_.last()});
  if (!stands_still(now) || now - since < scenario_.stuck_after) {
    standstill_.reset();
    return;
  }
  if (!standstill_) {
    standstill_ = incidents_.size();
    incidents_.push_back({IncidentKind::StandstillInContract, {}, {}, since, now, 0});
  }
  incidents_[*standstill_].last = now;
  incidents_[*standstill_].value = static_cast<std::int64_t>(open_);
}

void NormalOperationLaw::finish(SimTime end) {
  seconds_before(end + Duration{1});
  const double agv_hours = to_seconds(end) * static_cast<double>(agvs_.size()) / 3600.0;
  if (!(scenario_.law.min_transports_per_agv_hour > 0.0) || open_ == 0 || !always_in_contract_ || !(agv_hours > 0.0))
    return;
  const double rate = transports_per_agv_hour(done_, agv_hours);
  if (rate < scenario_.law.min_transports_per_agv_hour) {
    incidents_.push_back({IncidentKind::ThroughputBelowFloor, {}, {}, kStart, end, std::llround(rate * 1000.0)});
  }
}

LawFindings NormalOperationLaw::findings() const {
  LawFindings findings;
  findings.incidents = incidents_;
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_normal_operation_law(const Scenario& scenario) {
  return std::make_unique<NormalOperationLaw>(scenario);
}

}  // namespace fleetproof
