/* my-agent: a server that gives each open order to one vehicle, and the vehicle that carries it out, in C. Nobody asks
 * before it drives. One shared object serves both. */
#include <stdlib.h>
#include <string.h>

#include <fleetproof/agent.h>

enum { kTick = 0 };
static const int64_t kTick_ns = 1000000000;

/* The messages. They are told from each other by their sizes. */
typedef struct trip { /* server to vehicle: carry this */
  uint32_t order, from, to;
} trip;
typedef struct done { /* vehicle to server: this load was put down */
  uint32_t order;
} done;

typedef struct given { /* an open order, and who carries it out: FP_NONE: nobody yet */
  trip what;
  uint32_t vehicle;
} given;

typedef struct agent {
  const fp_host* host;
  fp_controller* controller;
  const fp_briefing* briefing;
  /* of the server */
  given* orders; /* oldest first */
  uint32_t order_count;
  /* of a vehicle */
  uint32_t station, goal; /* where it stands, and to where it drives */
  trip work;              /* order FP_NONE: it has nothing to do */
  uint32_t delivered;     /* the last one */
  int is_dropping;
  uint32_t *next, *reached; /* of a search: by station, and in the order found */
} agent;

static const fp_lane* lane_at(const agent* self, uint32_t i) { return fp_lane_at(self->briefing->map, i); }

/* ---- the vehicle */

/* The first lane of the way with the fewest lanes, which is searched from its end; null: there is no way. */
static const fp_lane* first_lane_to(agent* self, uint32_t target) {
  uint32_t count = 1;
  for (uint32_t i = 0; i < self->briefing->map->station_count; ++i) self->next[i] = FP_NONE;
  self->reached[0] = target;
  for (uint32_t k = 0; k < count; ++k) {
    for (uint32_t i = 0; i < self->briefing->map->lane_count; ++i) {
      const fp_lane* lane = lane_at(self, i);
      if (lane->to != self->reached[k] || lane->from == target || self->next[lane->from] != FP_NONE) continue;
      self->next[lane->from] = i;
      self->reached[count++] = lane->from;
    }
  }
  return self->next[self->station] == FP_NONE ? NULL : lane_at(self, self->next[self->station]);
}

static void say_done(const agent* self) {
  const done said = {self->delivered};
  self->host->describe(self->controller, "DONE");
  self->host->send_unicast(self->controller, &said, sizeof said, self->briefing->fleet_count);
}

/* The next step of its work, if the AGV is idle. */
static void go_on(agent* self) {
  const fp_host* host = self->host;
  uint32_t action = FP_DRIVING, load = FP_NONE;
  if (self->work.order == FP_NONE || host->get_action(self->controller, &action) != FP_OK || action != FP_IDLE) return;
  host->get_load(self->controller, &load);
  const uint32_t target = load == self->work.order ? self->work.to : self->work.from;
  if (self->station != target) {
    const fp_lane* lane = first_lane_to(self, target);
    const uint32_t drive = lane == NULL ? FP_NONE : lane->segment | (lane->backward ? FP_BACKWARD : 0);
    if (lane != NULL && host->move(self->controller, drive) == FP_OK) self->goal = lane->to;
  } else if (load != self->work.order) {
    const int32_t result = host->pick_load(self->controller, FP_HERE, self->work.order);
    if (result != FP_OK) self->work.order = FP_NONE; /* the load is not there: a late message */
  } else {
    self->is_dropping = host->drop(self->controller, FP_HERE) == FP_OK;
  }
}

static void drive(agent* self, const fp_event* event) {
  fp_message message = {sizeof message, 0, 0, NULL};
  if (event->kind == FP_EVENT_ACTION_DONE && event->result == FP_OK) self->station = self->goal;
  if (event->kind == FP_EVENT_ACTION_DONE && self->is_dropping) {
    self->is_dropping = 0;
    if (event->result == FP_OK) {
      self->delivered = self->work.order;
      self->work.order = FP_NONE;
      say_done(self);
    }
  }
  while (self->host->get_message(self->controller, &message) == FP_OK) {
    trip heard;
    if (message.size != sizeof heard) continue;
    memcpy(&heard, message.bytes, sizeof heard);
    if (heard.order == self->delivered) {
      say_done(self); /* the server has not heard it */
    } else if (self->work.order == FP_NONE) {
      self->work = heard;
    }
  }
  go_on(self);
}

