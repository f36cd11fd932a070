#pragma once

#include <cstdint>

#include "core/faults.hpp"
#include "core/law.hpp"

namespace fleetproof {

// Whether a fault holds anybody where it is: what the fleet does not do meanwhile is nobody's fault.
class FaultWatch {
 public:
  static constexpr TraceKinds reads() { return {TraceKind::FaultStrikes, TraceKind::FaultOver}; }
  // True if the record was one of these.
  bool note(const TraceRecord& record) {
    if (record.kind != TraceKind::FaultStrikes && record.kind != TraceKind::FaultOver) return false;
    const auto kind = static_cast<Fault::Kind>(record.a);
    if (!holds_agv(kind)) return true;
    held_ += record.kind == TraceKind::FaultStrikes ? 1 : -1;
    last_ = record.at;
    return true;
  }
  bool holds_anybody() const { return held_ > 0; }
  SimTime last() const { return last_; }  // when that was last so, if it is not now

 private:
  int held_ = 0;
  SimTime last_ = kStart;
};

}  // namespace fleetproof
