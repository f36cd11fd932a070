/* my-agent: the software on board of an AGV, in C. It carries out its transports, and asks nobody before it drives. */
#include <stdlib.h>
#include <string.h>

#include <fleetproof/agent.h>

typedef struct order {
  uint32_t id, from, to;
} order;

typedef struct agent {
  const fp_host* host;
  fp_controller* agv;
  const fp_map* map;
  uint32_t station, goal; /* where it stands, and to where it drives */
  order* orders;          /* oldest first */
  uint32_t order_count;
  uint32_t *next, *reached; /* of a search: by station, and in the order found */
} agent;

static uint32_t drive_of(const fp_lane* lane) { return lane->segment | (lane->backward ? FP_BACKWARD : 0); }

/* The first lane of the way with the fewest lanes, which is searched from its end; null: there is no way. */
static const fp_lane* first_lane_to(agent* self, uint32_t target) {
  uint32_t count = 1;
  for (uint32_t i = 0; i < self->map->station_count; ++i) self->next[i] = FP_NONE;
  self->reached[0] = target;
  for (uint32_t k = 0; k < count; ++k) {
    for (uint32_t i = 0; i < self->map->lane_count; ++i) {
      const fp_lane* lane = fp_lane_at(self->map, i);
      if (lane->to != self->reached[k] || lane->from == target || self->next[lane->from] != FP_NONE) continue;
      self->next[lane->from] = i;
      self->reached[count++] = lane->from;
    }
  }
  return self->next[self->station] == FP_NONE ? NULL : fp_lane_at(self->map, self->next[self->station]);
}

/* The next step of the oldest order, if the AGV is idle. */
static void go_on(agent* self) {
  const fp_host* host = self->host;
  uint32_t action = FP_DRIVING, load = FP_NONE;
  if (self->order_count == 0 || host->get_action(self->agv, &action) != FP_OK || action != FP_IDLE) return;
  host->get_load(self->agv, &load);
  const order first = self->orders[0];
  const uint32_t target = load == first.id ? first.to : first.from;
  if (self->station != target) {
    const fp_lane* lane = first_lane_to(self, target);
    if (lane != NULL && host->move(self->agv, drive_of(lane)) == FP_OK) self->goal = lane->to;
  } else if (load != first.id) {
    host->pick_load(self->agv, FP_HERE, first.id);
  } else if (host->drop(self->agv, FP_HERE) == FP_OK) {
    memmove(self->orders, self->orders + 1, --self->order_count * sizeof first);
  }
}

static void add_order(agent* self, const fp_event* event) {
  order* larger = realloc(self->orders, (self->order_count + 1) * sizeof *larger);
  if (larger == NULL) abort();
  self->orders = larger;
  larger[self->order_count++] = (order){event->order_id, event->from, event->to};
}

static void on_event(void* own, const fp_event* event) {
  agent* self = own;
  if (event->kind == FP_EVENT_ORDER) add_order(self, event);
  if (event->kind == FP_EVENT_ACTION_DONE && event->result == FP_OK) self->station = self->goal;
  go_on(self);
}

static void destroy(void* own) {
  agent* self = own;
  free(self->orders);
  free(self->next);
  free(self->reached);
  free(self);
}

static void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  agent* self = calloc(1, sizeof *self);
  if (self == NULL) return NULL;
  self->host = host;
  self->agv = controller;
  self->map = briefing->map;
  self->next = malloc(briefing->map->station_count * sizeof *self->next);
  self->reached = malloc(briefing->map->station_count * sizeof *self->reached);
  if (self->next == NULL || self->reached == NULL) {
    destroy(self);
    return NULL;
  }
  self->station = self->goal = briefing->start_station;
  if (briefing->start_segment == FP_NONE) return self;
  for (uint32_t i = 0; i < briefing->map->lane_count; ++i) { /* the former boot may have driven on, to the end of it */
    const fp_lane* lane = fp_lane_at(briefing->map, i);
    const int is_it = lane->segment == (briefing->start_segment & ~FP_BACKWARD);
    if (is_it && lane->from == briefing->start_station) self->station = self->goal = lane->to;
  }
  return self;
}

__attribute__((visibility("default"))) const fp_agent_type* fp_agent_query(uint32_t host_abi_major) {
  static const fp_agent_type type = {sizeof(fp_agent_type),
                                     FP_ABI_MAJOR,
                                     FP_ABI_MINOR,
                                     FP_DETERMINISTIC,
                                     "my-agent",
                                     "carries out its transports and asks nobody",
                                     create,
                                     on_event,
                                     destroy,
                                     NULL,
                                     NULL};
  return host_abi_major == FP_ABI_MAJOR ? &type : NULL;
}
