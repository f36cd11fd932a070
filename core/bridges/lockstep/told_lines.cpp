#include "core/bridges/lockstep/told_lines.hpp"

#include <utility>

#include "core/bridges/lockstep/enumeration_words.hpp"
#include "core/bridges/lockstep/line_writer.hpp"

namespace fleetproof::lockstep {
namespace {

template <class Row>
const Row& row_of(const Row* rows, std::uint32_t stride, std::size_t i) {
  return *reinterpret_cast<const Row*>(reinterpret_cast<const char*>(rows) + i * stride);
}

void write_names(LineWriter& out, const char* key, const char* const* names, std::uint32_t count) {
  out.key(key);
  out.open('[');
  for (std::uint32_t i = 0; i < count; ++i) out.value(names[i]);
  out.close(']');
}

void write_numbers(LineWriter& out, const char* key, const std::uint32_t* numbers, std::uint32_t count) {
  out.key(key);
  out.open('[');
  for (std::uint32_t i = 0; i < count; ++i) out.value(numbers[i]);
  out.close(']');
}

void write_fleet(LineWriter& out, const fp_briefing& briefing) {
  out.key("fleet");
  out.open('[');
  for (std::uint32_t i = 0; i < briefing.fleet_count; ++i) {
    const fp_agv& agv = *fp_agv_at(briefing.fleet, briefing.agv_stride, i);
    out.open('{');
    out.member("name", briefing.agv_names[i]);
    out.member("length_m", agv.length_m);
    out.member("width_m", agv.width_m);
    out.member("speed_mps", agv.speed_mps);
    out.member("acceleration_mps2", agv.acceleration_mps2);
    out.member("deceleration_mps2", agv.deceleration_mps2);
    out.member("turn_speed_radps", agv.turn_speed_radps);
    out.member("turn_acceleration_radps2", agv.turn_acceleration_radps2);
    out.member("turn_deceleration_radps2", agv.turn_deceleration_radps2);
    out.member("loaded_length_m", agv.loaded_length_m);
    out.member("loaded_width_m", agv.loaded_width_m);
    out.member("speed_deviation", agv.speed_deviation);
    out.member("centre_ahead_m", agv.centre_ahead_m);
    out.member("reverse_speed_mps", agv.reverse_speed_mps);
    out.member("vehicle_type", agv.vehicle_type);
    out.close('}');
  }
  out.close(']');
}

void write_station(LineWriter& out, const fp_station& station) {
  out.open('{');
  out.member("name", station.name);
  out.member("x_m", station.x_m);
  out.member("y_m", station.y_m);
  out.key("purposes");
  out.open('[');
  for (const PurposeWord& purpose : kPurposeWords) {
    if ((station.purposes & static_cast<std::uint32_t>(purpose.bit)) != 0) out.value(purpose.word);
  }
  out.close(']');
  write_numbers(out, "lanes", station.lanes, station.lane_count);
  out.member("turning_forbidden", station.turning_forbidden != 0);
  out.key("heading");
  if (station.heading_x == 0.0 && station.heading_y == 0.0) {
    out.none();
  } else {
    out.values({station.heading_x, station.heading_y});
  }
  out.close('}');
}

void write_lane(LineWriter& out, const fp_map& map, const fp_lane& lane) {
  out.open('{');
  out.member("segment", lane.segment);
  out.member("from", lane.from);
  out.member("to", lane.to);
  out.member("length_m", lane.length_m);
  out.key("arcs");
  out.open('[');
  for (std::uint32_t i = 0; i < lane.arc_count; ++i) {
    const fp_arc& arc = *fp_arc_at(&map, &lane, i);
    out.open('{');
    out.member("start", arc.start);
    out.member("length_m", arc.length_m);
    out.member("curvature_per_m", arc.curvature_per_m);
    out.close('}');
  }
  out.close(']');
  out.member("speed_limit_mps", lane.speed_limit_mps);
  out.member("width_m", lane.width_m);
  write_numbers(out, "blocks", lane.blocks, lane.block_count);
  out.member("backward", lane.backward != 0);
  out.key("permissions");
  out.open('[');
  for (std::uint32_t i = 0; i < lane.permission_count; ++i) {
    out.open('{');
    out.id("vehicle_type", lane.permissions[i].vehicle_type);
    out.member("load", word_in(kLoadWords, lane.permissions[i].load));
    out.close('}');
  }
  out.close(']');
  out.close('}');
}

void write_map(LineWriter& out, const fp_map& map) {
  out.key("map");
  out.open('{');
  out.key("stations");
  out.open('[');
  for (std::uint32_t i = 0; i < map.station_count; ++i) write_station(out, *fp_station_at(&map, i));
  out.close(']');
  out.key("lanes");
  out.open('[');
  for (std::uint32_t i = 0; i < map.lane_count; ++i) write_lane(out, map, *fp_lane_at(&map, i));
  out.close(']');
  out.key("blocks");
  out.open('[');
  for (std::uint32_t i = 0; i < map.block_count; ++i) {
    const auto& block = row_of(map.blocks, map.block_stride, i);
    out.open('{');
    out.member("name", block.name);
    out.member("kind", word_in(kBlockWords, block.kind));
    out.close('}');
  }
  out.close(']');
  out.close('}');
}

void write_computers(LineWriter& out, const fp_briefing& briefing) {
  out.key("computers");
  out.open('[');
  for (std::uint32_t i = 0; i < briefing.computer_count; ++i) {
    const auto& computer = row_of(briefing.computers, briefing.computer_stride, i);
    out.open('{');
    out.member("name", computer.name);
    for (const auto& [key, place] : {std::pair("x_m", computer.x_m), std::pair("y_m", computer.y_m)}) {
      out.key(key);
      if (computer.has_antenna != 0) {
        out.value(place);
      } else {
        out.none();
      }
    }
    out.close('}');
  }
  out.close(']');
}

void write_kind(LineWriter& out, const fp_briefing& briefing, const fp_event& event) {
  switch (event.kind) {
    case FP_EVENT_START:
      out.member("role", word_in(kRoleWords, briefing.role));
      out.member("boot", briefing.boot);
      out.member("config", briefing.config);
      out.id("start_station", briefing.start_station);
      out.id("start_segment", briefing.start_segment);
      return out.id("next_segment", briefing.next_segment);
    case FP_EVENT_ORDER:
      out.member("order_id", event.order_id);
      out.member("from", event.from);
      return out.member("to", event.to);
    case FP_EVENT_WITHDRAWN:
      return out.member("order_id", event.order_id);
    case FP_EVENT_TIMER:
      return out.member("timer", event.timer);
    case FP_EVENT_ACTION_DONE:
      return out.member("result", result_word(event.result));
    case FP_EVENT_FAULT:
      out.member("fault_word", event.fault_word);
      out.member("fault_number", event.fault_number);
      return out.member("fault_length_ns", event.fault_length_ns);
    default:
      return;
  }
}

void write_refused(LineWriter& out, const std::vector<RefusedCall>& refused) {
  out.key("refused");
  out.open('[');
  for (const RefusedCall& call : refused) {
    out.open('{');
    out.member("call", call.place);
    out.member("name", std::string_view(call.name));
    out.member("result", result_word(call.result));
    out.close('}');
  }
  out.close(']');
}

}  // namespace

void write_hello(std::string& line) {
  LineWriter out(line);
  out.open('{');
  out.key("hello");
  out.open('{');
  out.member("protocol", 1);
  out.member("program", "fleetproof");
  out.close('}');
  out.close('}');
}

void write_run(const fp_briefing& briefing, std::string& line) {
  LineWriter out(line);
  out.open('{');
  out.key("run");
  out.open('{');
  out.bits("seed", briefing.seed);
  out.member("safety_distance_m", briefing.safety_distance_m);
  out.member("radio_range_m", briefing.radio_range_m);
  out.member("orders", word_in(kOrdersWords, briefing.orders));
  write_fleet(out, briefing);
  write_names(out, "vehicle_type_names", briefing.vehicle_type_names, briefing.vehicle_type_count);
  write_names(out, "segment_names", briefing.segment_names, briefing.map->segment_count);
  write_computers(out, briefing);
  write_map(out, *briefing.map);
  out.close('}');
  out.close('}');
}

void write_event(const fp_briefing& briefing, const fp_event& event, const fp_perceived& seen,
                 std::uint32_t told_before, const std::vector<RefusedCall>& refused, std::string& line) {
  LineWriter out(line);
  out.open('{');
  out.member("event", refused.empty() ? word_in(kEventWords, event.kind) : "refused");
  out.member("self", briefing.self);
  out.member("now_ns", seen.now_ns);
  if (refused.empty()) {
    write_kind(out, briefing, event);
  } else {
    write_refused(out, refused);
  }
  if (briefing.role == FP_AGV) {
    out.member("pose", seen.pose);
    out.member("battery_level", seen.battery_level);
    out.member("action", word_in(kActionWords, seen.action));
    out.id("load", seen.order_id);
  }
  out.key("messages");
  out.open('[');
  for (std::uint32_t i = told_before; i < seen.message_count; ++i) {
    const auto& message = row_of(seen.messages, seen.message_stride, i);
    out.open('{');
    out.member("sender", message.sender);
    out.bytes("bytes", message.bytes, message.size);
    out.close('}');
  }
  out.close(']');
  out.close('}');
}

void write_destroy(std::uint32_t participant, std::string& line) {
  LineWriter out(line);
  out.open('{');
  out.member("destroy", participant);
  out.close('}');
}

void write_bye(std::string& line) {
  LineWriter out(line);
  out.open('{');
  out.key("bye");
  out.open('{');
  out.close('}');
  out.close('}');
}

}  // namespace fleetproof::lockstep
