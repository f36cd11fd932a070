/* fleetproof/agent.h: the contract between a simulated warehouse and the control software of its AGVs.
 *
 * The contract is plain C, so that any language can implement it. An agent is a table of functions (fp_agent_type). The
 * engine creates one agent for each AGV and gives it a briefing about the world (fp_briefing). Then it calls the agent
 * for every event of the AGV (fp_event). The agent acts through the AGV controller (fp_host). The controller offers the
 * actions and perceptions of a real AGV controller, and services that stand for the agent's computer.
 *
 * Time. An activation starts at an instant t and sees the AGV, the inbox and the clock as of t. Its k-th controller
 * call takes effect at t plus the costs so far (the scenario's cost for each call, plus what the agent declares). If an
 * event arrives while the agent is busy, the agent receives it when it is free. now_ns, events and timers show the
 * AGV's own clock, which may be off and drift. It is never negative.
 *
 * Limits. In one activation an agent may make 10 000 controller calls, and ten million more of random and now_ns. Every
 * call counts, whatever it returns, and those in create() count with FP_EVENT_START. An agent that makes more is filed
 * as a hang. So is one that is called more than 10 000 times without time advancing, or in all 2 000 000 times plus
 * 10 000 for each second of the run. It is then suspended to the end of the run:
 * its calls return FP_SUSPENDED, it receives no event, and a restart does not bring it back. Its AGV completes the
 * actions that it has accepted.
 *
 * Rules for the agent. Keep all state in the instance that create() returned. Many instances live in one process, on
 * several threads, but no instance is called from two threads at once. Use no clock, random source or thread of your
 * own: a run can only be replayed if time and randomness come from now_ns and random. A controller call from another
 * thread, or after destroy(), is refused, and the agent is filed as crashed; one for another AGV is refused. Control
 * bits of the processor (rounding, exceptions, denormals) are set back after each call. If an agent in C++ throws, it
 * is filed as crashed; an agent in another language must let no exception leave its functions.
 *
 * Versions. A struct that one side fills for the other begins with its size in bytes. Structs in arrays (AGVs,
 * stations, lanes, arcs, blocks) may grow, too: read them by the stride of the array. Calls of a script and permissions
 * never grow. A host refuses an agent with another FP_ABI_MAJOR. A higher minor adds members at the end: an agent may
 * use those "since minor n" if the host's abi_minor is n or more. An agent ignores kinds of events that it does not
 * know.
 *
 * Units: metres, metres per second, nanoseconds (64-bit, since the start of the run), radians. Headings are unit
 * vectors in the world frame. Numbers of AGVs, stations, lanes and segments are the same for every agent of a run.
 *
 * Motion. Positions are those of the reference point. Before a drive whose lane begins with another heading, the AGV
 * turns on the spot, about its reference point, by the shorter way; half a turn may go either way. A difference of less
 * than 1e-7 rad is no turn. The footprint has its size with a load from the end of a pick to the end of a drop; the
 * load extends it by equal parts at both ends and both sides, so that centre_ahead_m stays. map.h says what arcs
 * promise. In drawn worlds, bodies without loads start at least safety_distance_m apart, to 1 um.
 */
#ifndef FLEETPROOF_AGENT_H
#define FLEETPROOF_AGENT_H

#include <stdint.h>

#include "facts.h"
#include "map.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FP_ABI_MAJOR 1u
#define FP_ABI_MINOR 7u

#define FP_NONE 0xffffffffu /* no station, no segment, no AGV, no computer, no order */
#define FP_HERE FP_NONE     /* as the segment of pick, drop, park and charge: where the AGV stands, without driving */
#define FP_MESSAGE_BYTES_MAX 1024u
#define FP_DISK_BYTES 1048576u /* since minor 5: what the disk of a participant holds */
#define FP_RECORD_OVERHEAD 16u /* so many bytes does each record on it take beside its own */

