#include "core/engine/foreign_table.hpp"

#include <type_traits>

#include "core/engine/agv_controller.hpp"
#include "core/engine/call_tape.hpp"
#include "core/engine/controller_table.hpp"
#include "core/engine/disks.hpp"
#include "core/engine/foreign_calls.hpp"
#include "core/engine/notes.hpp"

namespace fleetproof {
namespace {

// ---- one function for each list of arguments. Arguments with which a call does nothing are not read.

void record(CallTape& tape, TapeItem item, std::uint32_t what) { tape.controller_call(item, what); }

void record(CallTape& tape, TapeItem item, std::uint32_t segment, std::uint32_t order) {
  tape.controller_call(item, segment, order);
}

void record(CallTape& tape, TapeItem item, std::int64_t cost_ns) { tape.controller_call(item, cost_ns); }

void record(CallTape& tape, TapeItem item, std::uint32_t timer, std::int64_t at_ns) {
  tape.controller_call(item, timer, at_ns);
}

bool is_sent(const void* bytes, std::uint32_t size) {
  return size <= FP_MESSAGE_BYTES_MAX && (bytes != nullptr || size == 0);
}

void record(CallTape& tape, TapeItem item, const void* bytes, std::uint32_t size) {
  if (!is_sent(bytes, size)) return tape.controller_call(TapeItem::NoEffect);
  tape.controller_call(item, std::string_view(static_cast<const char*>(bytes), size));
}

void record(CallTape& tape, TapeItem item, const void* bytes, std::uint32_t size, std::uint32_t receiver) {
  if (!is_sent(bytes, size)) return tape.controller_call(TapeItem::NoEffect);
  tape.controller_call(item, std::string_view(static_cast<const char*>(bytes), size), receiver);
}

template <class Perceived>
void record(CallTape& tape, TapeItem item, Perceived* out) {
  tape.controller_call(out != nullptr ? item : TapeItem::NoEffect);
}

void record(CallTape& tape, TapeItem item, fp_message* out) {
  const bool reads = out != nullptr && out->struct_size >= sizeof(fp_message);
  tape.controller_call(reads ? item : TapeItem::NoEffect);
}

void record(CallTape& tape, TapeItem item, const char* text) {
  if (item == TapeItem::Describe || item == TapeItem::DeclareState) {
    if (const auto kept = noted(text)) tape.note(item, *kept);
    return;
  }
  // A crash is on the tape with its message, and why an agent cannot start is part of that.
  if (text == nullptr || item == TapeItem::NoEffect) return tape.controller_call(TapeItem::NoEffect);
  tape.controller_call(item, std::string_view(text));
}

void record(CallTape& tape, TapeItem item, const fp_message_fields* fields) {
  if (const auto kept = noted(fields)) tape.note(item, std::string_view(*kept));
}

// A record that cannot be kept is refused, whatever is in it.
void record(CallTape& tape, TapeItem item, std::uint32_t number, const void* bytes, std::uint32_t size) {
  if (size > FP_DISK_BYTES || (bytes == nullptr && size > 0)) return tape.controller_call(TapeItem::NoEffect);
  const std::uint64_t hash = disk_hash({static_cast<const char*>(bytes), size});
  tape.controller_call(item, number, size, static_cast<std::int64_t>(hash));
}

void record(CallTape& tape, TapeItem item, std::uint32_t, fp_record*) { tape.controller_call(item); }  // recall

// Questions that nothing depends on, and a failure: a crash is on the tape with its message.
void record(CallTape&, TapeItem, fp_perceived*) {}
void record(CallTape&, TapeItem, std::uint32_t, const char*) {}
void record(CallTape&, TapeItem, const fp_occupancy*, const fp_occupancy*, double, std::uint32_t*) {}

void record(CallTape& tape, TapeItem, std::uint32_t, std::uint64_t) { tape.service(); }  // random

void record(CallTape& tape, TapeItem item) {
  if (item == TapeItem::Services) return tape.service();  // now_ns
  tape.controller_call(item);
}

void record(CallTape& tape, TapeItem item, std::uint32_t about, const fp_pose* where, std::int64_t as_of_ns) {
  const auto kept = noted(where);
  if (!kept) return;
  tape.note(item, about, std::int64_t{kept->x_mm}, std::int64_t{kept->y_mm}, std::int64_t{kept->heading_x},
            std::int64_t{kept->heading_y}, as_of_ns);
}

// ---- the function of the table for a member of fp_host

// What a call returns that is refused before it reaches the controller.
template <class Result>
Result refused() {
  if constexpr (std::is_same_v<Result, std::int32_t>) return FP_SUSPENDED;
  return Result();
}

template <auto kMember, TapeItem kItem>
struct Guarded;

template <class Result, class... Arguments, Result (*fp_host::*kMember)(fp_controller*, Arguments...), TapeItem kItem>
struct Guarded<kMember, kItem> {
  static Result call(fp_controller* given, Arguments... arguments) {
    ForeignHandle& handle = *reinterpret_cast<ForeignHandle*>(given);
    if (!handle.admits()) return refused<Result>();
    if constexpr (std::is_void_v<Result>) {  // a note; mostly, nobody hears it
      if (!handle.controller->hears_notes && handle.controller->tape == nullptr) return;
    }
    const EngineProcessorState ours;
    if (CallTape* tape = handle.controller->tape) record(*tape, kItem, arguments...);
    return (kHost.*kMember)(handle.controller, arguments...);
  }
};

template <auto kMember, TapeItem kItem>
constexpr auto* guarded = &Guarded<kMember, kItem>::call;

}  // namespace

const fp_host kForeignHost = {
    sizeof(fp_host),
    FP_ABI_MAJOR,
    FP_ABI_MINOR,
    guarded<&fp_host::move, TapeItem::Move>,
    guarded<&fp_host::pick, TapeItem::Pick>,
    guarded<&fp_host::drop, TapeItem::Drop>,
    guarded<&fp_host::park, TapeItem::Park>,
    guarded<&fp_host::charge, TapeItem::Charge>,
    guarded<&fp_host::send_broadcast, TapeItem::SendBroadcast>,
    guarded<&fp_host::send_unicast, TapeItem::SendUnicast>,
    guarded<&fp_host::get_position, TapeItem::GetPosition>,
    guarded<&fp_host::get_battery_level, TapeItem::GetBatteryLevel>,
    guarded<&fp_host::get_message, TapeItem::GetMessage>,
    guarded<&fp_host::is_loaded, TapeItem::IsLoaded>,
    guarded<&fp_host::get_action, TapeItem::GetAction>,
    guarded<&fp_host::now_ns, TapeItem::Services>,
    guarded<&fp_host::set_timer, TapeItem::SetTimer>,
    guarded<&fp_host::random, TapeItem::Services>,
    guarded<&fp_host::declare_cost_ns, TapeItem::DeclareCost>,
    guarded<&fp_host::safe_mode, TapeItem::SafeMode>,
    guarded<&fp_host::waiting_for, TapeItem::WaitingFor>,
    guarded<&fp_host::sometimes, TapeItem::Sometimes>,
    guarded<&fp_host::log, TapeItem::Log>,
    guarded<&fp_host::pick_load, TapeItem::PickLoad>,
    guarded<&fp_host::get_load, TapeItem::GetLoad>,
    guarded<&fp_host::stop, TapeItem::Stop>,
    guarded<&fp_host::go_on, TapeItem::GoOn>,
    guarded<&fp_host::describe, TapeItem::Describe>,
    guarded<&fp_host::declare_state, TapeItem::DeclareState>,
    guarded<&fp_host::believe, TapeItem::Believe>,
    guarded<&fp_host::cannot_start, TapeItem::NoEffect>,
    guarded<&fp_host::keep, TapeItem::Keep>,
    guarded<&fp_host::recall, TapeItem::NoEffect>,
    guarded<&fp_host::conflict, TapeItem::NoEffect>,
    guarded<&fp_host::works_on, TapeItem::WorksOn>,
    guarded<&fp_host::declare_waiting, TapeItem::DeclareWaiting>,
    guarded<&fp_host::fail, TapeItem::NoEffect>,
    guarded<&fp_host::perceive, TapeItem::NoEffect>,
    guarded<&fp_host::describe_message, TapeItem::DescribeMessage>,
};

}  // namespace fleetproof
