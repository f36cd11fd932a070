/* fleetproof/facts.h: the fleet, and what follows from map and fleet alone. Units and versions are those of agent.h,
 * which includes this file.
 */
#ifndef FLEETPROOF_FACTS_H
#define FLEETPROOF_FACTS_H

#include <stdint.h>

#include "map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An AGV of the fleet; the fleet contains the agent's own AGV. The length of the footprint is along the heading. The
 * reference point follows the lanes, and the AGV turns about it. Before minor 2 it was the centre of the footprint. */
typedef struct fp_agv {
  double length_m, width_m;
  double speed_mps, acceleration_mps2, deceleration_mps2;
  double turn_speed_radps, turn_acceleration_radps2, turn_deceleration_radps2;
  /* Since minor 1: the size with a load, and the share by which a drive may be faster or slower. */
  double loaded_length_m, loaded_width_m;
  double speed_deviation;
  /* Since minor 2: the centre of the footprint, ahead of the reference point; the top speed of driving backward, which
   * may be lower or higher than speed_mps (0: as forward); and the number of its vehicle type, for permissions. */
  double centre_ahead_m;
  double reverse_speed_mps;
  uint32_t vehicle_type;
} fp_agv;

/* Read a fleet with this function, for the same reason as the arrays of the map; `stride`: agv_stride. */
static inline const fp_agv* fp_agv_at(const fp_agv* fleet, uint32_t stride, uint32_t agv) {
  const size_t index = agv;
  return FP_CAST(const fp_agv*, FP_CAST(const char*, fleet) + index * stride);
}

/* Since minor 3. What is the same for every AGV of a run and never changes in it. Agents work much out from that alone:
 * distances, conflicts between lanes, ways. With `ask`, they share the work: if nobody has asked this question with
 * this function before, the host calls `derive` and keeps the answer. The bytes that `ask` returns are the host's. They
 * are aligned for any type, and valid and unchanged for the life of the agent. What a question means is up to the
 * agent. Answers take no simulated time by themselves (see declare_cost_ns).
 * `derive` calls `answer` once. It must depend on nothing but facts and question, so it must not use the controller or
 * an agent. It may ask other questions; if a question leads back to itself, `ask` returns null. Bytes must not hold
 * addresses: the host may keep an answer for other runs with the same facts. It may also ask again for each AGV. */
typedef struct fp_facts fp_facts;
typedef struct fp_answer fp_answer; /* where the host keeps an answer */
typedef void (*fp_derive)(const fp_facts* facts, uint64_t question, fp_answer* to);

struct fp_facts {
  uint32_t struct_size;
  uint32_t fleet_count;
  uint32_t agv_stride;
  const fp_agv* fleet;
  const fp_map* map;
  double safety_distance_m;
  const void* (*ask)(const fp_facts*, fp_derive derive, uint64_t question, uint64_t* size);
  void (*answer)(fp_answer* to, const void* bytes, uint64_t size);
  void* host; /* the host's own */
};

#ifdef __cplusplus
}
#endif

#endif
