#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fleetproof {

// What a run counts. Sums of whole numbers: they do not depend on the order of adding. The table below says what each
// counter means.
struct Counters {
  std::uint64_t events = 0;
  std::uint64_t activations = 0;
  std::uint64_t agent_calls = 0;
  std::uint64_t messages_sent = 0;
  std::uint64_t receptions = 0;
  std::uint64_t receptions_lost = 0;
  std::uint64_t out_of_range = 0;
  std::uint64_t delay_sum_ns = 0;
  std::uint64_t drives = 0;
  std::uint64_t turns = 0;
  std::uint64_t refused_calls = 0;
  std::uint64_t transports_released = 0;
  std::uint64_t transports_done = 0;
  std::uint64_t distance_um = 0;
  std::uint64_t safe_mode_ns = 0;
  std::uint64_t contacts = 0;
  std::uint64_t distance_evaluations = 0;
  std::uint64_t perimeter_checks = 0;
  std::uint64_t rolls = 0;
  std::uint64_t faults = 0;
  std::uint64_t batteries_empty = 0;
  std::uint64_t loads_cleared = 0;
  std::uint64_t assists = 0;
  std::uint64_t scanner_stops = 0;
  std::uint64_t scanner_saves = 0;
  std::uint64_t received = 0;
  std::uint64_t under_way = 0;
  std::uint64_t battery_start_ppb = 0;
  std::uint64_t battery_end_ppb = 0;
  std::uint64_t battery_driven_ppb = 0;
  std::uint64_t battery_idled_ppb = 0;
  std::uint64_t battery_charged_ppb = 0;
  std::uint64_t incidents_left_out = 0;
  std::uint64_t probes_left_out = 0;
  std::uint64_t lost_in_outage = 0;
  std::uint64_t lost_by_interference = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t lost_to_sources = 0;
  std::uint64_t processor_changes = 0;
  std::uint64_t transports_withdrawn = 0;

  friend bool operator==(const Counters&, const Counters&) = default;
};

// A counter: its name in archives and JSON, its unit, and what is counted. Name and unit together with `meaning` read
// as a sentence: "receptions: receptions, one for each receiver in range of a message, lost or not".
struct CounterInfo {
  const char* name;
  std::uint64_t Counters::*member;
  std::string_view unit, meaning;
};

// The one list of counters. The encoding of an outcome, the columns of an archive and the JSON of a run follow it, in
// this order. Append only, and raise the versions of the encoding (outcome.cpp) and of the archive (storage/schema.hpp)
// with it.
inline constexpr auto kCounters = std::to_array<CounterInfo>({
    {"events", &Counters::events, "records", "in the trace"},
    {"activations", &Counters::activations, "activations", "of agents"},
    {"agent_calls", &Counters::agent_calls, "calls", "by agents to their controllers"},
    {"messages_sent", &Counters::messages_sent, "messages", "sent by agents"},
    {"receptions", &Counters::receptions, "receptions", "one for each receiver in range of a message, lost or not"},
    {"receptions_lost", &Counters::receptions_lost, "receptions", "lost, for whatever reason"},
    {"out_of_range", &Counters::out_of_range, "receptions",
     "that were none: the receiver was out of range at the instant of sending"},
    {"delay_sum_ns", &Counters::delay_sum_ns, "ns",
     "from sending to arrival, of all receptions added up; of a lost one, as if it had arrived"},
    {"drives", &Counters::drives, "drives", "begun"},
    {"turns", &Counters::turns, "turns", "begun"},
    {"refused_calls", &Counters::refused_calls, "calls", "for an action that was not possible at that moment"},
    {"transports_released", &Counters::transports_released, "transports",
     "released to their AGVs, or open to the computers of the fleet"},
    {"transports_done", &Counters::transports_done, "transports", "whose load was put down at its destination"},
    {"distance_um", &Counters::distance_um, "um", "driven by the whole fleet"},
    {"safe_mode_ns", &Counters::safe_mode_ns, "ns", "in safe mode, added up over the fleet"},
    {"contacts", &Counters::contacts, "contacts", "of two bodies"},
    {"distance_evaluations", &Counters::distance_evaluations, "evaluations",
     "of a distance, by the judge of violations"},
    {"perimeter_checks", &Counters::perimeter_checks, "checks", "of two perimeters, by a published law"},
    {"rolls", &Counters::rolls, "stations", "passed without a stop"},
    {"faults", &Counters::faults, "faults", "that struck"},
    {"batteries_empty", &Counters::batteries_empty, "batteries", "that ran empty"},
    {"loads_cleared", &Counters::loads_cleared, "loads", "cleared away from the floor"},
    {"assists", &Counters::assists, "assists", "of the operator"},
    {"scanner_stops", &Counters::scanner_stops, "stops", "by the scanner"},
    {"scanner_saves", &Counters::scanner_saves, "stops",
     "by the scanner that prevented a touch: it lay ahead before the stop, and not after it"},
    {"received", &Counters::received, "receptions", "that reached an AGV"},
    {"under_way", &Counters::under_way, "receptions", "still in the air at the end of the run"},
    {"battery_start_ppb", &Counters::battery_start_ppb, "ppb", "of a full battery, in all batteries at the start"},
    {"battery_end_ppb", &Counters::battery_end_ppb, "ppb",
     "of a full battery, in all batteries at the end: start + charged = end + driven + idled"},
    {"battery_driven_ppb", &Counters::battery_driven_ppb, "ppb", "of a full battery, spent by driving"},
    {"battery_idled_ppb", &Counters::battery_idled_ppb, "ppb", "of a full battery, spent by being switched on"},
    {"battery_charged_ppb", &Counters::battery_charged_ppb, "ppb",
     "of a full battery, charged or gained by a change of battery"},
    {"incidents_left_out", &Counters::incidents_left_out, "incidents", "beyond what an outcome holds"},
    {"probes_left_out", &Counters::probes_left_out, "declarations", "of probes by agents beyond what an outcome holds"},
    {"lost_in_outage", &Counters::lost_in_outage, "receptions", "lost while the link or place was in an outage"},
    {"lost_by_interference", &Counters::lost_by_interference, "receptions", "lost to other transmissions of the fleet"},
    {"duplicates", &Counters::duplicates, "receptions", "of copies, on top of the other receptions"},
    {"lost_to_sources", &Counters::lost_to_sources, "receptions", "lost to external sources alone"},
    {"processor_changes", &Counters::processor_changes, "calls",
     "of agents that left another rounding, other exceptions or denormals behind: they were set back"},
    {"transports_withdrawn", &Counters::transports_withdrawn, "transports",
     "withdrawn before an AGV had taken their loads up"},
});

// So many of them stand in encodings up to version 4 and in archives up to schema 11; and up to version 5 and
// schema 13.
inline constexpr std::size_t kCountersBeforeProcessor = kCounters.size() - 2,
                             kCountersBeforeWithdrawn = kCounters.size() - 1;

// A counter that stands in the list twice would hide that another one is missing.
consteval bool every_counter_is_listed_once() {
  for (std::size_t i = 0; i < kCounters.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (kCounters[i].member == kCounters[j].member) return false;
      if (std::string_view(kCounters[i].name) == kCounters[j].name) return false;
    }
  }
  return sizeof(Counters) == kCounters.size() * sizeof(std::uint64_t);
}
static_assert(every_counter_is_listed_once(), "every member of Counters has one line in the table, and no more");

}  // namespace fleetproof
