#include "laws/fault_record_law.hpp"

#include <map>
#include <tuple>

#include "core/outcome/trace_records.hpp"

namespace fleetproof {
namespace {

class FaultRecordLaw final : public Law {
 public:
  explicit FaultRecordLaw(const Scenario& scenario)
      : agv_count_(scenario.agvs.size()), with_obstacles_(agv_count_ + scenario.obstacles.size()) {}

  Pieces hears_pieces() const override { return Pieces::None; }
  TraceKinds reads() const override {
    return {TraceKind::FaultStrikes, TraceKind::FaultOver, TraceKind::Appears, TraceKind::Leaves};
  }
  void happened(const TraceRecord& record) override {
    switch (record.kind) {
      case TraceKind::FaultStrikes: {
        const auto [fault, number] = read<traced::FaultStrikes>(record);
        begins({IncidentKind::FaultInjected, record.entity, {}, record.at, record.at, static_cast<int>(fault)}, number);
        break;
      }
      case TraceKind::FaultOver:
        ends(IncidentKind::FaultInjected, record, read<traced::FaultOver>(record).number);
        break;
      case TraceKind::Appears:
        if (record.entity.index() < agv_count_) break;  // the operator sets an AGV down
        begins({IncidentKind::ForeignBody,
                record.entity,
                {},
                record.at,
                record.at,
                record.entity.index() < with_obstacles_ ? kObstacle : kFallenLoad},
               0);
        break;
      case TraceKind::Leaves:
        ends(IncidentKind::ForeignBody, record, 0);
        break;
      default:
        break;
    }
  }
  void finish(SimTime end) override {
    for (const auto& [key, place] : under_way_) incidents_[place].last = end;
    under_way_.clear();
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
  void ends(IncidentKind kind, const TraceRecord& record, std::uint64_t number) {
    const auto found = under_way_.find({kind, record.entity, number});
    if (found == under_way_.end()) return;
    incidents_[found->second].last = record.at;
    under_way_.erase(found);
  }

  std::size_t agv_count_, with_obstacles_;
  std::map<Key, std::size_t> under_way_;  // by place in incidents_
  std::vector<Incident> incidents_;
};

}  // namespace

std::unique_ptr<Law> make_fault_record_law(const Scenario& scenario) {
  return std::make_unique<FaultRecordLaw>(scenario);
}

}  // namespace fleetproof
