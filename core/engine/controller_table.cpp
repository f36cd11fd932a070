// The AGV controller as the agent sees it: the paper's interface (Sect. 2.2) in C, each call checked and passed on.
#include "core/engine/controller_table.hpp"

#include <cstring>
#include <string>

#include "core/engine/agv_controller.hpp"
#include "core/engine/declarations.hpp"
#include "core/engine/disks.hpp"
#include "core/engine/told_plant.hpp"

namespace fleetproof {
namespace {

template <class Call>
std::int32_t admitted(fp_controller* controller, Call call) {
  AgvController& part = *controller->part;
  if (!part.admit(*controller)) return FP_SUSPENDED;
  return call(part, controller->agv);
}

// The same for a call that only an AGV has.
template <class Call>
std::int32_t admitted_on_board(fp_controller* controller, Call call) {
  return admitted(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    return controller->is_computer ? std::int32_t{FP_INVALID} : call(part, agv);
  });
}

template <fp_call kCall>
std::int32_t action(fp_controller* controller, std::uint32_t segment) {
  return admitted_on_board(controller, [&](AgvController& part, AgvId agv) { return part.act(agv, kCall, segment); });
}

std::int32_t pick_load(fp_controller* controller, std::uint32_t segment, std::uint32_t order) {
  return admitted_on_board(controller,
                           [&](AgvController& part, AgvId agv) { return part.pick_load(agv, segment, order); });
}

template <bool kOn>
std::int32_t stop(fp_controller* controller) {
  return admitted_on_board(controller, [](AgvController& part, AgvId agv) { return part.stop(agv, kOn); });
}

// FP_NONE: to all.
std::int32_t send(fp_controller* controller, const void* bytes, std::uint32_t size, std::uint32_t receiver) {
  return admitted(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (bytes == nullptr && size > 0) return FP_INVALID;
    return part.send(agv, {static_cast<const char*>(bytes), size}, receiver);
  });
}

[[gnu::flatten]] std::int32_t send_broadcast(fp_controller* controller, const void* bytes, std::uint32_t size) {
  return send(controller, bytes, size, FP_NONE);
}

// An agent that takes "no AGV" for a receiver must not tell everybody.
std::int32_t send_unicast(fp_controller* controller, const void* bytes, std::uint32_t size, std::uint32_t receiver) {
  return send(controller, bytes, size, receiver == FP_NONE ? FP_NONE - 1 : receiver);
}

std::int32_t get_position(fp_controller* controller, fp_pose* out) {
  return admitted_on_board(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    const Pose pose = part.ports().sensor.perceived(agv);
    *out = {pose.position_m.x(), pose.position_m.y(), pose.heading.x(), pose.heading.y()};
    return FP_OK;
  });
}

std::int32_t get_battery_level(fp_controller* controller, double* out) {
  return admitted_on_board(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    *out = part.ports().battery.level(agv);
    return FP_OK;
  });
}

// An agent calls it at least twice for each message.
[[gnu::flatten]] std::int32_t get_message(fp_controller* controller, fp_message* out) {
  return admitted(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (out == nullptr || out->struct_size < sizeof(fp_message)) return FP_INVALID;
    return part.ports().messenger.read(agv, *out) ? FP_OK : FP_EMPTY;
  });
}

std::int32_t is_loaded(fp_controller* controller, std::uint32_t* out) {
  return admitted_on_board(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    *out = part.order_on_board(agv) != FP_NONE ? 1 : 0;
    return FP_OK;
  });
}

std::int32_t get_load(fp_controller* controller, std::uint32_t* order) {
  return admitted_on_board(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (order == nullptr) return FP_INVALID;
    *order = part.order_on_board(agv);
    return FP_OK;
  });
}

std::int32_t get_action(fp_controller* controller, std::uint32_t* out) {
  return admitted_on_board(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    *out = part.ports().actions.doing(agv);
    return FP_OK;
  });
}

