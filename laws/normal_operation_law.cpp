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
// Records that wait: four megabytes, or 168 kilobytes for each AGV.
constexpr std::size_t kMostWaiting = 98'304, kMostWaitingOfAgv = 4'096;
constexpr std::size_t kPartLetGo = 8;  // of them, the eighth part at least: seldom enough

// Of the instants a second apart from `next` on, the last one before `t`. Requires: next < t.
SimTime last_of(SimTime next, SimTime t) { return next + (t - next - Duration{1}) / kSecond * kSecond; }

struct Operation {
  bool safe = false, busy = false;
  SimTime in_contract_since = kStart;
  std::optional<std::size_t> incident;  // its safe mode, being accused
};

struct Fleet {
  std::vector<Operation> agvs;
  std::size_t safe = 0, busy = 0;  // AGVs
};

class NormalOperationLaw final : public Law {
 public:
  explicit NormalOperationLaw(const Scenario& scenario)
      : scenario_(scenario),
        quality_(scenario.participant_count()),
        most_waiting_(std::max(kMostWaiting, kMostWaitingOfAgv * scenario.agvs.size())),
        fleet_{std::vector<Operation>(scenario.agvs.size())},
        faults_(scenario) {}

  Pieces hears_pieces() const override { return Pieces::None; }
  TraceKinds reads() const override {
    return TraceKinds{TraceKind::SafeMode,       TraceKind::OrderReleased, TraceKind::TransportDone,
                      TraceKind::ActivityBegins, TraceKind::ActivityEnds,  TraceKind::LoadMoves} |
           FaultWatch::reads();
  }
  void happened(const TraceRecord& record) override;
  bool hears_together() const override { return true; }
  void together(const TracePart& part) override {
    if (part.begin == part.end) return;
    quality_.note(part);
    if (quality_.waiting() >= most_waiting_) make_room(part.block->at(part.end - 1));
  }
  void hears_from(TraceSource& source) override { source_ = &source; }
  void finish(SimTime end) override;
  LawResults findings() const override;

 private:
  void make_room(SimTime t);
  SimTime matters_from(SimTime t) const;
  void seconds_before(SimTime t);
  void nothing_goes_on();
  bool needs_quality(SimTime now) const;
  bool reaches_computers(std::size_t agv) const;
  bool stands_still(SimTime now) const;
  void follow_links(SimTime now);
  void look(SimTime now);
  void look_at_safe_mode(std::size_t agv, SimTime now);
  void look_at_standstill(SimTime now);

  const Scenario& scenario_;
  TraceSource* source_ = nullptr;
  LinkQuality quality_;
  std::size_t most_waiting_;
  Fleet fleet_;
  FaultWatch faults_;
  std::uint64_t open_ = 0, done_ = 0;
  SimTime active_at_ = kStart, all_in_contract_since_ = kStart, next_ = kStart + kSecond, followed_ = kStart;
  bool always_in_contract_ = true;
  std::optional<std::size_t> standstill_;
  std::vector<Incident> incidents_;
};

// How many AGVs are in a state that one of them enters or leaves.
void count(std::size_t& agvs, bool& is_in_it, bool now) {
  if (is_in_it != now) now ? ++agvs : --agvs;
  is_in_it = now;
}

void NormalOperationLaw::happened(const TraceRecord& record) {
  if (next_ < record.at) {
    if (source_ != nullptr && needs_quality(last_of(next_, record.at))) source_->hand_over();
    seconds_before(record.at);
  }
  if (record.kind == TraceKind::ActivityBegins || record.kind == TraceKind::ActivityEnds) {
    if (!keeps_busy(traced::activity_of(record))) return;
    count(fleet_.busy, fleet_.agvs[record.entity.index()].busy, record.kind == TraceKind::ActivityBegins);
    active_at_ = record.at;
    return;
  }
  if (faults_.note(record)) return;
  switch (record.kind) {
    case TraceKind::SafeMode:
      count(fleet_.safe, fleet_.agvs[record.entity.index()].safe, read<traced::SafeMode>(record).on);
      break;
    case TraceKind::OrderReleased:
      if (open_++ == 0) active_at_ = record.at;  // from now on there are open transports
      break;
    case TraceKind::TransportDone:
      open_ -= open_ > 0 ? 1 : 0;
      ++done_;
      break;
    case TraceKind::LoadMoves:
      if (read<traced::LoadMoves>(record).to.is_gone()) open_ -= open_ > 0 ? 1 : 0;  // no AGV can carry it out any more
      break;
    default:
      break;
  }
}

