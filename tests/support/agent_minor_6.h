// The declarations of fleetproof/agent.h, minor version 6. Agents were built with them: never change this file.
#ifndef FLEETPROOF_AGENT_H
#define FLEETPROOF_AGENT_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
typedef enum fp_purpose { FP_ROUTING = 1, FP_STORAGE = 2, FP_CHARGING = 4, FP_PARKING = 8 } fp_purpose;
typedef struct fp_pose {
  double x_m, y_m;
  double heading_x, heading_y;
} fp_pose;
typedef struct fp_station {
  const char* name;
  double x_m, y_m;
  uint32_t purposes;
  uint32_t lane_count;
  const uint32_t* lanes;
  uint32_t turning_forbidden;
  double heading_x, heading_y;
} fp_station;
typedef struct fp_arc {
  fp_pose start;
  double length_m;
  double curvature_per_m;
} fp_arc;
typedef enum fp_load_state { FP_ANY_LOAD = 0, FP_EMPTY_ONLY = 1, FP_LOADED_ONLY = 2 } fp_load_state;
typedef struct fp_permission {
  uint32_t vehicle_type;
  uint32_t load;
} fp_permission;
#define FP_ANY_TYPE 0xffffffffu
#define FP_BACKWARD 0x80000000u
typedef struct fp_lane {
  uint32_t segment;
  uint32_t from, to;
  double length_m;
  uint32_t arc_count;
  const fp_arc* arcs;
  double speed_limit_mps;
  double width_m;
  uint32_t block_count;
  const uint32_t* blocks;
  uint32_t backward;
  uint32_t permission_count;
  const fp_permission* permissions;
} fp_lane;
typedef enum fp_block_kind { FP_ONE_VEHICLE = 0, FP_SAME_DIRECTION = 1 } fp_block_kind;
typedef struct fp_block {
  const char* name;
  uint32_t kind;
} fp_block;
typedef struct fp_map {
  uint32_t struct_size;
  uint32_t station_count, lane_count, segment_count;
  uint32_t station_stride, lane_stride, arc_stride;
  const fp_station* stations;
  const fp_lane* lanes;
  uint32_t block_count, block_stride;
  const fp_block* blocks;
} fp_map;
#ifdef __cplusplus
#define FP_CAST(type, value) reinterpret_cast<type>(value)
#else
#define FP_CAST(type, value) ((type)(value))
#endif
static inline const fp_station* fp_station_at(const fp_map* map, uint32_t station) {
  const size_t index = station;
  return FP_CAST(const fp_station*, FP_CAST(const char*, map->stations) + index * map->station_stride);
}
static inline const fp_lane* fp_lane_at(const fp_map* map, uint32_t lane) {
  const size_t index = lane;
  return FP_CAST(const fp_lane*, FP_CAST(const char*, map->lanes) + index * map->lane_stride);
}
static inline const fp_arc* fp_arc_at(const fp_map* map, const fp_lane* lane, uint32_t arc) {
  const size_t index = arc;
  return FP_CAST(const fp_arc*, FP_CAST(const char*, lane->arcs) + index * map->arc_stride);
}
typedef struct fp_agv {
  double length_m, width_m;
  double speed_mps, acceleration_mps2, deceleration_mps2;
  double turn_speed_radps, turn_acceleration_radps2, turn_deceleration_radps2;
  double loaded_length_m, loaded_width_m;
  double speed_deviation;
  double centre_ahead_m;
  double reverse_speed_mps;
  uint32_t vehicle_type;
} fp_agv;
static inline const fp_agv* fp_agv_at(const fp_agv* fleet, uint32_t stride, uint32_t agv) {
  const size_t index = agv;
  return FP_CAST(const fp_agv*, FP_CAST(const char*, fleet) + index * stride);
}
typedef struct fp_facts fp_facts;
typedef struct fp_answer fp_answer;
typedef void (*fp_derive)(const fp_facts* facts, uint64_t question, fp_answer* to);
typedef struct fp_facts {
  uint32_t struct_size;
  uint32_t fleet_count;
  uint32_t agv_stride;
  const fp_agv* fleet;
  const fp_map* map;
  double safety_distance_m;
  const void* (*ask)(const fp_facts*, fp_derive derive, uint64_t question, uint64_t* size);
  void (*answer)(fp_answer* to, const void* bytes, uint64_t size);
  void* host;
} fp_facts;
#define FP_ABI_MAJOR 1u
#define FP_ABI_MINOR 6u
#define FP_NONE 0xffffffffu
#define FP_HERE FP_NONE
#define FP_MESSAGE_BYTES_MAX 1024u
#define FP_DISK_BYTES 1048576u
#define FP_RECORD_OVERHEAD 16u
typedef enum fp_result { FP_OK = 0, FP_EMPTY = 1, FP_REFUSED = -1, FP_INVALID = -2, FP_SUSPENDED = -3 } fp_result;
typedef enum fp_action {
  FP_IDLE = 0,
  FP_DRIVING,
  FP_TURNING,
  FP_PICKING,
  FP_DROPPING,
  FP_PARKED,
  FP_CHARGING_NOW,
  FP_OUT_OF_ORDER,
  FP_STOPPED
} fp_action;
typedef struct fp_scripted_call {
  int64_t at_ns;
  uint32_t action;
  uint32_t segment;
} fp_scripted_call;
typedef enum fp_call { FP_CALL_MOVE = 0, FP_CALL_PICK, FP_CALL_DROP, FP_CALL_PARK, FP_CALL_CHARGE } fp_call;
typedef enum fp_role { FP_AGV = 0, FP_COMPUTER } fp_role;
typedef struct fp_computer {
  const char* name;
  uint32_t has_antenna;
  double x_m, y_m;
} fp_computer;
typedef enum fp_orders { FP_ORDERS_ASSIGNED = 0, FP_ORDERS_OPEN } fp_orders;
typedef struct fp_briefing {
  uint32_t struct_size;
  uint32_t self;
  uint32_t fleet_count;
  uint32_t agv_stride;
  const fp_agv* fleet;
  const fp_map* map;
  uint32_t start_station;
  uint32_t script_count;
  const fp_scripted_call* script;
  double safety_distance_m;
  double radio_range_m;
  const char* config;
  uint32_t boot;
  uint32_t start_segment;
  uint32_t next_segment;
  const fp_facts* facts;
  uint32_t role;
  uint32_t computer_count;
  uint32_t computer_stride;
  uint32_t vehicle_type_count;
  const fp_computer* computers;
  const char* const* agv_names;
  const char* const* vehicle_type_names;
  const char* const* segment_names;
  uint32_t orders;
  uint64_t seed;
} fp_briefing;
typedef enum fp_event_kind {
  FP_EVENT_START = 0,
  FP_EVENT_ORDER,
  FP_EVENT_MESSAGE,
  FP_EVENT_TIMER,
  FP_EVENT_ACTION_DONE,
  FP_EVENT_FAULT = 5,
  FP_EVENT_WITHDRAWN = 6
} fp_event_kind;
typedef struct fp_event {
  uint32_t struct_size;
  uint32_t kind;
  int64_t now_ns;
  uint32_t timer;
  int32_t result;
  uint32_t order_id, from, to;
  const char* fault_word;
  int64_t fault_length_ns;
  uint32_t fault_number;
} fp_event;
typedef struct fp_message {
  uint32_t struct_size;
  uint32_t sender;
  uint32_t size;
  const void* bytes;
} fp_message;
typedef struct fp_occupancy {
  uint32_t struct_size;
  uint32_t vehicle_type;
  uint32_t load;
  uint32_t lane;
  uint32_t station;
  double heading_x, heading_y;
} fp_occupancy;
typedef struct fp_record {
  uint32_t struct_size;
  uint32_t size;
  const void* bytes;
} fp_record;
typedef struct fp_perceived {
  uint32_t struct_size;
  uint32_t action;
  uint32_t order_id;
  uint32_t message_count;
  const fp_message* messages;
  uint32_t message_stride;
  double battery_level;
  fp_pose pose;
  int64_t now_ns;
} fp_perceived;
typedef struct fp_controller fp_controller;
typedef struct fp_host {
  uint32_t struct_size;
  uint32_t abi_major, abi_minor;
  int32_t (*move)(fp_controller*, uint32_t segment);
  int32_t (*pick)(fp_controller*, uint32_t segment);
  int32_t (*drop)(fp_controller*, uint32_t segment);
  int32_t (*park)(fp_controller*, uint32_t segment);
  int32_t (*charge)(fp_controller*, uint32_t segment);
  int32_t (*send_broadcast)(fp_controller*, const void* bytes, uint32_t size);
  int32_t (*send_unicast)(fp_controller*, const void* bytes, uint32_t size, uint32_t receiver);
  int32_t (*get_position)(fp_controller*, fp_pose* out);
  int32_t (*get_battery_level)(fp_controller*, double* out);
  int32_t (*get_message)(fp_controller*, fp_message* out);
  int32_t (*is_loaded)(fp_controller*, uint32_t* out);
  int32_t (*get_action)(fp_controller*, uint32_t* out);
  int64_t (*now_ns)(fp_controller*);
  int32_t (*set_timer)(fp_controller*, uint32_t timer, int64_t at_ns);
  uint64_t (*random)(fp_controller*, uint32_t purpose, uint64_t index);
  int32_t (*declare_cost_ns)(fp_controller*, int64_t cost_ns);
  int32_t (*safe_mode)(fp_controller*, uint32_t on);
  int32_t (*waiting_for)(fp_controller*, uint32_t agv);
  int32_t (*sometimes)(fp_controller*, const char* probe);
  int32_t (*log)(fp_controller*, const char* text);
  int32_t (*pick_load)(fp_controller*, uint32_t segment, uint32_t order_id);
  int32_t (*get_load)(fp_controller*, uint32_t* order_id);
  int32_t (*stop)(fp_controller*);
  int32_t (*go_on)(fp_controller*);
  void (*describe)(fp_controller*, const char* kind);
  void (*declare_state)(fp_controller*, const char* state);
  void (*believe)(fp_controller*, uint32_t agv, const fp_pose* where, int64_t as_of_ns);
  int32_t (*cannot_start)(fp_controller*, const char* why);
  int32_t (*keep)(fp_controller*, uint32_t record, const void* bytes, uint32_t size);
  int32_t (*recall)(fp_controller*, uint32_t record, fp_record* out);
  int32_t (*conflict)(fp_controller*, const fp_occupancy* a, const fp_occupancy* b, double margin_m, uint32_t* out);
  int32_t (*works_on)(fp_controller*, uint32_t agv, uint32_t order_id);
  int32_t (*declare_waiting)(fp_controller*, uint32_t agv, uint32_t for_agv);
  int32_t (*fail)(fp_controller*, uint32_t hang, const char* text);
  int32_t (*perceive)(fp_controller*, fp_perceived* out);
} fp_host;
#define FP_DETERMINISTIC 1u
#define FP_SERVES_COMPUTERS 2u
typedef struct fp_bridge {
  uint32_t struct_size;
  void* own;
  void* (*create_in)(void* own, const fp_host* host, fp_controller* controller, const fp_briefing* briefing);
  void (*run_ends)(void* own);
  uint32_t (*knows_fault_in)(void* own, const char* word);
} fp_bridge;
typedef struct fp_agent_type {
  uint32_t struct_size;
  uint32_t abi_major, abi_minor;
  uint32_t flags;
  const char* name;
  const char* description;
  void* (*create)(const fp_host* host, fp_controller* controller, const fp_briefing* briefing);
  void (*on_event)(void* agent, const fp_event* event);
  void (*destroy)(void* agent);
  uint32_t (*knows_fault)(const char* word);
  const fp_bridge* bridge;
} fp_agent_type;
typedef const fp_agent_type* (*fp_agent_query_function)(uint32_t host_abi_major);
#define FP_AGENT_QUERY_SYMBOL "fp_agent_query"
#ifdef __cplusplus
}
#endif
#endif