// These two functions cannot refuse a call. They are counted, so that an agent that never stops calling them is
// noticed.
std::int64_t now_ns(fp_controller* controller) {
  (void)controller->part->admit_service(*controller);
  return controller->part->ports().timers.now_ns(controller->agv);
}

[[gnu::flatten]] std::int32_t set_timer(fp_controller* controller, std::uint32_t timer, std::int64_t at) {
  return admitted(controller, [&](AgvController& part, AgvId agv) { return part.set_timer(agv, timer, at); });
}

std::uint64_t random_bits(fp_controller* controller, std::uint32_t purpose, std::uint64_t index) {
  (void)controller->part->admit_service(*controller);
  return controller->part->random(controller->agv, purpose, index);
}

std::int32_t declare_cost_ns(fp_controller* controller, std::int64_t cost_ns) {
  return admitted(controller, [&](AgvController& part, AgvId agv) { return part.declare_cost(agv, cost_ns); });
}

std::int32_t safe_mode(fp_controller* controller, std::uint32_t on) {
  return admitted_on_board(controller,
                           [&](AgvController& part, AgvId agv) { return part.declare_safe_mode(agv, on != 0); });
}

std::int32_t waiting_for(fp_controller* controller, std::uint32_t other) {
  return admitted_on_board(controller,
                           [&](AgvController& part, AgvId agv) { return part.declare_waiting(agv, agv.value, other); });
}

std::int32_t works_on(fp_controller* controller, std::uint32_t agv, std::uint32_t order) {
  return admitted(controller,
                  [&](AgvController& part, EntityId speaker) { return part.works_on(speaker, agv, order); });
}

std::int32_t declare_waiting(fp_controller* controller, std::uint32_t agv, std::uint32_t other) {
  return admitted(controller,
                  [&](AgvController& part, EntityId speaker) { return part.declare_waiting(speaker, agv, other); });
}

template <TraceKind kKind>
std::int32_t note(fp_controller* controller, const char* text) {
  return admitted(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (text == nullptr) return FP_INVALID;
    part.ports().declarations.note(agv, kKind, text);
    return FP_OK;
  });
}

// Of the text so much is kept as a crash can be filed with (AgentHost cuts it to its size).
std::int32_t cannot_start(fp_controller* controller, const char* why) {
  return admitted(controller, [&](AgvController&, AgvId) -> std::int32_t {
    constexpr std::size_t kLongest = 1000;
    if (why == nullptr) return FP_INVALID;
    if (controller->why_not == nullptr) return FP_REFUSED;
    controller->why_not->assign(why, ::strnlen(why, kLongest));
    return FP_OK;
  });
}

std::int32_t keep(fp_controller* controller, std::uint32_t number, const void* bytes, std::uint32_t size) {
  return admitted(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (bytes == nullptr && size > 0) return FP_INVALID;
    if (size > FP_DISK_BYTES) return FP_REFUSED;
    return part.keep(agv, number, disk_record({static_cast<const char*>(bytes), size}));
  });
}

std::int32_t recall(fp_controller* controller, std::uint32_t number, fp_record* out) {
  return admitted(controller, [&](AgvController& part, AgvId agv) -> std::int32_t {
    if (out == nullptr || out->struct_size < sizeof(fp_record)) return FP_INVALID;
    const DiskRecord* record = part.ports().disks.find(agv, number);
    if (record == nullptr) return FP_EMPTY;
    out->size = record->size;
    out->bytes = record->bytes.data();
    return FP_OK;
  });
}

// No call of the controller: it is neither counted nor does it cost anything.
std::int32_t conflict(fp_controller* controller, const fp_occupancy* a, const fp_occupancy* b, double margin_m,
                      std::uint32_t* out) {
  if (!controller->in_activation()) return FP_SUSPENDED;
  if (a == nullptr || b == nullptr || out == nullptr) return FP_INVALID;
  const auto may = controller->plant->conflict(*a, *b, margin_m);
  if (!may) return FP_INVALID;
  *out = *may ? 1 : 0;
  return FP_OK;
}