/* What a controller call returns. */
typedef enum fp_result {
  FP_OK = 0,
  FP_EMPTY = 1,     /* get_message: no more messages; recall: no such record */
  FP_REFUSED = -1,  /* the AGV is busy, out of order after a contact, or not at an end of that segment; the segment is
                       one-way, or not for this AGV; or the AGV would have to turn where it must not, or to stay with a
                       wrong heading */
  FP_INVALID = -2,  /* a wrong argument: no such segment, station, receiver, order or AGV, a null pointer, a struct that
                       is too small, a cost that is not from 0 to 3 600 s, or a message that is too long; or a call
                       that only an AGV has, from a computer */
  FP_SUSPENDED = -3 /* the agent is suspended (more calls than its limit), or not in an activation: return at once */
} fp_result;

/* What the AGV is doing. FP_STOPPED: something stopped the AGV, in the middle of an action or while it was idle; the
 * AGV will go on without a further call, unless `stop` holds it. While it still brakes, it is driving. FP_CHARGING_NOW:
 * also while the AGV docks at the charger. FP_OUT_OF_ORDER: the AGV is broken down or empty. It may be repaired and
 * then goes on, too; until then it accepts actions and begins none. Or a contact has put it out of order. In all three
 * cases the computer works on: the agent receives events, and the AGV sends and receives messages. */
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

/* ---- the briefing ---------------------------------------------------------------------------------------- */

/* A controller call at a fixed time, for the `scripted` agent. */
typedef struct fp_scripted_call {
  int64_t at_ns;
  uint32_t action;  /* fp_call */
  uint32_t segment; /* with FP_BACKWARD, if so */
} fp_scripted_call;

typedef enum fp_call { FP_CALL_MOVE = 0, FP_CALL_PICK, FP_CALL_DROP, FP_CALL_PARK, FP_CALL_CHARGE } fp_call;

/* Since minor 5. The participants of a run: its AGVs, 0 .. fleet_count-1, and behind them its computers, which have no
 * body: servers, brokers and the like. The program of a computer has inbox, clock, timers, randomness and restarts as
 * an agent of an AGV has them. It sends to AGVs by radio and to other computers by wire, which loses nothing. Actions,
 * perceptions of an AGV, `safe_mode` and `waiting_for` return FP_INVALID there. */
typedef enum fp_role { FP_AGV = 0, FP_COMPUTER } fp_role;

typedef struct fp_computer {
  const char* name;
  uint32_t has_antenna; /* 0: it is in range of every AGV */
  double x_m, y_m;      /* of its antenna */
} fp_computer;

/* Since minor 5. Whose the transports of a run are. Assigned: each is released to one AGV. Open: each is released to
 * every computer, and without computers to every AGV; the AGV that picks the load carries it out. An open run may have
 * assigned transports, too. */
typedef enum fp_orders { FP_ORDERS_ASSIGNED = 0, FP_ORDERS_OPEN } fp_orders;

/* All pointers stay valid and unchanged for the life of the agent. */
typedef struct fp_briefing {
  uint32_t struct_size;
  uint32_t self; /* own id: of an AGV 0 .. fleet_count-1, of a computer from fleet_count on */
  uint32_t fleet_count;
  uint32_t agv_stride;
  const fp_agv* fleet;
  const fp_map* map;
  uint32_t start_station;
  uint32_t script_count;
  const fp_scripted_call* script;
  double safety_distance_m;
  double radio_range_m;
  const char* config; /* the agent's own parameters, as text; never null */
  /* Since minor 1. `boot` says how often this AGV's computer has restarted in this run. The computer keeps only this
   * number. After a restart, start_station is the station at which the AGV stands, or which it left last. start_segment
   * is the segment of the action under way until the AGV has reached its end, also while it turns towards it, or
   * FP_NONE. next_segment is the segment that the AGV will drive next, because of a call before the restart, or
   * FP_NONE; both with FP_BACKWARD, if the AGV drives backward. All this is as of the instant at which the agent gets
   * FP_EVENT_START; a freeze may delay that. The heading is what get_position perceives: late, so perhaps that from
   * before a turn. For the actions under way then, FP_EVENT_ACTION_DONE still follows. */
  uint32_t boot;
  uint32_t start_segment;
  uint32_t next_segment;
  const fp_facts* facts; /* since minor 3 */
  /* Since minor 5. A computer has no start_station, no script and no segments. */
  uint32_t role;            /* fp_role */
  uint32_t computer_count;  /* their ids are fleet_count .. fleet_count+computer_count-1 */
  uint32_t computer_stride; /* read `computers` by it, as the other arrays */
  uint32_t vehicle_type_count;
  const fp_computer* computers;
  const char* const* agv_names;          /* fleet_count of them; names are for people */
  const char* const* vehicle_type_names; /* by vehicle_type of fp_agv */
  const char* const* segment_names;      /* by number of the segment */
  uint32_t orders;                       /* fp_orders */
  /* Since minor 6. 64 bits of this run, the same for all participants and in every boot: software with random numbers
   * of its own begins them with it. */
  uint64_t seed;
} fp_briefing;

