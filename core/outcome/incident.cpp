#include "core/outcome/incident.hpp"

#include <algorithm>
#include <array>

#include "core/base/error.hpp"
#include "core/scenario/faults.hpp"

namespace fleetproof {
namespace {

using enum IncidentKind;

constexpr std::array<IncidentKindInfo, 19> kKinds{{
    {BatteryEmpty, "battery-empty", "micrometres to the nearest charging station",
     "the battery of an AGV ran empty away from a charging station"},
    {ChannelSaturated, "channel-saturated", "millionths of the air time, at the peak",
     "the fleet sent more than the radio channel can carry"},
    {InterferenceLosses, "interference-losses", "millionths of the receptions, at the peak",
     "transmissions destroyed each other"},
    {LoadHeldByTwo, "load-held-by-two", "load", "a load passed to an AGV while another AGV held it"},
    {LoadVanished, "load-vanished", "load", "a load is nowhere after a pick or drop"},
    {LoadDeliveredTwice, "load-delivered-twice", "load", "a transport was reported done a second time"},
    {LoadPickedByFullAgv, "load-picked-by-full-agv", "load", "an AGV took a load while it carried another load"},
    {LoadAtWrongStation, "load-at-wrong-station", "load", "a load lay at a station that its transport does not name"},
    {LoadMovedByNobody, "load-moved-by-nobody", "load",
     "a load moved although no AGV at its place was picking or dropping it"},
    {Deadlock, "deadlock", "AGVs in the circle; 0: no circle known", "AGVs with open transports waited for each other"},
    {WaitsDeclared, "waits", "1: in the circle", "an AGV of a deadlock declared that it waited for another AGV"},
    {WaitsInferred, "waits-inferred", "1: in the circle",
     "another AGV stood in the way of an AGV of a deadlock; inferred from the geometry"},
    {Livelock, "livelock", "drives and turns begun", "AGVs moved, but no transport advanced"},
    {Starvation, "starvation", "open transports",
     "the transports of one AGV did not advance while other AGVs finished theirs"},
    {SafeModeInContract, "safe-mode-in-contract", "millionths of receptions lost, on its worst link",
     "an AGV was in safe mode while the radio kept its contract"},
    {StandstillInContract, "standstill-in-contract", "open transports",
     "the fleet stood still while the radio kept its contract"},
    {ThroughputBelowFloor, "throughput-below-floor", "thousandths of a transport per AGV-hour",
     "the fleet finished fewer transports than the floor requires"},
    {FaultInjected, "fault-injected",
     "kind of the fault: 1 breakdown, 2 protective stop, 3 load drop, 4 restart, 5 "
     "freeze, 6 power failure",
     "a fault of the scenario struck an AGV"},
    {ForeignBody, "foreign-body", "1: a fallen load; 0: an obstacle",
     "a body lay on the floor that no control software is told of"},
}};

static_assert([] {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (static_cast<std::size_t>(kKinds[i].kind) != i + 1) return false;
  }
  return true;
}());

}  // namespace

std::span<const IncidentKindInfo> incident_kinds() { return kKinds; }

bool is_incident_kind(std::uint32_t number) { return number >= 1 && number <= kKinds.size(); }

const IncidentKindInfo& info_of(IncidentKind kind) {
  const auto number = static_cast<std::uint32_t>(kind);
  ensure(is_incident_kind(number), "a kind of incident is in its catalogue");
  return kKinds[number - 1];
}

std::string_view fault_word(const Incident& incident) {
  ensure(incident.kind == IncidentKind::FaultInjected, "an injected fault has a word");
  return name_of(static_cast<Fault::Kind>(incident.value));
}

bool is_load_drop(const Incident& incident) {
  return incident.kind == IncidentKind::FaultInjected &&
         static_cast<Fault::Kind>(incident.value) == Fault::Kind::LoadDrop;
}

}  // namespace fleetproof