// Neither of these two is a call of the controller.
std::int32_t fail(fp_controller* controller, std::uint32_t hang, const char* text) {
  constexpr std::size_t kLongest = 1000;
  if (!controller->in_activation()) return FP_SUSPENDED;
  if (text == nullptr) return FP_INVALID;
  AgvController::fail(*controller, hang != 0, {text, ::strnlen(text, kLongest)});
  return FP_OK;
}

std::int32_t perceive(fp_controller* controller, fp_perceived* out) {
  if (!controller->in_activation()) return FP_SUSPENDED;
  if (out == nullptr || out->struct_size < sizeof(fp_perceived)) return FP_INVALID;
  const AgvController::Ports& ports = controller->part->ports();
  const AgvId agv = controller->agv;
  const auto unread = ports.messenger.unread(agv);
  out->messages = unread.data();
  out->message_count = static_cast<std::uint32_t>(unread.size());
  out->message_stride = sizeof(fp_message);
  out->now_ns = ports.timers.now_ns(agv);
  out->action = 0;
  out->battery_level = 0.0;
  out->pose = {};
  out->order_id = FP_NONE;
  if (controller->is_computer) return FP_OK;
  const Pose pose = ports.sensor.perceived(agv);
  out->pose = {pose.position_m.x(), pose.position_m.y(), pose.heading.x(), pose.heading.y()};
  out->battery_level = ports.battery.level(agv);
  out->action = ports.actions.doing(agv);
  out->order_id = controller->part->order_on_board(agv);
  return FP_OK;
}

// ---- notes. Mostly, nobody hears them.

void describe(fp_controller* controller, const char* kind) {
  if (!controller->hears_notes) return;
  const auto text = noted(kind);
  if (text && controller->part->admit_note(controller->agv))
    controller->part->ports().declarations.describe(controller->agv, *text);
}

void describe_message(fp_controller* controller, const fp_message_fields* fields) {
  if (!controller->hears_notes) return;
  const auto text = noted(fields);
  if (text && controller->part->admit_note(controller->agv))
    controller->part->ports().declarations.describe(controller->agv, *text);
}

void declare_state(fp_controller* controller, const char* state) {
  if (!controller->hears_notes) return;
  const auto text = noted(state);
  if (text && controller->part->admit_note(controller->agv))
    controller->part->ports().declarations.set_state(controller->agv, *text);
}

void believe(fp_controller* controller, std::uint32_t about, const fp_pose* where, std::int64_t as_of_ns) {
  if (!controller->hears_notes) return;
  const auto pose = noted(where);
  if (pose && controller->part->admit_note(controller->agv))
    controller->part->ports().declarations.believe(controller->agv, about, *pose, as_of_ns);
}

}  // namespace

const fp_host kHost = {
    sizeof(fp_host),
    FP_ABI_MAJOR,
    FP_ABI_MINOR,
    action<FP_CALL_MOVE>,
    action<FP_CALL_PICK>,
    action<FP_CALL_DROP>,
    action<FP_CALL_PARK>,
    action<FP_CALL_CHARGE>,
    send_broadcast,
    send_unicast,
    get_position,
    get_battery_level,
    get_message,
    is_loaded,
    get_action,
    now_ns,
    set_timer,
    random_bits,
    declare_cost_ns,
    safe_mode,
    waiting_for,
    note<TraceKind::Probe>,
    note<TraceKind::Log>,
    pick_load,
    get_load,
    stop<true>,
    stop<false>,
    describe,
    declare_state,
    believe,
    cannot_start,
    keep,
    recall,
    conflict,
    works_on,
    declare_waiting,
    fail,
    perceive,
    describe_message,
};

}  // namespace fleetproof
