#include "core/engine/tape_player.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/engine/agv_controller.hpp"
#include "core/engine/controller_table.hpp"
#include "core/engine/declarations.hpp"
#include "core/engine/disks.hpp"
#include "core/engine/notes.hpp"

namespace fleetproof {

TapePlayer::TapePlayer(std::string_view tape) : rest_(tape) {
  if (byte() != kTapeVersion) fail("another version of the program has written it");
}

void TapePlayer::finish() const {
  if (!rest_.empty()) fail("it holds calls that the run does not make");
}

std::optional<AgentFailure> TapePlayer::play(const AgentCall& call, void*& agent) {
  if (rest_.empty()) fail("the run goes on after its end");
  if (id() != call.agv.value || id() != call.kind()) fail("it holds another call than the run makes");
  const bool needs_agent = call.is_start();
  while (true) {
    const TapeItem next = item();
    switch (next) {
      case TapeItem::Returned:
        if (agent == nullptr && !call.is_run_end) fail("a call returns without an agent");
        return std::nullopt;
      case TapeItem::Crashed:
      case TapeItem::Hung:
        return AgentFailure{next == TapeItem::Hung, std::string(text())};
      case TapeItem::Created:
        if (!needs_agent || agent != nullptr) fail("it creates an agent where there is one");
        agent = this;
        break;
      case TapeItem::FaultIsKnown:
        if (!call.is_question()) fail("it answers what nobody has asked");
        *call.question.knows = true;
        break;
      case TapeItem::ProcessorChanged:
        ++processor_changes_;
        break;
      default:
        if (call.controller == nullptr) fail("an agent makes calls where it must not");
        play_controller_call(next, call.controller);
    }
  }
}

bool TapePlayer::ends_run_for(EntityId first) const {
  if (rest_.empty()) return false;
  TapePlayer ahead = *this;
  return ahead.id() == first.value && ahead.id() == CallNote::kRunEnds;
}

// ---- calls

void TapePlayer::play_controller_call(TapeItem item, fp_controller* c) {
  switch (item) {
    case TapeItem::Services:
      return c->part->admit_services(c->agv, number());
    case TapeItem::NoEffect:
      return void(c->part->admit(*c));
    case TapeItem::OverLimit:
      return c->part->refuse(c->agv, number());
    case TapeItem::Move:
      return void(kHost.move(c, id()));
    case TapeItem::Pick:
      return void(kHost.pick(c, id()));
    case TapeItem::Drop:
      return void(kHost.drop(c, id()));
    case TapeItem::Park:
      return void(kHost.park(c, id()));
    case TapeItem::Charge:
      return void(kHost.charge(c, id()));
    case TapeItem::PickLoad: {
      const std::uint32_t segment = id();
      return void(kHost.pick_load(c, segment, id()));
    }
    case TapeItem::Stop:
      return void(kHost.stop(c));
    case TapeItem::GoOn:
      return void(kHost.go_on(c));
    case TapeItem::SendBroadcast:
    case TapeItem::SendUnicast:
      return play_message(item, c);
    case TapeItem::SetTimer: {
      const std::uint32_t timer = id();
      return void(kHost.set_timer(c, timer, time_ns()));
    }
    case TapeItem::DeclareCost:
      return void(kHost.declare_cost_ns(c, time_ns()));
    case TapeItem::SafeMode:
      return void(kHost.safe_mode(c, id()));
    case TapeItem::WaitingFor:
      return void(kHost.waiting_for(c, id()));
    case TapeItem::WorksOn: {
      const std::uint32_t agv = id();
      return void(kHost.works_on(c, agv, id()));
    }
    case TapeItem::DeclareWaiting: {
      const std::uint32_t agv = id();
      return void(kHost.declare_waiting(c, agv, id()));
    }
    case TapeItem::Keep:
      return play_keep(c);
    case TapeItem::Sometimes:
    case TapeItem::Log: {
      const auto note = item == TapeItem::Log ? kHost.log : kHost.sometimes;
      return void(note(c, std::string(text()).c_str()));
    }
    case TapeItem::Describe:
    case TapeItem::DescribeMessage:
    case TapeItem::DeclareState:
    case TapeItem::Believe:
    case TapeItem::NotesLeftOut:
      return play_note(item, c);
    default:
      return play_perception(item, c);
  }
}

void TapePlayer::play_message(TapeItem item, fp_controller* c) {
  const std::string_view bytes = text();
  const auto size = static_cast<std::uint32_t>(bytes.size());
  if (item == TapeItem::SendBroadcast) return void(kHost.send_broadcast(c, bytes.data(), size));
  kHost.send_unicast(c, bytes.data(), size, id());
}

void TapePlayer::play_keep(fp_controller* c) {
  const std::uint32_t number = id();
  DiskRecord record;
  record.size = id();
  record.hash = static_cast<std::uint64_t>(time_ns());
  if (c->part->admit(*c)) c->part->keep(c->agv, number, std::move(record));
}

void TapePlayer::play_perception(TapeItem item, fp_controller* c) {
  fp_pose pose{};
  double level = 0.0;
  std::uint32_t word = 0;
  fp_message message{};
  message.struct_size = sizeof message;
  switch (item) {
    case TapeItem::GetPosition:
      return void(kHost.get_position(c, &pose));
    case TapeItem::GetBatteryLevel:
      return void(kHost.get_battery_level(c, &level));
    case TapeItem::GetMessage:
      return void(kHost.get_message(c, &message));
    case TapeItem::IsLoaded:
      return void(kHost.is_loaded(c, &word));
    case TapeItem::GetAction:
      return void(kHost.get_action(c, &word));
    case TapeItem::GetLoad:
      return void(kHost.get_load(c, &word));
    default:
      fail("it holds something that no agent does");
  }
}

void TapePlayer::play_note(TapeItem item, fp_controller* c) {
  if (item == TapeItem::NotesLeftOut) {
    c->part->ports().declarations.leave_out(c->agv, number());
  } else if (item == TapeItem::Believe) {
    const std::uint32_t about = id();
    NotedPose where;
    where.x_mm = static_cast<std::int32_t>(time_ns());
    where.y_mm = static_cast<std::int32_t>(time_ns());
    where.heading_x = static_cast<std::int16_t>(time_ns());
    where.heading_y = static_cast<std::int16_t>(time_ns());
    const fp_pose pose = as_given(where);
    kHost.believe(c, about, &pose, time_ns());
  } else if (item == TapeItem::DescribeMessage) {
    const std::string words(text());
    if (c->hears_notes && c->part->admit_note(c->agv)) c->part->ports().declarations.describe(c->agv, words);
  } else {
    const std::string words(text());
    (item == TapeItem::Describe ? kHost.describe : kHost.declare_state)(c, words.c_str());
  }
}

// ---- bytes

std::uint8_t TapePlayer::byte() {
  if (rest_.empty()) fail("it ends too early");
  const auto value = static_cast<std::uint8_t>(rest_.front());
  rest_.remove_prefix(1);
  return value;
}

std::uint64_t TapePlayer::number() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint64_t part = byte();
    value |= (part & 0x7fU) << shift;
    if (part < 0x80) return value;
  }
  fail("a number is too long");
}

std::uint32_t TapePlayer::id() { return static_cast<std::uint32_t>(number() - 1); }

std::int64_t TapePlayer::time_ns() {
  const std::uint64_t bits = number();
  return static_cast<std::int64_t>((bits & 1U) != 0 ? ~(bits >> 1U) : bits >> 1U);
}

std::string_view TapePlayer::text() {
  const std::uint64_t size = number();
  if (size > rest_.size()) fail("it ends too early");
  const std::string_view value = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return value;
}

void TapePlayer::fail(std::string_view why) {
  throw EngineError("the recording does not fit this run: " + std::string(why));
}

}  // namespace fleetproof
