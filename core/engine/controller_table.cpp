// The AGV controller as the agent sees it: the paper's interface (Sect. 2.2) in C, each call checked and passed on to
// the engine.
#include "core/engine/engine.hpp"

namespace fleetproof {
namespace {

template <class Call>
std::int32_t admitted(fp_controller* controller, Call call) {
  Agv& agv = controller->engine->agv(controller->agv);
  if (!controller->engine->admit_call(agv)) return FP_SUSPENDED;
  return call(*controller->engine, agv);
}

template <fp_call kCall>
std::int32_t action(fp_controller* controller, std::uint32_t segment) {
  return admitted(controller, [&](Engine& engine, Agv& agv) { return engine.act(agv, kCall, segment); });
}

std::int32_t send_unicast(fp_controller* controller, const void* bytes, std::uint32_t size, std::uint32_t receiver) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (bytes == nullptr && size > 0) return FP_INVALID;
    return engine.send(agv, {static_cast<const char*>(bytes), size}, receiver);
  });
}

std::int32_t send_broadcast(fp_controller* controller, const void* bytes, std::uint32_t size) {
  return send_unicast(controller, bytes, size, FP_NONE);
}

std::int32_t get_position(fp_controller* controller, fp_pose* out) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    const Pose pose = engine.perceived_pose(agv);
    *out = {pose.position_m.x(), pose.position_m.y(), pose.heading.x(), pose.heading.y()};
    return FP_OK;
  });
}

std::int32_t get_battery_level(fp_controller* controller, double* out) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    *out = engine.battery_of(agv);
    return FP_OK;
  });
}

std::int32_t get_message(fp_controller* controller, fp_message* out) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (out == nullptr || out->struct_size < sizeof(fp_message)) return FP_INVALID;
    return engine.read_message(agv, *out);
  });
}

std::int32_t is_loaded(fp_controller* controller, std::uint32_t* out) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    *out = engine.is_loaded(agv) ? 1 : 0;
    return FP_OK;
  });
}

std::int32_t get_action(fp_controller* controller, std::uint32_t* out) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (out == nullptr) return FP_INVALID;
    *out = engine.action_of(agv);
    return FP_OK;
  });
}

// The two calls that cannot answer with a result still count, so that an agent that spins on them is found out.
std::int64_t now_ns(fp_controller* controller) {
  Agv& agv = controller->engine->agv(controller->agv);
  (void)controller->engine->admit_call(agv);
  return controller->engine->agent_now_ns(agv);
}

std::int32_t set_timer(fp_controller* controller, std::uint32_t timer, std::int64_t at) {
  return admitted(controller, [&](Engine& engine, Agv& agv) { return engine.set_timer(agv, timer, at); });
}

std::uint64_t random_bits(fp_controller* controller, std::uint32_t purpose, std::uint64_t index) {
  Agv& agv = controller->engine->agv(controller->agv);
  (void)controller->engine->admit_call(agv);
  return controller->engine->random(agv, purpose, index);
}

std::int32_t declare_cost_ns(fp_controller* controller, std::int64_t cost_ns) {
  return admitted(controller, [&](Engine&, Agv& agv) -> std::int32_t {
    constexpr std::int64_t kCostMax_ns =
        3'600'000'000'000;  // an agent that thinks for an hour is a hang of another kind
    if (cost_ns < 0 || cost_ns > kCostMax_ns) return FP_INVALID;
    agv.cost += Duration{cost_ns};
    return FP_OK;
  });
}

std::int32_t safe_mode(fp_controller* controller, std::uint32_t on) {
  return admitted(controller, [&](Engine& engine, Agv& agv) { return engine.declare_safe_mode(agv, on != 0); });
}

std::int32_t waiting_for(fp_controller* controller, std::uint32_t for_whom) {
  return admitted(controller, [&](Engine& engine, Agv& agv) { return engine.declare_waiting(agv, for_whom); });
}

template <TraceKind kKind>
std::int32_t note(fp_controller* controller, const char* text) {
  return admitted(controller, [&](Engine& engine, Agv& agv) -> std::int32_t {
    if (text == nullptr) return FP_INVALID;
    engine.note(agv, kKind, text);
    return FP_OK;
  });
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
};

}  // namespace fleetproof
