#include "campaign/watch/run_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/outside_text.hpp"
#include "core/base/shown_time.hpp"
#include "core/outcome/run_failures.hpp"
#include "core/outcome/trace_records.hpp"
#include "core/outcome/work_and_progress.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

// The first digits of a number in millionths: cut, not rounded, so that no digit differs from the full number.
double cut(std::int64_t millionths, std::int64_t step) {
  return static_cast<double>(millionths - millionths % step) / 1e6;
}
double to_centimetre(std::int64_t value_um) { return cut(value_um, 10'000); }
double to_millimetre(std::int64_t value_um) { return cut(value_um, 1'000); }

std::string counters_text(const Outcome& outcome) {
  const Counters& c = outcome.counters;
  const double hours = static_cast<double>(outcome.agv_count) * static_cast<double>(outcome.simulated_ns) / 3.6e12;
  std::string text = fmt::format("  {} drives, {} turns, {:.0f} m; transports {} of {} done", c.drives, c.turns,
                                 static_cast<double>(c.distance_um) / 1e6, c.transports_done, c.transports_released);
  if (hours > 0.0) text += fmt::format(" ({:.2f} per AGV-hour)", transports_per_agv_hour(c.transports_done, hours));
  if (c.transports_withdrawn > 0) text += fmt::format(", {} withdrawn", c.transports_withdrawn);
  const double lost =
      c.receptions == 0 ? 0.0 : 100.0 * static_cast<double>(c.receptions_lost) / static_cast<double>(c.receptions);
  const double delay =
      c.receptions == 0 ? 0.0 : static_cast<double>(c.delay_sum_ns) / 1e9 / static_cast<double>(c.receptions);
  text += fmt::format("\n  {} messages sent; of {} receptions {:.1f} % lost, mean delay {:.2f} s; {} events\n",
                      c.messages_sent, c.receptions, lost, delay, c.events);
  if (c.lost_in_outage + c.lost_by_interference + c.lost_to_sources + c.duplicates > 0) {
    text += fmt::format("  of {} lost: {} in outages, {} by interference, {} to external sources; {} came twice\n",
                        c.receptions_lost, c.lost_in_outage, c.lost_by_interference, c.lost_to_sources, c.duplicates);
  }
  if (c.faults + c.batteries_empty + c.scanner_stops + c.assists > 0) {
    text += fmt::format(
        "  {} faults struck, {} batteries ran empty, {} loads cleared away; scanner: {} stops, {} saves; {} assists\n",
        c.faults, c.batteries_empty, c.loads_cleared, c.scanner_stops, c.scanner_saves, c.assists);
  }
  return text;
}

// The value of an incident with its unit; a word where the number stands for one.
std::string value_text(const Incident& incident) {
  switch (incident.kind) {
    case IncidentKind::FaultInjected:
    case IncidentKind::FaultWithoutEffect:
      return std::string(fault_word(incident));
    case IncidentKind::Deadlock:
      if (incident.value == 0) return "no circle known";
      return fmt::format("AGVs in the circle: {}", incident.value);
    case IncidentKind::ForeignBody:
      return is_fallen_load(incident) ? "a fallen load" : "an obstacle";
    case IncidentKind::LoadDidNotFall:
      return name_of(incident.value == kNoRoomForLoad ? Denial::NoRoom : Denial::NoSuchLoad);
    case IncidentKind::ObstacleWithoutRoom:
      return incident.value == kNeverCame ? "it never came" : "it came later";
    default:
      break;
  }
  return fmt::format("{}: {}", info_of(incident.kind).unit, incident.value);
}

}  // namespace

std::string shown_name(const Scenario& scenario, EntityId id) { return printable(body_name(scenario, id)); }

std::string body_name(const Scenario& scenario, EntityId id, std::string_view load_of) {
  if (!id.valid()) return "the fleet";
  if (id < scenario.first_obstacle()) return scenario.name_of(id);
  if (id < scenario.first_fallen_load()) return scenario.obstacle(id).name;
  std::size_t number = id.index() - scenario.first_fallen_load().index();
  for (const Fault& fault : scenario.faults) {
    if (fault.kind == Fault::Kind::LoadDrop && number-- == 0)
      return std::string(load_of) +
             (fault.agv.valid() ? scenario.name_of(fault.agv) : fmt::format("order {}", *fault.transport));
  }
  return "?";
}

std::string incident_text(const Scenario& scenario, const Incident& incident) {
  const IncidentKindInfo& info = info_of(incident.kind);
  std::string whom;
  if (incident.a.valid()) whom += " " + shown_name(scenario, incident.a);
  if (incident.b.valid()) whom += std::string(incident.a.valid() ? " ->" : "") + " " + shown_name(scenario, incident.b);
  const std::string until =
      incident.last > incident.first ? fmt::format(" to {:.3f} s", shown_seconds(incident.last)) : "";
  return fmt::format("{}:{} from {:.3f} s{}; {} ({})", info.name, whom, shown_seconds(incident.first), until,
                     info.meaning, value_text(incident));
}

std::string differences_text(const Scenario& scenario, const std::vector<Difference>& differences,
                             std::string_view published) {
  std::string text = fmt::format("  beside safety-distance, {} ", published);
  if (differences.empty()) return text + "accuses the same pairs at the same time\n";
  const auto missed = std::ranges::count(differences, true, &Difference::missed);
  text +=
      fmt::format("misses {} and accuses {} wrongly:\n", missed, differences.size() - static_cast<std::size_t>(missed));
  for (const Difference& d : differences) {
    const Violation& v = d.violation;
    text += fmt::format("    {} ({}): {} and {} from {:.3f} s to {:.3f} s, closest {:.3f} m at {:.3f} s\n",
                        d.missed ? "missed" : "accused wrongly", name_of(d.cause), shown_name(scenario, v.a),
                        shown_name(scenario, v.b), shown_seconds(v.first), shown_seconds(v.last),
                        to_millimetre(v.min_clearance_um), shown_seconds(v.closest_at));
  }
  return text;
}

std::string met_text(const Outcome& outcome) {
  std::string text;
  for (const ProbeCount& probe : outcome.probes) {
    text += fmt::format("{}{}{} {}", text.empty() ? "  met: " : ", ",
                        probe.source == ProbeSource::Agent ? "agent: " : "", printable(probe.name), probe.count);
  }
  if (outcome.counters.probes_left_out > 0)
    text += fmt::format("; {} declarations beyond what is kept", outcome.counters.probes_left_out);
  return text.empty() ? text : text + "\n";
}

std::string outcome_text(const Scenario& scenario, const Outcome& outcome, bool clearance_measured) {
  std::string text = fmt::format("{}: {}\n", printable(scenario.name), end_of_run(outcome));
  if (!outcome.message.empty()) text += fmt::format("  {}\n", printable(outcome.message));
  for (const Violation& v : outcome.violations) {
    text += fmt::format(
        "  {} and {} closer than {} from {:.3f} s to {:.3f} s; closest {:.3f} m at {:.3f} s near ({:.2f}, "
        "{:.2f}), {:.2f} m/s apart{}\n",
        shown_name(scenario, v.a), shown_name(scenario, v.b), distance_text(scenario.law.safety_distance_m),
        shown_seconds(v.first), shown_seconds(v.last), to_millimetre(v.min_clearance_um), shown_seconds(v.closest_at),
        to_centimetre(v.x_um), to_centimetre(v.y_um), to_centimetre(v.relative_speed_um_s),
        v.contact ? std::string(", ") + name_of(level_of(v)) : "");
  }
  if (scenario.law.exempt_purposes.bits() != 0) {
    text += fmt::format("  exempt from the safety distance (contact is not): within {:g} m of stations for {}\n",
                        scenario.law.exempt_radius_m, purposes_text(scenario.law.exempt_purposes));
  }
  for (const ExemptPair& pair : scenario.law.exempt_pairs) {
    text += fmt::format("  exempt from the safety distance (contact is not): {}\n", printable(text_of(pair)));
  }
  for (const Incident& incident : outcome.incidents) text += "  " + incident_text(scenario, incident) + "\n";
  if (outcome.min_clearance_um) {
    text += fmt::format("  smallest clearance {:.2f} m\n", to_centimetre(*outcome.min_clearance_um + kSlack_um));
  } else {
    text += clearance_measured ? "  smallest clearance > 0.5 m\n" : "  smallest clearance not measured\n";
  }
  if (outcome.counters.perimeter_checks > 0)
    text += fmt::format("  {} perimeter checks by the law\n", outcome.counters.perimeter_checks);
  return text + counters_text(outcome) + met_text(outcome) + fmt::format("  trace digest {:016x}\n", outcome.digest);
}

}  // namespace fleetproof
