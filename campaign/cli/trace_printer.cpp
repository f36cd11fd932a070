#include "campaign/cli/trace_printer.hpp"

#include <fmt/format.h>

#include "campaign/cli/run_text.hpp"
#include "campaign/cli/streams.hpp"
#include "core/outcome/note_records.hpp"
#include "reports/wording.hpp"

namespace fleetproof::cli {
namespace {

std::string shown_name(const Scenario& scenario, EntityId id) { return printable(body_name(scenario, id)); }

const char* text_of(Assist assist) {
  switch (assist) {
    case Assist::Battery:
      return "with the battery";
    case Assist::Jam:
      return "past what the scanner sees";
    case Assist::Contact:
      return "after a contact: takes it off the floor";
    case Assist::Standstill:
      return "at a standstill: restarts the agent";
  }
  return "?";
}

std::string holder_text(const Scenario& scenario, const Holder& holder) {
  switch (holder.kind) {
    case Holder::Kind::Station:
      return "at " + printable(scenario.map->station(StationId{holder.index}).name);
    case Holder::Kind::Agv:
      return "on " + shown_name(scenario, EntityId{holder.index});
    case Holder::Kind::Floor:
      return "on the floor";
    case Holder::Kind::ClearedAway:
      return "cleared away";
  }
  return "?";
}

}  // namespace

// The content of a record, without its time, entity and kind.
std::string TracePrinter::details_of(const TraceRecord& record, std::string_view text) const {
  const auto body = [&](EntityId id) { return body_name(scenario_, id); };
  switch (record.kind) {
    case TraceKind::ActivityBegins: {
      const auto begun = read<traced::ActivityBegins>(record);
      const std::string activity = name_of(begun.activity);
      if (begun.activity != ActivityKind::Drive) return activity;
      return activity + " " + scenario_.map->segment(begun.segment()).name + (begun.backward() ? " backward" : "");
    }
    case TraceKind::ActivityEnds: {
      const auto ended = read<traced::ActivityEnds>(record);
      return std::string(name_of(ended.activity)) + (ended.as_planned ? "" : " (cut short)");
    }
    case TraceKind::OrderReleased:
      return std::to_string(read<traced::OrderReleased>(record).transport.value);
    case TraceKind::TransportDone:
      return std::to_string(read<traced::TransportDone>(record).transport.value);
    case TraceKind::Sent:
    case TraceKind::Lost:
    case TraceKind::LostInOutage:
    case TraceKind::LostByInterference:
    case TraceKind::LostToSource:
    case TraceKind::Received:
      return message_details(record);
    case TraceKind::TimerWentOff:
      return std::to_string(read<traced::TimerWentOff>(record).timer);
    case TraceKind::CallRefused:
      return std::to_string(read<traced::CallRefused>(record).call);
    case TraceKind::Contact:
      return "with " + body(read<traced::Contact>(record).other);
    case TraceKind::SafeMode:
      return read<traced::SafeMode>(record).on ? "1" : "0";
    case TraceKind::StoppedByAgent:
      return read<traced::StoppedByAgent>(record).on ? "1" : "0";
    case TraceKind::WaitingFor: {
      const auto waiting = read<traced::WaitingFor>(record);
      return waiting.agv.valid() ? body(waiting.agv) : "nobody";
    }
    case TraceKind::LoadMoves: {
      const auto [load, to] = read<traced::LoadMoves>(record);
      return fmt::format("{} {}", load.value, holder_text(scenario_, to));
    }
    case TraceKind::FaultStrikes:
      return name_of(read<traced::FaultStrikes>(record).fault);
    case TraceKind::FaultOver:
      return name_of(read<traced::FaultOver>(record).fault);
    case TraceKind::ScannerStops:
      return "for " + body(read<traced::ScannerStops>(record).body);
    case TraceKind::OperatorAssists:
      return text_of(read<traced::OperatorAssists>(record).assist);
    case TraceKind::Appears:
      if (record.entity.index() >= scenario_.agvs.size()) return {};
      return "at " + scenario_.map->station(read<traced::Appears>(record).station).name;
    case TraceKind::Probe:
    case TraceKind::Log:
      return std::string(text);
    case TraceKind::Described:
    case TraceKind::AgentState:
    case TraceKind::Belief:
    case TraceKind::NotesLeftOut:
      return note_details(record, text);
    case TraceKind::AgentCrashed:
    case TraceKind::AgentHung:
    case TraceKind::BatteryEmpty:
    case TraceKind::Leaves:
      return {};
  }
  return {};
}

std::string TracePrinter::message_details(const TraceRecord& record) const {
  const bool is_sent = record.kind == TraceKind::Sent;
  const auto sent = traced::Sent::of(record);
  const auto reception = traced::Reception::of(record);
  const auto kind = described_.find(is_sent ? sent.message_hash : reception.message_hash);
  return (!is_sent        ? "from " + body_name(scenario_, reception.sender)
          : sent.to_all() ? "to all"
                          : "to " + body_name(scenario_, sent.receiver)) +
         (kind == described_.end() ? "" : ": " + kind->second);
}

std::string TracePrinter::note_details(const TraceRecord& record, std::string_view text) const {
  if (record.kind == TraceKind::NotesLeftOut) return std::to_string(read<traced::NotesLeftOut>(record).count);
  if (record.kind != TraceKind::Belief) return text.empty() ? "none" : std::string(text);
  const auto belief = read<traced::Belief>(record);
  std::string heading;
  const NotedPose& where = belief.where;
  if (where.has_heading()) {
    heading = fmt::format(" heading ({:.2f}, {:.2f})", where.heading_x / NotedPose::kHeadingUnits,
                          where.heading_y / NotedPose::kHeadingUnits);
  }
  return fmt::format("{} was at ({:.2f}, {:.2f}){} at {:.3f} s", body_name(scenario_, belief.about), where.x_mm / 1e3,
                     where.y_mm / 1e3, heading, static_cast<double>(belief.as_of_ns) / 1e9);
}

void TracePrinter::record(const TraceRecord& record, std::string_view text) {
  if (record.kind == TraceKind::Described) {
    described_[read<traced::Described>(record).message_hash] = text;
    return;
  }
  talk_text(fmt::format("{:>12.6f}  {:<6} {:<14} {}\n", to_seconds(record.at), shown_name(scenario_, record.entity),
                        name_of(record.kind), printable(details_of(record, text))),
            kForever_ms);
}

}  // namespace fleetproof::cli