/* ---- events ---------------------------------------------------------------------------------------------- */

typedef enum fp_event_kind {
  FP_EVENT_START = 0, /* the run begins, or the agent begins again after a restart */
  FP_EVENT_ORDER,     /* a transport was released for this AGV, or an open one (fp_orders): order_id, from, to. After a
                         restart, sent again for each transport that is not done: first that of the load on board, then
                         the oldest first; `from` is the station where the load waits now, if one does. Of open ones
                         all are sent again that were released and are neither delivered nor withdrawn, also those that
                         an AGV carries. If there are computers, they alone are told of open transports */
  FP_EVENT_MESSAGE,   /* the inbox is not empty; read it until FP_EMPTY. Messages are lost, late, doubled and reordered;
                         those that were not read before a restart are lost */
  FP_EVENT_TIMER,     /* a timer went off: timer */
  FP_EVENT_ACTION_DONE,
  /* an action ended, the one that was accepted first: result FP_OK, or FP_REFUSED if a contact put the AGV out of
     order. FP_REFUSED is final: the action never goes on, and the AGV accepts none until the operator has set it down
     and the agent has restarted */
  FP_EVENT_FAULT = 5,
  /* since minor 5: a fault begins that the scenario names by a word, and that the program knows (`knows_fault`):
     fault_word, fault_number, fault_length_ns. What it means, the program alone knows */
  FP_EVENT_WITHDRAWN = 6
  /* since minor 5: order_id was withdrawn. Sent to those who were told of the transport, unless its load has been
     delivered. If no AGV has ever picked the load, the transport is over: the load is gone, pick_load is refused, and
     the order is not sent again. Otherwise it has to be delivered all the same */
} fp_event_kind;

typedef struct fp_event {
  uint32_t struct_size;
  uint32_t kind; /* fp_event_kind */
  int64_t now_ns;
  uint32_t timer;
  int32_t result;
  uint32_t order_id, from, to;
  /* Since minor 5. Of FP_EVENT_FAULT; else null and 0. */
  const char* fault_word;  /* valid until the end of the run */
  int64_t fault_length_ns; /* it lasts so long from the instant at which it strikes; no event says that it is over */
  uint32_t fault_number;
} fp_event;

typedef struct fp_message {
  uint32_t struct_size;
  uint32_t sender;
  uint32_t size;
  const void* bytes; /* valid until the next get_message or the end of the activation */
} fp_message;

/* Since minor 5. What a vehicle covers of the floor, for `conflict`: it stands at a station; or it turns at the
 * beginning of a lane, by the shorter way, and drives the lane from end to end. */
typedef struct fp_occupancy {
  uint32_t struct_size;
  uint32_t vehicle_type;       /* as fp_agv has it; below vehicle_type_count */
  uint32_t load;               /* fp_load_state; FP_ANY_LOAD: the larger of both sizes */
  uint32_t lane;               /* its place in map->lanes; FP_NONE: it stands */
  uint32_t station;            /* where it stands; of no meaning with a lane */
  double heading_x, heading_y; /* with which it stands, or from which it turns into the lane; (0, 0): any */
} fp_occupancy;

/* Since minor 5. What `recall` finds. */
typedef struct fp_record {
  uint32_t struct_size;
  uint32_t size;
  const void* bytes; /* valid until the next `keep` or the end of the activation */
} fp_record;

/* Since minor 7. What `describe_message` says of a message. Any text but the kind may be null. Requests are named by
   texts of the agent's own, the same in the message that asks and in its answers: "3.0". An answer to several has
   commas between them. */