/* ---- the server */

static void forget(agent* self, uint32_t order) {
  for (uint32_t i = 0; i < self->order_count; ++i) {
    if (self->orders[i].what.order != order) continue;
    memmove(self->orders + i, self->orders + i + 1, (self->order_count - i - 1) * sizeof *self->orders);
    --self->order_count;
    return;
  }
}

static void add_order(agent* self, const fp_event* event) {
  given* larger = realloc(self->orders, (self->order_count + 1) * sizeof *larger);
  if (larger == NULL) abort();
  self->orders = larger;
  larger[self->order_count++] = (given){{event->order_id, event->from, event->to}, FP_NONE};
}

static uint32_t free_vehicle(const agent* self) {
  for (uint32_t vehicle = 0; vehicle < self->briefing->fleet_count; ++vehicle) {
    int is_free = 1;
    for (uint32_t i = 0; i < self->order_count; ++i) is_free = is_free && self->orders[i].vehicle != vehicle;
    if (is_free) return vehicle;
  }
  return FP_NONE;
}

/* Each trip is said again and again: messages are lost. */
static void give_orders(agent* self) {
  for (uint32_t i = 0; i < self->order_count; ++i) {
    given* order = &self->orders[i];
    if (order->vehicle == FP_NONE) {
      order->vehicle = free_vehicle(self);
      if (order->vehicle != FP_NONE) self->host->works_on(self->controller, order->vehicle, order->what.order);
    }
    if (order->vehicle == FP_NONE) return; /* no vehicle is free */
    self->host->describe(self->controller, "TRIP");
    self->host->send_unicast(self->controller, &order->what, sizeof order->what, order->vehicle);
  }
}

static void plan(agent* self, const fp_event* event) {
  fp_message message = {sizeof message, 0, 0, NULL};
  if (event->kind == FP_EVENT_ORDER) add_order(self, event);
  if (event->kind == FP_EVENT_WITHDRAWN) forget(self, event->order_id);
  while (self->host->get_message(self->controller, &message) == FP_OK) {
    done heard;
    if (message.size != sizeof heard) continue;
    memcpy(&heard, message.bytes, sizeof heard);
    forget(self, heard.order);
  }
  if (event->kind == FP_EVENT_TIMER) give_orders(self);
  if (event->kind != FP_EVENT_START && event->kind != FP_EVENT_TIMER) return;
  self->host->set_timer(self->controller, kTick, event->now_ns + kTick_ns);
}

/* ---- both */

static void on_event(void* own, const fp_event* event) {
  agent* self = own;
  if (self->briefing->role == FP_COMPUTER) {
    plan(self, event);
  } else {
    drive(self, event);
  }
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
  self->controller = controller;
  self->briefing = briefing;
  self->work.order = self->delivered = FP_NONE;
  self->next = malloc(briefing->map->station_count * sizeof *self->next);
  self->reached = malloc(briefing->map->station_count * sizeof *self->reached);
  if (self->next == NULL || self->reached == NULL) {
    destroy(self);
    return NULL;
  }
  self->station = self->goal = briefing->start_station;
  if (briefing->role == FP_COMPUTER || briefing->start_segment == FP_NONE) return self;
  for (uint32_t i = 0; i < briefing->map->lane_count; ++i) { /* the former boot may have driven on, to the end of it */
    const int is_it = lane_at(self, i)->segment == (briefing->start_segment & ~FP_BACKWARD);
    if (is_it && lane_at(self, i)->from == self->station) self->station = self->goal = lane_at(self, i)->to;
  }
  return self;
}

__attribute__((visibility("default"))) const fp_agent_type* fp_agent_query(uint32_t host_abi_major) {
  static const fp_agent_type type = {sizeof(fp_agent_type),
                                     FP_ABI_MAJOR,
                                     FP_ABI_MINOR,
                                     FP_DETERMINISTIC | FP_SERVES_COMPUTERS,
                                     "my-agent",
                                     "a server gives each order to one vehicle",
                                     create,
                                     on_event,
                                     destroy,
                                     NULL,
                                     NULL};
  return host_abi_major == FP_ABI_MAJOR ? &type : NULL;
}
