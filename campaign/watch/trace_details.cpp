#include "campaign/watch/trace_details.hpp"

#include <fmt/format.h>

#include <array>

#include "campaign/watch/run_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/note_records.hpp"

namespace fleetproof {
namespace {

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
    case Holder::Kind::Withdrawn:
      return "gone: its transport was withdrawn";
  }
  return "?";
}

std::string begun_text(const traced::ActivityBegins& begun, EntityId agv, const TraceContext& context) {
  const std::string activity = name_of(begun.activity);
  if (begun.activity == ActivityKind::Turn)
    return fmt::format("{} to {:.1f} deg", activity, context.turn_goal_deg(agv));
  if (begun.activity != ActivityKind::Drive) return activity;
  return activity + " " + context.scenario().map->segment(begun.segment()).name + (begun.backward() ? " backward" : "");
}

std::string ended_text(const traced::ActivityEnds& ended, EntityId agv, const TraceContext& context) {
  const std::string activity = name_of(ended.activity);
  if (ended.as_planned) return activity;
  if (ended.activity != ActivityKind::Turn) return activity + " (cut short)";
  return fmt::format("{} (cut short, it was to end at {:.1f} deg)", activity, context.turn_goal_deg(agv));
}

// The calls that begin an action, by fp_call.
std::string refused_text(const traced::CallRefused& refused, const Scenario& scenario) {
  constexpr std::array kCalls = {"move", "pick", "drop", "park", "charge"};
  const std::string call = refused.call < kCalls.size() ? kCalls[refused.call] : std::to_string(refused.call);
  return refused.segment.valid() && refused.segment.index() < scenario.map->segment_count()
             ? call + " " + scenario.map->segment(refused.segment).name
             : call;
}

std::string order_text(const TraceRecord& record) {
  const auto number = [](TransportId transport) { return std::to_string(transport.value); };
  if (record.kind == TraceKind::OrderReleased) return number(read<traced::OrderReleased>(record).transport);
  if (record.kind == TraceKind::TransportDone) return number(read<traced::TransportDone>(record).transport);
  if (record.kind == TraceKind::OrderWithdrawn) return number(read<traced::OrderWithdrawn>(record).transport);
  const TransportId work = read<traced::WorksOn>(record).transport;
  return work.valid() ? number(work) : "nothing";
}

std::string waiting_text(const traced::WaitingFor& waiting, const Scenario& scenario) {
  return waiting.agv.valid() ? body_name(scenario, waiting.agv) : "nobody";
}

std::string kept_text(const traced::Kept& kept) {
  return kept.size == 0 ? fmt::format("record {} no more", kept.number)
                        : fmt::format("record {}, {} bytes", kept.number, kept.size);
}

std::string message_details(const TraceRecord& record, const TraceContext& context) {
  const TracedMessage& message = context.message_of(record);
  const auto name = [&](EntityId agv) { return body_name(context.scenario(), agv); };
  if (record.kind == TraceKind::Sent)
    return message.text() + (read<traced::Sent>(record).to_all() ? " to all" : " to " + name(message.receiver));
  const std::string from = message.text() + " from " + name(message.sender);
  if (record.kind != TraceKind::Received) return from;
  return fmt::format("{}, sent {}, {:.3f} s old", from, nanosecond_text(message.sent),
                     to_seconds(record.at) - to_seconds(message.sent));
}

std::string note_details(const TraceRecord& record, std::string_view text, const TraceContext& context) {
  if (record.kind == TraceKind::NotesLeftOut) return std::to_string(read<traced::NotesLeftOut>(record).count);
  if (record.kind != TraceKind::Belief) return text.empty() ? "none" : std::string(text);
  const auto belief = read<traced::Belief>(record);
  std::string heading;
  const NotedPose& where = belief.where;
  if (where.has_heading()) {
    heading = fmt::format(" heading ({:.2f}, {:.2f})", where.heading_x / NotedPose::kHeadingUnits,
                          where.heading_y / NotedPose::kHeadingUnits);
  }
  return fmt::format("{} was at ({:.2f}, {:.2f}){} at {:.3f} s", body_name(context.scenario(), belief.about),
                     where.x_mm / 1e3, where.y_mm / 1e3, heading, static_cast<double>(belief.as_of_ns) / 1e9);
}

