#include "core/outcome/incident.hpp"

#include <algorithm>
#include <array>

#include "core/base/error.hpp"
#include "core/scenario/faults.hpp"

namespace fleetproof {
namespace {

using enum IncidentKind;
using enum IncidentRole;

// "kind of the fault: 1 breakdown, 2 protective stop, ...": the words of the faults, without hyphens.
struct FaultUnit {
  std::array<char, 256> letters{};
  std::size_t size = 0;

  consteval FaultUnit() {
    add(kHead);
    for (const Fault::Kind kind : kValuesOf<Fault::Kind>) {
      add(size == kHead.size() ? " " : ", ");
      const int number = static_cast<int>(kind);
      if (number > 9) letters.at(size++) = static_cast<char>('0' + number / 10);
      letters.at(size++) = static_cast<char>('0' + number % 10);
      add(" ");
      add(name_of(kind));
    }
  }
  consteval void add(std::string_view text) {
    for (const char letter : text) letters.at(size++) = letter == '-' ? ' ' : letter;
  }
  static constexpr std::string_view kHead = "kind of the fault:";
};
constexpr FaultUnit kFaultLetters;
constexpr std::string_view kFaultUnit(kFaultLetters.letters.data(), kFaultLetters.size);

constexpr auto kKinds = std::to_array<IncidentKindInfo>({
    {BatteryEmpty, Accusation, EndPoint::EmptyBattery, "battery-empty", "micrometres to the nearest charging station",
     "the battery of an AGV ran empty away from a charging station"},
    {ChannelSaturated, Accusation, std::nullopt, "channel-saturated", "millionths of the air time, at the peak",
     "the fleet sent more than the radio channel can carry"},
    {InterferenceLosses, Accusation, std::nullopt, "interference-losses", "millionths of the receptions, at the peak",
     "transmissions destroyed each other"},
    {LoadHeldByTwo, Accusation, EndPoint::WrongLoad, "load-held-by-two", "load",
     "a load passed to an AGV while another AGV held it"},
    {LoadVanished, Accusation, EndPoint::WrongLoad, "load-vanished", "load", "a load is nowhere after a pick or drop"},
    {LoadDeliveredTwice, Accusation, EndPoint::WrongLoad, "load-delivered-twice", "load",
     "a transport was reported done a second time"},
    {LoadPickedByFullAgv, Accusation, EndPoint::WrongLoad, "load-picked-by-full-agv", "load",
     "an AGV took a load while it carried another load"},
    {LoadAtWrongStation, Accusation, EndPoint::WrongLoad, "load-at-wrong-station", "load",
     "a load lay at a station that its transport does not name"},
    {LoadMovedByNobody, Accusation, EndPoint::WrongLoad, "load-moved-by-nobody", "load",
     "a load moved although no AGV at its place was picking or dropping it"},
    {Deadlock, Accusation, EndPoint::Deadlock, "deadlock", "AGVs in the circle; 0: no circle known",
     "AGVs that had work waited for each other, or the fleet stood still although there was work"},
    {WaitsDeclared, Link, std::nullopt, "waits", "1: in the circle",
     "an AGV of a deadlock declared that it waited for another AGV"},
    {WaitsInferred, Link, std::nullopt, "waits-inferred", "1: in the circle",
     "another AGV stood in the way of an AGV of a deadlock; inferred from the geometry"},
    {Livelock, Accusation, EndPoint::Livelock, "livelock", "drives and turns begun",
     "AGVs moved, but no transport advanced"},
    {Starvation, Accusation, EndPoint::Starvation, "starvation", "open transports",
     "the transports of one AGV did not advance while other AGVs finished theirs"},
    {SafeModeInContract, Accusation, std::nullopt, "safe-mode-in-contract",
     "millionths of receptions lost, on its worst link", "an AGV was in safe mode while the radio kept its contract"},
    {StandstillInContract, Accusation, EndPoint::Standstill, "standstill-in-contract", "open transports",
     "the fleet stood still while the radio kept its contract"},
    {ThroughputBelowFloor, Accusation, std::nullopt, "throughput-below-floor",
     "thousandths of a transport per AGV-hour", "the fleet finished fewer transports than the floor requires"},
    {FaultInjected, Condition, std::nullopt, "fault-injected", kFaultUnit,
     "a fault of the scenario struck an AGV or a computer"},
    {ForeignBody, Condition, std::nullopt, "foreign-body", "1: a fallen load; 0: an obstacle",
     "a body lay on the floor that no control software is told of"},
    {FaultWithoutEffect, Denied, std::nullopt, "fault-without-effect", kFaultUnit,
     "a fault of the scenario changed nothing: the AGV was out of order, the program of the AGV or computer was away, "
     "or it did not know the fault"},
    {LoadDidNotFall, Denied, std::nullopt, "load-did-not-fall",
     "1: the AGV carried no such load; 2: a body was in the place",
     "a load of the scenario did not fall where and when it should have fallen"},
    {ObstacleWithoutRoom, Denied, std::nullopt, "obstacle-without-room", "1: it never came; 0: it came later",
     "an obstacle of the scenario had no room when it should have come"},
    {CallNotMade, Denied, std::nullopt, "call-not-made", "place of the call in the script, from 0",
     "the controller refused a call of the scenario's script"},
    {NotReached, Denied, std::nullopt, "not-reached", "orders, faults, calls and obstacles",
     "things of the scenario that the run did not reach: after its end, of a load that was never picked, or of a "
     "script "
     "that nobody plays"},
    {MessageNotSent, Denied, std::nullopt, "message-not-sent", "given deliveries, or kinds of messages",
     "messages of the scenario were never sent: with a given delivery, or of a kind that the radio spares"},
    {CallWithoutEffect, Denied, std::nullopt, "call-without-effect", "place of the call in the script, from 0",
     "a pick or drop of the scenario's script found no load to move"},
    {OrderNotTaken, Accusation, EndPoint::Starvation, "order-not-taken", "transport",
     "no AGV took the load of an open transport up while later ones were finished"},
});

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

bool accuses(IncidentKind kind) { return info_of(kind).role == Accusation || is_link(kind); }
bool is_condition(IncidentKind kind) { return info_of(kind).role == Condition; }
bool is_link(IncidentKind kind) { return info_of(kind).role == IncidentRole::Link; }

std::string_view fault_word(const Incident& incident) {
  ensure(incident.kind == IncidentKind::FaultInjected || incident.kind == IncidentKind::FaultWithoutEffect,
         "a fault has a word");
  return name_of(static_cast<Fault::Kind>(incident.value));
}

bool is_load_drop(const Incident& incident) {
  return incident.kind == IncidentKind::FaultInjected &&
         static_cast<Fault::Kind>(incident.value) == Fault::Kind::LoadDrop;
}

bool is_fallen_load(const Incident& incident) {
  return incident.kind == IncidentKind::ForeignBody && incident.value == kFallenLoad;
}

SimTime surely_began(const Incident& incident) {
  const bool slow = incident.kind == IncidentKind::Livelock || incident.kind == IncidentKind::Starvation ||
                    incident.kind == IncidentKind::OrderNotTaken;
  return slow ? incident.last : incident.first;
}

}  // namespace fleetproof