typedef struct fp_message_fields {
  uint32_t struct_size;
  const char* kind;    /* "GRANT" */
  const char* content; /* what it says, for readers; null: its other fields */
  const char* asks;    /* the request that it makes or repeats */
  const char* answers; /* the requests that it answers */
  const char* about;   /* what it is about: a way, a station, an order, as in "C12 to C14" */
} fp_message_fields;

/* Since minor 6. What `perceive` finds, as of the beginning of the activation. Of a computer, all that only an AGV has
 * is 0, and order_id is FP_NONE. */
typedef struct fp_perceived {
  uint32_t struct_size;
  uint32_t action;   /* as get_action */
  uint32_t order_id; /* as get_load */
  uint32_t message_count;
  const fp_message* messages; /* that are not read yet, oldest first; valid until the next call of the controller */
  uint32_t message_stride;    /* in bytes */
  double battery_level;       /* as get_battery_level */
  fp_pose pose;               /* as get_position */
  int64_t now_ns;
} fp_perceived;

/* ---- the AGV controller ---------------------------------------------------------------------------------- */

typedef struct fp_controller fp_controller;

typedef struct fp_host {
  uint32_t struct_size;
  uint32_t abi_major, abi_minor;

  /* Actions. The AGV must be at a station with no action under way. It turns towards the segment and drives it to the
   * other end. Then pick and drop transfer a load there; park and charge stay. One FP_EVENT_ACTION_DONE follows for
   * every accepted action. While a move is under way, one more action may be given. Its segment must leave the station
   * where the move ends, and it begins when the move ends. If it is given before the AGV brakes, and if the segment
   * goes straight on, the AGV rolls through the station without a stop.
   * `pick` takes the load of the oldest order of this AGV that waits at the station, or else that of the oldest open
   * one. If none waits or the AGV is loaded, it takes none, and ends with FP_OK all the same: so does a pick whose load
   * another AGV takes first, or is withdrawn before the pick ends. The AGV that picks the load of an open transport
   * owns the transport until the load leaves it; if it is put down elsewhere than at its destination, the transport is
   * open again. */
  int32_t (*move)(fp_controller*, uint32_t segment);
  int32_t (*pick)(fp_controller*, uint32_t segment);
  int32_t (*drop)(fp_controller*, uint32_t segment);
  int32_t (*park)(fp_controller*, uint32_t segment);
  int32_t (*charge)(fp_controller*,
                    uint32_t segment); /* done when connected; charging goes on until full or until the next action */
  int32_t (*send_broadcast)(fp_controller*, const void* bytes, uint32_t size);
  int32_t (*send_unicast)(fp_controller*, const void* bytes, uint32_t size, uint32_t receiver);

  /* Perceptions. */
  int32_t (*get_position)(fp_controller*, fp_pose* out);     /* perceived: it may be late, and wrong; a
                                                                bound is not told, so put it into your config */
  int32_t (*get_battery_level)(fp_controller*, double* out); /* 0 .. 1 */
  int32_t (*get_message)(fp_controller*, fp_message* out);   /* set out->struct_size first */
  int32_t (*is_loaded)(fp_controller*, uint32_t* out);       /* 0 or 1 */
  int32_t (*get_action)(fp_controller*, uint32_t* out);      /* fp_action */

  /* Services that stand for the agent's computer. */
  int64_t (*now_ns)(fp_controller*);
  int32_t (*set_timer)(
      fp_controller*, uint32_t timer,
      int64_t at_ns); /* one instant per timer number; setting it again replaces it, at_ns < 0 clears it */
  uint64_t (*random)(
      fp_controller*, uint32_t purpose,
      uint64_t index); /* 64 uniform bits: a pure function of run, AGV, purpose and index, in every boot */
  int32_t (*declare_cost_ns)(fp_controller*,
                             int64_t cost_ns); /* thinking time: later calls of this activation act that much later */
  int32_t (*safe_mode)(fp_controller*, uint32_t on);    /* declared: the AGV stands still because of the radio */
  int32_t (*waiting_for)(fp_controller*, uint32_t agv); /* declared: the AGV for which it waits; FP_NONE: none */
  /* A probe: "this was reached". The trace records it, and the outcome counts it by name. Reports list how many runs
     reached each probe. A campaign can name probes without which its evidence is weak. The reference agents use
     "negotiation", "deferred", "grant-lost", "retransmission" and others. A run keeps 64 names of at most 64 bytes and
     counts further probes without their names. */
  int32_t (*sometimes)(fp_controller*, const char* probe);
  int32_t (*log)(fp_controller*, const char* text);

  /* Since minor 2. As `pick`, but takes the load of this order. FP_REFUSED also if that load does not wait at the
     station or if the AGV is loaded. FP_INVALID if no such order was released for this AGV, nor an open one. */
  int32_t (*pick_load)(fp_controller*, uint32_t segment, uint32_t order_id);
  int32_t (*get_load)(fp_controller*, uint32_t* order_id); /* the order of the load on board; FP_NONE: no load */

  /* Since minor 2. `stop` brakes the drive or the turn under way with the vehicle's own deceleration and holds the AGV;
     `go_on` lets it go on. The action stays under way, so no event follows. An AGV that is held accepts actions as
     always. It carries out what needs no motion (transfers, docking, charging); it turns and drives after `go_on`. A
     restart does not let it go on. Breakdowns and protective stops are independent: it moves when nothing holds it. If
     there is nothing to change, the calls return FP_OK and do nothing. */
  int32_t (*stop)(fp_controller*);
  int32_t (*go_on)(fp_controller*);

  /* Since minor 2. Notes for people who look at a trace. A note changes nothing (but see `describe`) and takes no
     simulated time; if nobody traces, it is ignored. Notes do not count as calls and return nothing. A trace keeps the
     first 1 000 notes of an activation, and 64 bytes of each text. */
  /* The next message of this activation: its kind, e.g. "GRANT". What follows ": " is its content, for readers, and no
     part of the kind: "GRANT: answers 7". A scenario may name kinds that its radio neither loses nor delays. */
  void (*describe)(fp_controller*, const char* kind);
  void (*declare_state)(fp_controller*, const char* state); /* what the agent does, in its own word, e.g. "waiting" */
  /* Where another AGV was at `as_of_ns`, as far as the agent knows. Heading (0, 0): not known. */
  void (*believe)(fp_controller*, uint32_t agv, const fp_pose* where, int64_t as_of_ns);

  /* Since minor 4. In `create`, before it returns null: why the agent cannot start, in words for people, as in "no
     licence for 12 AGVs". The crash is filed with the text, of which at least 150 characters are kept. The last call
     counts. FP_REFUSED after `create`. */
  int32_t (*cannot_start)(fp_controller*, const char* why);

  /* Since minor 5. The disk of the participant, an AGV or a computer. It outlives restarts and power failures; only a
     disk loss empties it. `keep` puts a record there in place of the one with this number; size 0 deletes it.
     FP_REFUSED, and nothing changes, if the sizes of all records and FP_RECORD_OVERHEAD for each of them would be more
     than FP_DISK_BYTES; or if four times FP_DISK_BYTES would still have to take effect. As every call, it takes effect
     after the costs so far: a record of which a restart comes earlier is not on the disk, and the one before it still
     is. `recall` finds what the agent has kept, also if that is still to take effect; FP_EMPTY: no such record. Set
     out->struct_size first. */
  int32_t (*keep)(fp_controller*, uint32_t record, const void* bytes, uint32_t size);
  int32_t (*recall)(fp_controller*, uint32_t record, fp_record* out);

  /* Since minor 5. Whether two vehicles may come closer to each other than the safety distance plus `margin_m` (0 to
     100 m), wherever each is within what it covers: *out is 1 or 0. 0 is certain, but for the 1 um that the law
     forgives. 1 may be wrong where a vehicle turns or drives a bend, by up to 2 mm of distance; it is right where both
     stand or drive straight on. The answer follows from map and vehicle types alone. It is no call: it takes no
     simulated time, counts nowhere, and is FP_SUSPENDED outside an activation. Set struct_size of both first. */
  int32_t (*conflict)(fp_controller*, const fp_occupancy* a, const fp_occupancy* b, double margin_m, uint32_t* out);

  /* Since minor 5. Declarations about an AGV: by its own agent, or by the program of a computer for any AGV. A
     declaration moves nothing. It holds until the next one about this AGV, or until what made it restarts. FP_INVALID
     about another AGV.
     `works_on`: the AGV works on this order from now on; FP_NONE: on none. FP_INVALID if the order was not released, or
     is that of another AGV. Until an AGV picks the load of an open transport, results know from this call alone whose
     work it is: an AGV that stands or drives in vain is accused only if it has declared work, a load, or orders of its
     own; else the fleet is accused if it stands still as a whole.
     `declare_waiting`: as `waiting_for`. */
  int32_t (*works_on)(fp_controller*, uint32_t agv, uint32_t order_id);
  int32_t (*declare_waiting)(fp_controller*, uint32_t agv, uint32_t for_agv);

  /* Since minor 6. For bridges to software elsewhere, and for wrappers. Neither is a call: it takes no simulated time
     and counts nowhere, and outside an activation it is FP_SUSPENDED. `fail`: the agent has failed. It is filed as
     crashed, or as hung if `hang` is not 0, with this text for people, of which at least 150 characters are kept. Its
     further calls return FP_SUSPENDED, it receives no event, and a restart does not bring it back. In `create`, too,
     whatever that returns. The first call counts. `perceive`: everything that an agent nearly always asks for, read
     ahead of it and left where it is: messages stay unread. A bridge makes the calls for which it has answered in that
     way when its software has asked, so that software behind a bridge pays what it would pay without. Set
     out->struct_size first. */
  int32_t (*fail)(fp_controller*, uint32_t hang, const char* text);
  int32_t (*perceive)(fp_controller*, fp_perceived* out);

  /* Since minor 7. A note, as `describe`: the next message of this activation, with what programs that look for causes
     want to know of it. Both give one kind. A trace keeps 200 bytes of all fields of a message. */
  void (*describe_message)(fp_controller*, const fp_message_fields* fields);
} fp_host;