std::string denied_text(const traced::Denied& denied, EntityId body, const Scenario& scenario) {
  const auto what = [&]() -> std::string {
    if (denied.why == Denial::NoSuchKind) return "spared kind " + scenario.radio.adverse.spared_kinds[denied.number];
    if (denied.why == Denial::NotSent) {
      const GivenDelivery& delivery = scenario.deliveries[denied.number];
      return fmt::format("delivery to {} of what is sent at {:.9f} s", body_name(scenario, delivery.receiver),
                         to_seconds(delivery.sent));
    }
    return body < scenario.first_obstacle() ? text_of(scenario.faults[denied.number]) : "obstacle";
  };
  return fmt::format("{}: {}", what(), name_of(denied.why));
}

}  // namespace

std::string nanosecond_text(SimTime t) {
  const auto ns = to_ns(t);
  return fmt::format("{}.{:09}", ns / 1'000'000'000, ns % 1'000'000'000);
}

std::string trace_details(const TraceRecord& record, std::string_view text, const TraceContext& context) {
  const Scenario& scenario = context.scenario();
  const auto body = [&](EntityId id) { return body_name(scenario, id); };
  switch (record.kind) {
    case TraceKind::ActivityBegins:
      return begun_text(read<traced::ActivityBegins>(record), record.entity, context);
    case TraceKind::ActivityEnds:
      return ended_text(read<traced::ActivityEnds>(record), record.entity, context);
    case TraceKind::OrderReleased:
    case TraceKind::TransportDone:
    case TraceKind::OrderWithdrawn:
    case TraceKind::WorksOn:
      return order_text(record);
    case TraceKind::Sent:
    case TraceKind::Lost:
    case TraceKind::LostInOutage:
    case TraceKind::LostByInterference:
    case TraceKind::LostToSource:
    case TraceKind::Received:
      return message_details(record, context);
    case TraceKind::TimerWentOff:
      return std::to_string(read<traced::TimerWentOff>(record).timer);
    case TraceKind::CallRefused:
      return refused_text(read<traced::CallRefused>(record), scenario);
    case TraceKind::Contact:
      return "with " + body(read<traced::Contact>(record).other);
    case TraceKind::SafeMode:
      return read<traced::SafeMode>(record).on ? "on" : "off";
    case TraceKind::StoppedByAgent:
      return read<traced::StoppedByAgent>(record).on ? "begins" : "ends";
    case TraceKind::Kept:
      return kept_text(read<traced::Kept>(record));
    case TraceKind::WaitingFor:
      return waiting_text(read<traced::WaitingFor>(record), scenario);
    case TraceKind::LoadMoves: {
      const auto [load, to] = read<traced::LoadMoves>(record);
      return fmt::format("{} {}", load.value, holder_text(scenario, to));
    }
    case TraceKind::FaultStrikes:
      return text_of(scenario.faults[read<traced::FaultStrikes>(record).number]);
    case TraceKind::FaultOver:
      return text_of(scenario.faults[read<traced::FaultOver>(record).number]);
    case TraceKind::Denied:
      return denied_text(read<traced::Denied>(record), record.entity, scenario);
    case TraceKind::ScannerStops:
      return "for " + body(read<traced::ScannerStops>(record).body);
    case TraceKind::OperatorAssists:
      return text_of(read<traced::OperatorAssists>(record).assist);
    case TraceKind::Appears:
      if (record.entity.index() >= scenario.agvs.size()) return {};
      return "at " + scenario.map->station(read<traced::Appears>(record).station).name;
    case TraceKind::Probe:
    case TraceKind::Log:
      return std::string(text);
    case TraceKind::Described:
    case TraceKind::AgentState:
    case TraceKind::Belief:
    case TraceKind::NotesLeftOut:
      return note_details(record, text, context);
    case TraceKind::DeliveryDecided:
    case TraceKind::CallAccepted:
    case TraceKind::AgentCrashed:
    case TraceKind::AgentHung:
    case TraceKind::BatteryEmpty:
    case TraceKind::Leaves:
      return {};
  }
  return {};
}

}  // namespace fleetproof
