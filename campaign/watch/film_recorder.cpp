#include "campaign/watch/film_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/watch/film_floor.hpp"
#include "campaign/watch/run_text.hpp"
#include "campaign/watch/trace_details.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/note_records.hpp"
#include "core/scenario/order_table.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kLongestText = 160;

bool is_fault(TraceKind kind) {
  return kind == TraceKind::FaultStrikes || kind == TraceKind::FaultOver || kind == TraceKind::AgentCrashed ||
         kind == TraceKind::AgentHung || kind == TraceKind::BatteryEmpty;
}
bool is_note(TraceKind kind) {
  return kind == TraceKind::Probe || kind == TraceKind::Log || kind == TraceKind::NotesLeftOut;
}

web::Receipt receipt_of(TraceKind kind) {
  switch (kind) {
    case TraceKind::LostInOutage:
      return web::Receipt::LostInOutage;
    case TraceKind::LostByInterference:
      return web::Receipt::LostByInterference;
    case TraceKind::LostToSource:
      return web::Receipt::LostToSource;
    case TraceKind::Lost:
      return web::Receipt::LostByChance;
    default:
      return web::Receipt::Received;
  }
}

// From -179 to 180 degrees, without a minus before a zero.
std::string goal_text(double goal_deg) {
  const auto degrees = static_cast<int>(std::lround(goal_deg));
  return fmt::format("to {}\u00b0", degrees <= -180 ? degrees + 360 : degrees);
}

}  // namespace

FilmRecorder::FilmRecorder(const Scenario& scenario)
    : scenario_(scenario), context_(scenario), pieces_(*scenario.map), deliveries_(scenario.deliveries) {}

void FilmRecorder::piece_started(const Piece& piece) {
  context_.note(piece);
  if (piece.manner != Manner::Drive) return;
  const Lane& lane = lane_of(*scenario_.map, piece);
  way_of_[piece.entity] = fmt::format("{} to {}{}", scenario_.map->station(lane.from).name,
                                      scenario_.map->station(lane.to).name, lane.is_backward() ? ", backward" : "");
}

void FilmRecorder::record(const TraceRecord& record, std::string_view text) {
  context_.note(record, text);
  ++order_;
  switch (record.kind) {
    case TraceKind::ActivityBegins:
    case TraceKind::ActivityEnds:
      return note_activity(record);
    case TraceKind::Sent:
    case TraceKind::Received:
    case TraceKind::Lost:
    case TraceKind::LostInOutage:
    case TraceKind::LostByInterference:
    case TraceKind::LostToSource:
      return note_message(record);
    case TraceKind::Belief:
      return note_belief(record);
    case TraceKind::WaitingFor:
      return note_waiting(record);
    case TraceKind::AgentState:
      film_.states.push_back({record.entity.index(), film_us(record.at), printable(text, kLongestText), order_});
      return;
    case TraceKind::DeliveryDecided:
      return note_delivery(record);
    case TraceKind::CallAccepted:
      return note_command(record);
    case TraceKind::Described:
    case TraceKind::TimerWentOff:
      return;
    case TraceKind::LoadMoves:
      return note_load(record);
    case TraceKind::OrderReleased:
    case TraceKind::TransportDone:
      return note_order(record);
    default:
      return note_happening(record, text);
  }
}

void FilmRecorder::end_activity(std::size_t body, SimTime at) {
  const auto open = open_.find(body);
  if (open == open_.end()) return;
  open->second.end_us = film_us(at);
  open->second.end_order = order_;
  film_.activities.push_back(std::move(open->second));
  open_.erase(open);
}

void FilmRecorder::note_activity(const TraceRecord& record) {
  const std::size_t body = record.entity.index();
  end_activity(body, record.at);
  if (record.kind == TraceKind::ActivityEnds) return;
  const ActivityKind kind = traced::activity_of(record);
  web::ActivityBar bar{body, film_us(record.at), 0, name_of(kind), {}, order_};
  if (kind == ActivityKind::Drive) bar.details = way_of_[record.entity];
  if (kind == ActivityKind::Turn) bar.details = goal_text(context_.turn_goal_deg(record.entity));
  if (kind == ActivityKind::Drive) set_command(bar, read<traced::ActivityBegins>(record).segment());
  if (kind == ActivityKind::Turn) set_command(bar, {});
  open_[body] = std::move(bar);
}

void FilmRecorder::note_command(const TraceRecord& record) {
  const SegmentId segment = read<traced::CallAccepted>(record).segment;
  if (segment.valid()) commands_[record.entity.index()].push_back({film_us(record.at), order_, segment});
}

// A drive goes along the segment of its command. A turn stands before the drive of the last command: while an AGV
// turns, it has no other one.
void FilmRecorder::set_command(web::ActivityBar& bar, SegmentId driven) {
  std::vector<Command>& given = commands_[bar.body];
  const auto command =
      driven.valid() ? std::ranges::find(given, driven, &Command::segment) : given.end() - (given.empty() ? 0 : 1);
  if (command == given.end()) return;
  bar.commanded_us = command->at_us;
  bar.commanded_order = command->order;
  if (driven.valid()) given.erase(given.begin(), command + 1);
}

void FilmRecorder::note_message(const TraceRecord& record) {
  const TracedMessage& traced = context_.message_of(record);
  if (record.kind == TraceKind::Sent) {
    message_of_[traced.number] = film_.messages.size();
    web::Message& message = film_.messages.emplace_back();
    message.number = traced.number;
    message.bytes = traced.bytes;
    message.sender = traced.sender.index();
    if (traced.receiver.valid()) message.receiver = traced.receiver.index();
    message.sent_us = film_us(record.at);
    message.kind = printable(traced.kind, kLongestText);
    message.content = printable(traced.content, kLongestText);
    message.order = order_;
    message.is_described = traced.is_described();
    return;
  }
  note_arrival(record, film_.messages[message_of_.at(traced.number)]);
}

