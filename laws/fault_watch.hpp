#pragma once

#include <cstdint>
#include <vector>

#include "core/outcome/law.hpp"
#include "core/outcome/trace_records.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Whether an AGV is held by a breakdown or a protective stop, or is out of order until the operator has set it down, or
// a fault keeps a computer from its work. During this time laws do not accuse the fleet of standing still.
class FaultWatch {
 public:
  explicit FaultWatch(const Scenario& scenario)
      : first_computer_(scenario.first_computer()),
        out_of_order_(scenario.operator_help.on && scenario.contact_stops ? scenario.agvs.size() : 0) {}

  static constexpr TraceKinds reads() {
    return {TraceKind::FaultStrikes, TraceKind::FaultOver, TraceKind::Contact, TraceKind::Appears};
  }
  // True if the record belongs to a fault only, so that its caller can ignore it.
  bool note(const TraceRecord& record) {
    if (record.kind == TraceKind::Contact) {
      is_out_of_order(record.entity.index(), true, record.at);
      is_out_of_order(read<traced::Contact>(record).other.index(), true, record.at);
    }
    if (record.kind == TraceKind::Appears) is_out_of_order(record.entity.index(), false, record.at);
    const bool strikes = record.kind == TraceKind::FaultStrikes;
    if (!strikes && record.kind != TraceKind::FaultOver) return false;
    const Fault::Kind fault =
        strikes ? read<traced::FaultStrikes>(record).fault : read<traced::FaultOver>(record).fault;
    if (holds_agv(fault) || record.entity >= first_computer_) changes(strikes, record.at);
    return true;
  }
  bool holds_anybody() const { return held_ > 0; }
  SimTime last() const { return last_; }  // the last instant at which that was true, if it is not true now

 private:
  void is_out_of_order(std::size_t agv, bool now, SimTime at) {
    if (agv >= out_of_order_.size() || out_of_order_[agv] == now) return;
    out_of_order_[agv] = now;
    changes(now, at);
  }
  void changes(bool one_more, SimTime at) {
    held_ += one_more ? 1 : -1;
    last_ = at;
  }

  EntityId first_computer_;
  std::vector<bool> out_of_order_;  // by AGV; empty if contacts stop no AGV, or stop it for good
  int held_ = 0;
  SimTime last_ = kStart;
};

}  // namespace fleetproof