/* ---- the agent ------------------------------------------------------------------------------------------- */

/* The agent promises: same briefing and events, same calls. If a replay differs from the run, it says whether the agent
 * has promised this. */
#define FP_DETERMINISTIC 1u
/* Since minor 5. The agent may be the program of a computer: it looks at `role`. Others serve AGVs only. */
#define FP_SERVES_COMPUTERS 2u

/* Since minor 6. For types that are made while the program runs, one for each program behind a bridge: a type with data
 * of its own. Functions that are null are not called. */
typedef struct fp_bridge {
  uint32_t struct_size;
  void* own; /* given to each of these functions */
  /* In the place of the type's `create`, which may then be null. */
  void* (*create_in)(void* own, const fp_host* host, fp_controller* controller, const fp_briefing* briefing);
  /* A run is over, after `destroy` of its last agent, also if the run was broken off. A run stays on one thread, which
     makes this call, too. A restart is no end of a run. No controller call may be made. */
  void (*run_ends)(void* own);
  /* In the place of the type's `knows_fault`. */
  uint32_t (*knows_fault_in)(void* own, const char* word);
} fp_bridge;

typedef struct fp_agent_type {
  uint32_t struct_size;
  uint32_t abi_major, abi_minor;
  uint32_t flags;
  const char* name;
  const char* description;
  /* host and briefing outlive the agent. Null means that the agent cannot start: the run counts as a crash. Say why
     with `cannot_start`. */
  void* (*create)(const fp_host* host, fp_controller* controller, const fp_briefing* briefing);
  void (*on_event)(void* agent, const fp_event* event);
  void (*destroy)(void* agent);
  /* Since minor 5. Whether agents of this type take FP_EVENT_FAULT with this word; null: with none. A fault whose word
     is not known does not strike. Make no controller call in here, and answer one word always alike. */
  uint32_t (*knows_fault)(const char* word);
  const fp_bridge* bridge; /* since minor 6; null: the type has no data of its own */
} fp_agent_type;

/* A shared object exports this one symbol. It returns null if it does not support the host's major version. */
typedef const fp_agent_type* (*fp_agent_query_function)(uint32_t host_abi_major);
#define FP_AGENT_QUERY_SYMBOL "fp_agent_query"

#ifdef __cplusplus
}
#endif

#endif