// A look at the end of every second that is over before `t`. Most runs are in order: what could be wrong at the last of
// these seconds was not there at the ones before either, so that they need no look each.
void NormalOperationLaw::seconds_before(SimTime t) {
  if (next_ >= t) return;
  const SimTime last = last_of(next_, t);
  if (needs_quality(last)) {
    for (; next_ < t; next_ += kSecond) look(next_);
  } else {
    nothing_goes_on();
    next_ = last + kSecond;
  }
}

// Whether it matters now how good the links are, and have been. If it does, and nothing happens, it does so from now
// on.
bool NormalOperationLaw::needs_quality(SimTime now) const {
  return fleet_.safe > 0 || stands_still(now) || scenario_.law.min_transports_per_agv_hour > 0.0;
}

// Too many records wait; `t` is that of the newest. Those that can matter no more are let go. If they are few, the
// links are followed as well, as long as it takes.
void NormalOperationLaw::make_room(SimTime t) {
  seconds_before(t);
  const std::int64_t second = (matters_from(t) - kStart) / kSecond - kQualityWindow_s;
  if (!(scenario_.law.min_transports_per_agv_hour > 0.0) && second > (followed_ - kStart) / kSecond) {
    quality_.skip_to(second);
    followed_ = kStart + second * kSecond;
  }
  const std::size_t enough = most_waiting_ - most_waiting_ / kPartLetGo;
  while (quality_.waiting() > enough && followed_ < next_ - kSecond) follow_links(followed_ + kSecond);
}

// From when on it can matter, at seconds from `t` on, whether the links kept the contract. An AGV is accused only if
// they have done so for longer than the reaction takes. A fleet is accused only if they have done so for longer than it
// stands still, which it can do from when no AGV is at work and transports are open.
SimTime NormalOperationLaw::matters_from(SimTime t) const {
  const bool may_stand_still = fleet_.busy == 0 && open_ > 0;
  return std::min(t - seconds(scenario_.law.reaction_s), may_stand_still ? std::max(active_at_, faults_.last()) : t);
}

bool NormalOperationLaw::stands_still(SimTime now) const {
  return fleet_.busy == 0 && open_ > 0 && !faults_.holds_anybody() &&
         now - std::max(active_at_, faults_.last()) >= scenario_.stuck_after;
}

void NormalOperationLaw::nothing_goes_on() {
  if (incidents_.empty()) return;
  for (Operation& agv : fleet_.agvs) agv.incident.reset();
  standstill_.reset();
}

// Second by second.
void NormalOperationLaw::follow_links(SimTime now) {
  while (followed_ < now) {
    followed_ += kSecond;
    quality_.end_second((to_ns(followed_) - 1) / 1'000'000'000);
    bool all = true;
    for (std::size_t i = 0; i < fleet_.agvs.size(); ++i) {
      const bool kept = quality_.all_in_contract(i) && reaches_computers(i);
      if (!kept) fleet_.agvs[i].in_contract_since = followed_;
      all = all && kept;
    }
    if (!all) all_in_contract_since_ = followed_;
    always_in_contract_ = always_in_contract_ && all;
  }
}

// A link between two AGVs is one to an AGV; one from an AGV to a computer is not.
bool NormalOperationLaw::reaches_computers(std::size_t agv) const {
  for (std::size_t i = scenario_.first_computer().index(); i < scenario_.participant_count(); ++i) {
    if (!quality_.link(agv, i).in_contract()) return false;
  }
  return true;
}

void NormalOperationLaw::look(SimTime now) {
  if (needs_quality(now)) follow_links(now);
  for (std::size_t i = 0; i < fleet_.agvs.size(); ++i) look_at_safe_mode(i, now);
  look_at_standstill(now);
}

void NormalOperationLaw::look_at_safe_mode(std::size_t agv, SimTime now) {
  Operation& state = fleet_.agvs[agv];
  if (!state.safe || now - state.in_contract_since <= seconds(scenario_.law.reaction_s)) {
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
  const double agv_hours = to_seconds(end) * static_cast<double>(fleet_.agvs.size()) / 3600.0;
  if (!(scenario_.law.min_transports_per_agv_hour > 0.0) || open_ == 0 || !always_in_contract_ || !(agv_hours > 0.0))
    return;
  const double rate = transports_per_agv_hour(done_, agv_hours);
  if (rate < scenario_.law.min_transports_per_agv_hour) {
    incidents_.push_back({IncidentKind::ThroughputBelowFloor, {}, {}, kStart, end, std::llround(rate * 1000.0)});
  }
}

LawResults NormalOperationLaw::findings() const {
  LawResults findings;
  findings.incidents = incidents_;
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_normal_operation_law(const Scenario& scenario) {
  return std::make_unique<NormalOperationLaw>(scenario);
}

}  // namespace fleetproof
