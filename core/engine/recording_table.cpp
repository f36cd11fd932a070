#include "core/engine/recording_table.hpp"

#include "core/engine/agv_controller.hpp"
#include "core/engine/call_tape.hpp"
#include "core/engine/controller_table.hpp"
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
  if (text == nullptr) return tape.controller_call(TapeItem::NoEffect);
  tape.controller_call(item, std::string_view(text));
}

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

template <auto kMember, TapeItem kItem>
struct Recorded;

template <class Result, class... Arguments, Result (*fp_host::*kMember)(fp_controller*, Arguments...), TapeItem kItem>
struct Recorded<kMember, kItem> {
  static Result call(fp_controller* controller, Arguments... arguments) {
    if (controller->tape != nullptr) record(*controller->tape, kItem, arguments...);
    return (kHost.*kMember)(controller, arguments...);
  }
};

template <auto kMember, TapeItem kItem>
constexpr auto* recorded = &Recorded<kMember, kItem>::call;

}  // namespace

const fp_host kRecordingHost = {
    sizeof(fp_host),
    FP_ABI_MAJOR,
    FP_ABI_MINOR,
    recorded<&fp_host::move, TapeItem::Move>,
    recorded<&fp_host::pick, TapeItem::Pick>,
    recorded<&fp_host::drop, TapeItem::Drop>,
    recorded<&fp_host::park, TapeItem::Park>,
    recorded<&fp_host::charge, TapeItem::Charge>,
    recorded<&fp_host::send_broadcast, TapeItem::SendBroadcast>,
    recorded<&fp_host::send_unicast, TapeItem::SendUnicast>,
    recorded<&fp_host::get_position, TapeItem::GetPosition>,
    recorded<&fp_host::get_battery_level, TapeItem::GetBatteryLevel>,
    recorded<&fp_host::get_message, TapeItem::GetMessage>,
    recorded<&fp_host::is_loaded, TapeItem::IsLoaded>,
    recorded<&fp_host::get_action, TapeItem::GetAction>,
    recorded<&fp_host::now_ns, TapeItem::Services>,
    recorded<&fp_host::set_timer, TapeItem::SetTimer>,
    recorded<&fp_host::random, TapeItem::Services>,
    recorded<&fp_host::declare_cost_ns, TapeItem::DeclareCost>,
    recorded<&fp_host::safe_mode, TapeItem::SafeMode>,
    recorded<&fp_host::waiting_for, TapeItem::WaitingFor>,
    recorded<&fp_host::sometimes, TapeItem::Sometimes>,
    recorded<&fp_host::log, TapeItem::Log>,
    recorded<&fp_host::pick_load, TapeItem::PickLoad>,
    recorded<&fp_host::get_load, TapeItem::GetLoad>,
    recorded<&fp_host::stop, TapeItem::Stop>,
    recorded<&fp_host::go_on, TapeItem::GoOn>,
    recorded<&fp_host::describe, TapeItem::Describe>,
    recorded<&fp_host::declare_state, TapeItem::DeclareState>,
    recorded<&fp_host::believe, TapeItem::Believe>,
};

}  // namespace fleetproof