void FilmRecorder::note_arrival(const TraceRecord& record, web::Message& message) {
  const Reception reception{message.number, record.entity.index()};
  web::Arrival arrival{record.entity.index(), receipt_of(record.kind), film_us(record.at) - message.sent_us, order_};
  arrival.is_given = given_.contains(reception);
  if (arrival.receipt == web::Receipt::LostByChance && arrival.is_given) arrival.receipt = web::Receipt::LostAsGiven;
  message.arrivals.push_back(arrival);
  const auto known = under_way_.find(reception);
  if (known == under_way_.end()) return;
  // Of two copies, the one that was due is here.
  auto& due_us = known->second;
  if (arrival.receipt == web::Receipt::Received && due_us.size() > 1) {
    due_us.erase(std::ranges::min_element(due_us));
  } else {
    under_way_.erase(known);
  }
}

void FilmRecorder::note_delivery(const TraceRecord& record) {
  const auto decided = read<traced::DeliveryDecided>(record);
  const AgvId receiver{record.entity.index()};
  const Reception reception{decided.number, receiver.index()};
  if (!decided.lost) under_way_[reception].push_back(film_us(decided.due_after));
  if (deliveries_.of({decided.sender, receiver, record.at, decided.ordinal}) != nullptr) given_.insert(reception);
}

void FilmRecorder::note_belief(const TraceRecord& record) {
  const auto belief = read<traced::Belief>(record);
  const NotedPose& where = belief.where;
  web::Belief noted;
  noted.body = record.entity.index();
  noted.about = belief.about.index();
  noted.at_us = film_us(record.at);
  noted.as_of_us = film_us(Duration{belief.as_of_ns});
  noted.x_um = std::int64_t{where.x_mm} * 1000;
  noted.y_um = std::int64_t{where.y_mm} * 1000;
  if (where.has_heading()) {
    const Vec2 heading(where.heading_x, where.heading_y);
    noted.heading_urad = film_urad(heading);
  }
  if (noted.about < scenario_.agvs.size()) film_.beliefs.push_back(noted);
}

// An agent repeats itself: only what changes is kept.
void FilmRecorder::note_waiting(const TraceRecord& record) {
  const AgvId agv = read<traced::WaitingFor>(record).agv;
  const std::size_t body = record.entity.index();
  std::optional<std::size_t> for_whom;
  if (agv.valid() && agv.index() < scenario_.participant_count()) for_whom = agv.index();
  const auto [known, fresh] = waits_.emplace(body, std::nullopt);
  if (known->second == for_whom) return;
  known->second = for_whom;
  film_.waits.push_back({body, film_us(record.at), for_whom, order_});
}

void FilmRecorder::note_load(const TraceRecord& record) {
  const auto [load, to] = read<traced::LoadMoves>(record);
  const auto before = carrier_of_.find(load);
  if (before != carrier_of_.end()) {
    film_.loads.push_back({before->second, film_us(record.at), false});
    carrier_of_.erase(before);
  }
  if (to.kind == Holder::Kind::Agv) {
    film_.loads.push_back({to.index, film_us(record.at), true});
    carrier_of_[load] = to.index;
  }
}

void FilmRecorder::note_order(const TraceRecord& record) {
  const bool released = record.kind == TraceKind::OrderReleased;
  const TransportId transport =
      released ? read<traced::OrderReleased>(record).transport : read<traced::TransportDone>(record).transport;
  const TransportOrder& order = OrderTable(scenario_).order(transport);
  const std::string from = scenario_.map->station(order.from).name, to = scenario_.map->station(order.to).name;
  const std::size_t body = teller_of(record).index();
  if (released && !order_of_.contains(transport.index())) {
    order_of_[transport.index()] = film_.orders.size();
    film_.orders.push_back({body, transport.value, from, to, film_us(record.at), {}});
  }
  const auto known = order_of_.find(transport.index());
  if (!released && known != order_of_.end()) {
    film_.orders[known->second].body = body;
    film_.orders[known->second].done_us = film_us(record.at);
  }
  film_.happenings.push_back({body, film_us(record.at), released ? "order" : "transport done",
                              fmt::format("{}: {} to {}", transport.value, from, to), false, false, order_});
}

EntityId FilmRecorder::teller_of(const TraceRecord& record) const {
  if (record.entity.valid()) return record.entity;
  return scenario_.computers.empty() ? EntityId{0U} : scenario_.first_computer();
}

void FilmRecorder::note_happening(const TraceRecord& record, std::string_view text) {
  web::Happening happening{teller_of(record).index(), film_us(record.at), name_of(record.kind),
                           printable(trace_details(record, text, context_), kLongestText)};
  happening.is_fault = is_fault(record.kind);
  happening.is_note = is_note(record.kind);
  happening.order = order_;
  film_.happenings.push_back(std::move(happening));
}

web::Film FilmRecorder::take(SimTime end) {
  ++order_;
  while (!open_.empty()) end_activity(open_.begin()->first, end);
  for (const auto& [reception, due_us] : under_way_) {
    const auto& [number, receiver] = reception;
    for (const std::int64_t after_us : due_us)
      film_.messages[message_of_.at(number)].arrivals.push_back(
          {receiver, web::Receipt::Received, after_us, order_, given_.contains(reception)});
  }
  std::ranges::stable_sort(film_.activities, {}, &web::ActivityBar::begin_us);
  film_.end_us = film_us(end);
  return std::move(film_);
}

}  // namespace fleetproof
