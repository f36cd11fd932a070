#include "laws/battery_law.hpp"

#include <cmath>
#include <limits>
#include <map>

#include "core/outcome/trace_records.hpp"
#include "laws/whereabouts.hpp"

namespace fleetproof {
namespace {

class BatteryLaw final : public Law {
 public:
  explicit BatteryLaw(const Scenario& scenario) : scenario_(scenario), bodies_(scenario) {}

  Pieces hears_pieces() const override { return Pieces::Beginnings; }
  void piece_started(const Piece& piece) override { bodies_.note(piece); }
  TraceKinds reads() const override {
    return {TraceKind::BatteryEmpty, TraceKind::ActivityBegins, TraceKind::OperatorAssists};
  }
  ActivityKinds reads_about() const override { return {ActivityKind::Charge}; }
  void happened(const TraceRecord& record) override;
  void finish(SimTime end) override;
  LawResults findings() const override;

 private:
  std::int64_t to_nearest_charger_um(const Vec2& position_m) const;

  const Scenario& scenario_;
  Whereabouts bodies_;
  std::map<EntityId, std::size_t> standing_;  // AGV to its open incident
  std::vector<Incident> incidents_;
};

void BatteryLaw::happened(const TraceRecord& record) {
  if (record.kind != TraceKind::BatteryEmpty) {
    const bool charged = record.kind == TraceKind::ActivityBegins
                             ? read<traced::ActivityBegins>(record).activity == ActivityKind::Charge
                             : read<traced::OperatorAssists>(record).assist == Assist::Battery;
    if (!charged) return;
    const auto standing = standing_.find(record.entity);
    if (standing == standing_.end()) return;
    incidents_[standing->second].last = record.at;
    standing_.erase(standing);
    return;
  }
  const std::int64_t distance_um = to_nearest_charger_um(bodies_.position_m(record.entity, record.at));
  if (static_cast<double>(distance_um) <= kAtStation_m * 1e6 || standing_.contains(record.entity)) return;
  standing_[record.entity] = incidents_.size();
  incidents_.push_back({IncidentKind::BatteryEmpty, record.entity, {}, record.at, record.at, distance_um});
}

void BatteryLaw::finish(SimTime end) {
  for (const auto& [agv, incident] : standing_) incidents_[incident].last = end;
}

LawResults BatteryLaw::findings() const {
  LawResults findings;
  findings.incidents = incidents_;
  return findings;
}

std::int64_t BatteryLaw::to_nearest_charger_um(const Vec2& position_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Station& station : scenario_.map->layout().stations) {
    if (station.purposes.has(Purpose::Charging))
      nearest_m = std::min(nearest_m, (station.position_m - position_m).norm());
  }
  return std::isinf(nearest_m) ? std::numeric_limits<std::int64_t>::max() : std::llround(nearest_m * 1e6);
}

}  // namespace

std::unique_ptr<Law> make_battery_law(const Scenario& scenario) { return std::make_unique<BatteryLaw>(scenario); }

}  // namespace fleetproof
