#include "campaign/run/itinerary.hpp"

#include <algorithm>
#include <bit>

#include "core/motion/piece.hpp"
#include "core/outcome/trace_records.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kDepartureBytes = 3 * 4 + 2 * 8 + 4 * 8, kDoneBytes = 2 * 4 + 8;

void put(ByteSink& sink, const Vec2& v) {
  for (const double value : {v.x(), v.y()}) sink.u64(std::bit_cast<std::uint64_t>(value));
}

Vec2 take_vector(ByteSource& source) {
  const double x = std::bit_cast<double>(source.u64());
  return {x, std::bit_cast<double>(source.u64())};
}

}  // namespace

void ItineraryKeeper::record(const TraceRecord& record, std::string_view) {
  if (record.kind == TraceKind::ActivityBegins || record.kind == TraceKind::ActivityEnds) turned(record);
  if (record.kind != TraceKind::TransportDone) return;
  found_.done.push_back({record.entity, read<traced::TransportDone>(record).transport, record.at});
}

void ItineraryKeeper::turned(const TraceRecord& record) {
  if (traced::activity_of(record) != ActivityKind::Turn) return;
  if (record.kind == TraceKind::ActivityBegins) {
    const auto station = traced::id_in<StationId>(read<traced::ActivityBegins>(record).subject);
    const Departure turn{.agv = record.entity, .at = record.at, .arrives = kForever, .from = station, .to = station};
    found_.turns.push_back(turn);
  } else {
    const auto last = std::ranges::find(found_.turns.rbegin(), found_.turns.rend(), record.entity, &Departure::agv);
    if (last != found_.turns.rend()) last->arrives = record.at;
  }
}

void ItineraryKeeper::piece_started(const Piece& piece) {
  if (piece.manner != Manner::Drive || piece.entity.index() >= scenario_.agvs.size()) return;
  auto& departures = found_.departures;
  const auto last = std::ranges::find(departures.rbegin(), departures.rend(), piece.entity, &Departure::agv);
  if (piece.way_begin_m > 0.0) {  // on the way, it brakes, or need not brake after all
    if (last != departures.rend()) last->arrives = piece.end;
    return;
  }
  const LogicalMap& map = *scenario_.map;
  const Segment& segment = map.segment(piece.segment);
  const auto distance = [&](StationId station) {
    return (map.station(station).position_m - piece.start.position_m).squaredNorm();
  };
  const bool along = distance(segment.from) <= distance(segment.to);
  const StationId from = along ? segment.from : segment.to, to = along ? segment.to : segment.from;
  const Departure departure{
      piece.entity, piece.begin, piece.end, from, to, piece.start.heading, piece.pose_at(piece.end).heading};
  if (last != departures.rend() && last->at == departure.at) {  // planned anew before it moved
    *last = departure;
  } else {
    departures.push_back(departure);
  }
}

namespace {

void put(ByteSink& sink, const std::vector<Departure>& departures) {
  sink.u32(static_cast<std::uint32_t>(departures.size()));
  for (const Departure& departure : departures) {
    for (const std::uint32_t id : {departure.agv.value, departure.from.value, departure.to.value}) sink.u32(id);
    for (const SimTime time : {departure.at, departure.arrives}) sink.i64(to_ns(time));
    put(sink, departure.heading);
    put(sink, departure.heading_there);
  }
}

std::vector<Departure> take_departures(ByteSource& source) {
  std::vector<Departure> departures(source.count(kDepartureBytes));
  for (Departure& departure : departures) {
    departure.agv.value = source.u32();
    departure.from.value = source.u32();
    departure.to.value = source.u32();
    for (SimTime* time : {&departure.at, &departure.arrives}) *time = at_ns(source.i64());
    departure.heading = take_vector(source);
    departure.heading_there = take_vector(source);
  }
  return departures;
}

}  // namespace

void put(ByteSink& sink, const Itinerary& itinerary) {
  put(sink, itinerary.departures);
  put(sink, itinerary.turns);
  sink.u32(static_cast<std::uint32_t>(itinerary.done.size()));
  for (const auto& [agv, transport, at] : itinerary.done) {
    sink.u32(agv.value);
    sink.u32(transport.value);
    sink.i64(to_ns(at));
  }
}

Itinerary take_itinerary(ByteSource& source) {
  Itinerary itinerary;
  itinerary.departures = take_departures(source);
  itinerary.turns = take_departures(source);
  itinerary.done.resize(source.count(kDoneBytes));
  for (auto& [agv, transport, at] : itinerary.done) {
    agv.value = source.u32();
    transport = TransportId{source.u32()};
    at = at_ns(source.i64());
  }
  return itinerary;
}

}  // namespace fleetproof
