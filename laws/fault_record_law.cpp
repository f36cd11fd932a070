#include "laws/fault_record_law.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/outcome/trace_records.hpp"
#include "core/scenario/scripted_agent.hpp"

namespace fleetproof {
namespace {

// Only the agent `scripted` plays a script.
bool plays_a_script(const Scenario& scenario) {
  return (scenario.agent.empty() || plays_scripts(scenario.agent)) &&
         std::ranges::any_of(scenario.agvs, [](const AgvSetup& agv) { return !agv.script.empty(); });
}

class FaultRecordLaw final : public Law {
 public:
  explicit FaultRecordLaw(const Scenario& scenario)
      : scenario_(scenario),
        first_obstacle_(scenario.first_obstacle()),
        first_load_(scenario.first_fallen_load()),
        plays_scripts_(plays_a_script(scenario)) {}

  Pieces hears_pieces() const override { return Pieces::None; }
  TraceKinds reads() const override {
    const TraceKinds kinds{TraceKind::FaultStrikes, TraceKind::FaultOver, TraceKind::Appears, TraceKind::Leaves,
                           TraceKind::Denied};
    const TraceKinds of_calls{TraceKind::CallRefused, TraceKind::ActivityBegins, TraceKind::ActivityEnds};
    return plays_scripts_ ? kinds | of_calls : kinds;
  }
  ActivityKinds reads_about() const override { return {ActivityKind::Pick, ActivityKind::Drop}; }
  void happened(const TraceRecord& record) override {
    switch (record.kind) {
      case TraceKind::FaultStrikes: {
        const auto [fault, number] = read<traced::FaultStrikes>(record);
        decided_.insert(number);
        begins({IncidentKind::FaultInjected, record.entity, {}, record.at, record.at, static_cast<int>(fault)}, number);
        break;
      }
      case TraceKind::FaultOver:
        ends(IncidentKind::FaultInjected, record, read<traced::FaultOver>(record).number);
        break;
      case TraceKind::Appears:
        if (record.entity >= first_obstacle_) appears(record);  // else the operator sets an AGV down
        break;
      case TraceKind::Denied:
        denied(record);
        break;
      case TraceKind::CallRefused:
        refused(record);
        break;
      case TraceKind::ActivityBegins:
        transfers_[record.entity].moves_load = read<traced::ActivityBegins>(record).load().valid();
        break;
      case TraceKind::ActivityEnds:
        transfer_ends(record);
        break;
      case TraceKind::Leaves:
        ends(IncidentKind::ForeignBody, record, 0);
        break;
      default:
        break;
    }
  }
  void finish(SimTime end) override {
    for (const auto& [key, place] : under_way_) {
      const bool waits = std::get<IncidentKind>(key) == IncidentKind::ObstacleWithoutRoom;
      incidents_[place].last = waits ? std::min(end, kStart + scenario_.obstacle(std::get<EntityId>(key)).leaves) : end;
    }
    under_way_.clear();
    not_reached(end);
    not_sent(end);
  }
  LawResults findings() const override {
    LawResults findings;
    findings.incidents = incidents_;
    return findings;
  }

 private:
  using Key = std::tuple<IncidentKind, EntityId, std::uint64_t>;  // and the number of the fault in the scenario

