/* fleetproof/map.h: the logical map of a warehouse, as fleetproof/agent.h gives it to control software. Units and
 * versions are those of agent.h, which includes this file.
 */
#ifndef FLEETPROOF_MAP_H
#define FLEETPROOF_MAP_H

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
  uint32_t purposes; /* fp_purpose, or-ed */
  uint32_t lane_count;
  const uint32_t* lanes; /* indices of the lanes that leave this station */
  /* Since minor 2. */
  uint32_t turning_forbidden;  /* 1: no AGV turns on the spot here */
  double heading_x, heading_y; /* that an AGV must have, to 1e-7 rad, to pick, drop, park or charge here; (0, 0): any */
} fp_station;

/* A straight line (curvature 0) or a circular arc (positive curvature turns left) from `start` along its heading. */
typedef struct fp_arc {
  fp_pose start;
  double length_m;
  double curvature_per_m;
} fp_arc;

/* The arcs of a curved lane lie within 0.1 mm and 2 mrad of its track (the heading counts for the corners of a long
   AGV). The arcs join without kinks, and both ends are exact. Straight lanes are exact. Lanes may be built to the
   limit: the law forgives a distance that is too small by 1 um, and by 10 um more for each body on a bend. */

/* Who may drive a lane. */
typedef enum fp_load_state { FP_ANY_LOAD = 0, FP_EMPTY_ONLY = 1, FP_LOADED_ONLY = 2 } fp_load_state;

typedef struct fp_permission {
  uint32_t vehicle_type; /* the vehicle_type of an fp_agv; FP_ANY_TYPE: every type */
  uint32_t load;         /* fp_load_state */
} fp_permission;

#define FP_ANY_TYPE 0xffffffffu

/* Or-ed to the segment of an action: the AGV drives it backward. Without it, the AGV drives forward, or backward if
 * that is the only way. */
#define FP_BACKWARD 0x80000000u

/* One way to drive a segment: in one direction, forward or backward. All lanes of a segment have the same segment id.
 * The arcs are the way of the reference point; on a lane driven backward, the nose points against them. */
typedef struct fp_lane {
  uint32_t segment;
  uint32_t from, to; /* stations */
  double length_m;
  uint32_t arc_count;
  const fp_arc* arcs;
  /* Since minor 2. The controller keeps the speed limit by itself. `blocks`: indices into the map's blocks, ascending.
   */
  double speed_limit_mps; /* 0: no limit but the vehicle's own */
  double width_m;         /* of the floor drawn for this lane; 0: not known */
  uint32_t block_count;
  const uint32_t* blocks;
  uint32_t backward;         /* 1: the AGV drives tail first; its actions take segment | FP_BACKWARD */
  uint32_t permission_count; /* an AGV needs one of these; 0: every AGV may drive here */
  const fp_permission* permissions;
} fp_lane;

/* Since minor 2. A block is a named set of segments, as the plant's planner drew it. The warehouse does not enforce it:
 * keeping it is the agents' task. */
typedef enum fp_block_kind {
  FP_ONE_VEHICLE = 0,   /* at most one vehicle inside */
  FP_SAME_DIRECTION = 1 /* several vehicles, if they drive in one direction */
} fp_block_kind;

typedef struct fp_block {
  const char* name;
  uint32_t kind; /* fp_block_kind */
} fp_block;

typedef struct fp_map {
  uint32_t struct_size;
  uint32_t station_count, lane_count, segment_count;
  uint32_t station_stride, lane_stride, arc_stride; /* in bytes */
  const fp_station* stations;                       /* by station id */
  const fp_lane* lanes;
  /* Since minor 2. */
  uint32_t block_count, block_stride;
  const fp_block* blocks;
} fp_map;

#ifdef __cplusplus
#define FP_CAST(type, value) reinterpret_cast<type>(value)
#else
#define FP_CAST(type, value) ((type)(value))
#endif

/* Read the arrays of the map with these functions: a newer host's structs are larger than this header knows them. */
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

#ifdef __cplusplus
}
#endif

#endif