  void begins(const Incident& incident, std::uint64_t number) {
    under_way_[{incident.kind, incident.a, number}] = incidents_.size();
    incidents_.push_back(incident);
  }
  void appears(const TraceRecord& record) {
    const auto waited = under_way_.find({IncidentKind::ObstacleWithoutRoom, record.entity, 0});
    if (waited != under_way_.end()) {
      incidents_[waited->second].last = record.at, incidents_[waited->second].value = kCameLater;
      under_way_.erase(waited);
    }
    const bool stood = record.entity < first_load_;
    begins({IncidentKind::ForeignBody, record.entity, {}, record.at, record.at, stood ? kObstacle : kFallenLoad}, 0);
  }
  void denied(const TraceRecord& record) {
    const auto [why, number] = read<traced::Denied>(record);
    if (why == Denial::NotSent) return unused_deliveries_.push_back(number);
    if (why == Denial::NoSuchKind) return void(++kinds_not_spared_);
    if (record.entity >= first_obstacle_)
      return begins({IncidentKind::ObstacleWithoutRoom, record.entity, {}, record.at, record.at, kNeverCame}, 0);
    decided_.insert(number);
    const bool is_load = why == Denial::NoSuchLoad || why == Denial::NoRoom;
    const std::int64_t value = !is_load                ? static_cast<int>(scenario_.faults[number].kind)
                               : why == Denial::NoRoom ? kNoRoomForLoad
                                                       : kNoSuchLoad;
    incidents_.push_back({is_load ? IncidentKind::LoadDidNotFall : IncidentKind::FaultWithoutEffect,
                          record.entity,
                          {},
                          record.at,
                          record.at,
                          value});
  }
  // Of the calls of the script that are like the refused one, the nearest in time: the clock of the AGV may be wrong.
  void refused(const TraceRecord& record) {
    const auto [call, segment] = read<traced::CallRefused>(record);
    const auto& script = scenario_.agvs[record.entity.index()].script;
    const auto away = [&](std::size_t k) { return std::chrono::abs(kStart + script[k].at - record.at); };
    std::optional<std::size_t> nearest;
    for (std::size_t k = 0; k < script.size(); ++k) {
      const bool is_like_it = static_cast<std::uint32_t>(script[k].action) == call && script[k].segment == segment;
      if (!is_like_it || refused_.contains({record.entity, k})) continue;
      if (!nearest || away(k) <= away(*nearest)) nearest = k;
    }
    if (!nearest) return;
    refused_.insert({record.entity, *nearest});
    const auto place = static_cast<std::int64_t>(*nearest);
    incidents_.push_back({IncidentKind::CallNotMade, record.entity, {}, record.at, record.at, place});
  }
  // The calls of one AGV are carried out in their order. A transfer that a halt cuts short begins anew.
  void transfer_ends(const TraceRecord& record) {
    const auto [kind, as_planned] = read<traced::ActivityEnds>(record);
    if (!as_planned) return;
    Transfers& transfers = transfers_[record.entity];
    const auto action = kind == ActivityKind::Pick ? ScriptedCall::Action::Pick : ScriptedCall::Action::Drop;
    const auto& script = scenario_.agvs[record.entity.index()].script;
    std::size_t& k = transfers.next_call;
    while (k < script.size() && (script[k].action != action || refused_.contains({record.entity, k}))) ++k;
    if (k == script.size()) return;
    const auto place = static_cast<std::int64_t>(k++);
    if (!transfers.moves_load)
      incidents_.push_back({IncidentKind::CallWithoutEffect, record.entity, {}, record.at, record.at, place});
  }
  // Of each pair of AGVs, the given deliveries that no message got; then the kinds of messages.
  void not_sent(SimTime end) {
    std::map<std::pair<AgvId, AgvId>, Incident> pairs;
    for (const std::uint64_t number : unused_deliveries_) {
      const GivenDelivery& delivery = scenario_.deliveries[number];
      const SimTime at = std::min(end, kStart + delivery.sent);
      Incident& incident =
          pairs
              .try_emplace({delivery.sender, delivery.receiver},
                           Incident{IncidentKind::MessageNotSent, delivery.sender, delivery.receiver, at, at, 0})
              .first->second;
      incident.first = std::min(incident.first, at), incident.last = std::max(incident.last, at);
      ++incident.value;
    }
    for (const auto& [pair, incident] : pairs) incidents_.push_back(incident);
    if (kinds_not_spared_ > 0)
      incidents_.push_back({IncidentKind::MessageNotSent, {}, {}, end, end, kinds_not_spared_});
  }
  // What an event at the end of the run would do still takes place.
  void not_reached(SimTime end) {
    const auto late = [&](Duration at) { return kStart + at > end; };
    std::map<EntityId, std::int64_t> counts;
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) {
      const AgvSetup& agv = scenario_.agvs[i];
      const auto orders = std::ranges::count_if(agv.transports, late, &TransportOrder::release);
      const auto calls = std::ranges::count_if(
          agv.script, [&](Duration at) { return late(at) || !plays_scripts_; }, &ScriptedCall::at);
      counts[EntityId{i}] = orders + calls;
    }
    counts[EntityId{}] = std::ranges::count_if(scenario_.open_orders, late, &TransportOrder::release);
    for (std::size_t i = 0; i < scenario_.faults.size(); ++i)
      counts[scenario_.faults[i].agv] += decided_.contains(i) ? 0 : 1;
    for (EntityId body = first_obstacle_; body < first_load_; ++body.value) {
      if (late(scenario_.obstacle(body).appears)) counts[body] = 1;
    }
    for (const auto& [body, count] : counts) {
      if (count > 0) incidents_.push_back({IncidentKind::NotReached, body, {}, end, end, count});
    }
  }
  void ends(IncidentKind kind, const TraceRecord& record, std::uint64_t number) {
    const auto found = under_way_.find({kind, record.entity, number});
    if (found == under_way_.end()) return;
    incidents_[found->second].last = record.at;
    under_way_.erase(found);
  }

  const Scenario& scenario_;
  EntityId first_obstacle_, first_load_;
  bool plays_scripts_;
  std::set<std::uint64_t> decided_;                     // faults that struck or were denied, by number
  std::set<std::pair<EntityId, std::size_t>> refused_;  // calls of scripts, by place
  struct Transfers {
    bool moves_load = false;    // the one under way
    std::size_t next_call = 0;  // the first place in the script from which the next one may come
  };
  std::map<EntityId, Transfers> transfers_;
  std::vector<std::uint64_t> unused_deliveries_;  // by number
  std::int64_t kinds_not_spared_ = 0;
  std::map<Key, std::size_t> under_way_;  // by place in incidents_
  std::vector<Incident> incidents_;
};

}  // namespace

std::unique_ptr<Law> make_fault_record_law(const Scenario& scenario) {
  return std::make_unique<FaultRecordLaw>(scenario);
}

}  // namespace fleetproof
