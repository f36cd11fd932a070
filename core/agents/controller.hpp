#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "core/agents/shapes.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

// The AGV controller for the reference agents: the C table of the host as a C++ class.
class Controller {
 public:
  // `boot`: the boot of the computer. Each boot draws other random numbers.
  Controller(const fp_host& host, fp_controller* handle, std::uint32_t boot = 0)
      : host_(host), handle_(handle), draws_(std::uint64_t{boot} << 32) {}

  // Actions. True if the host accepted the action. `segment` may be FP_HERE, but not for move.
  bool move(std::uint32_t segment) { return host_.move(handle_, segment) == FP_OK; }
  bool pick(std::uint32_t segment) { return host_.pick(handle_, segment) == FP_OK; }
  // As `pick`, but the load of this order. A host of an older minor version chooses the load itself.
  bool pick_load(std::uint32_t segment, std::uint32_t order_id) {
    return host_.abi_minor < 2 ? pick(segment) : host_.pick_load(handle_, segment, order_id) == FP_OK;
  }
  bool drop(std::uint32_t segment) { return host_.drop(handle_, segment) == FP_OK; }
  bool park(std::uint32_t segment) { return host_.park(handle_, segment) == FP_OK; }
  bool charge(std::uint32_t segment) { return host_.charge(handle_, segment) == FP_OK; }
  void broadcast(std::span<const std::byte> bytes) {
    host_.send_broadcast(handle_, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  }
  void send(std::span<const std::byte> bytes, std::uint32_t receiver) {
    host_.send_unicast(handle_, bytes.data(), static_cast<std::uint32_t>(bytes.size()), receiver);
  }

  // False if there is no position; `out` is then unchanged.
  bool pose(fp_pose& out) { return host_.get_position(handle_, &out) == FP_OK; }
  // What the AGV is doing; FP_STOPPED if the host does not say.
  std::uint32_t action() {
    std::uint32_t action = FP_STOPPED;
    return host_.get_action(handle_, &action) == FP_OK ? action : std::uint32_t{FP_STOPPED};
  }
  bool out_of_order() { return action() == FP_OUT_OF_ORDER; }
  bool loaded() {
    std::uint32_t loaded = 0;
    return host_.is_loaded(handle_, &loaded) == FP_OK && loaded != 0;
  }
  // The order of the load on board. FP_NONE if there is no load, or if the host does not say.
  std::uint32_t order_on_board() {
    std::uint32_t order_id = FP_NONE;
    return host_.abi_minor >= 2 && host_.get_load(handle_, &order_id) == FP_OK ? order_id : FP_NONE;
  }
  // 1.0 (full) if the host does not say.
  double battery_level() {
    double level = 1.0;
    return host_.get_battery_level(handle_, &level) == FP_OK ? level : 1.0;
  }
  // Calls `receive(sender, bytes)` for every message in the inbox.
  template <class Receive>
  void drain_inbox(Receive receive) {
    fp_message message{};
    message.struct_size = sizeof(fp_message);
    while (host_.get_message(handle_, &message) == FP_OK) {
      receive(message.sender, std::span(static_cast<const std::byte*>(message.bytes), message.size));
    }
  }

  std::int64_t now_ns() const { return clock_ns_ ? *clock_ns_ : host_.now_ns(handle_); }
  // The own clock stands still during an activation, and the event says what it shows. Until the next call, `now_ns`
  // need not ask the host.
  void set_clock(std::int64_t now_ns) { clock_ns_ = now_ns; }
  void set_timer(std::uint32_t timer, std::int64_t at_ns) {
    host_.set_timer(handle_, timer, at_ns < 0 ? 0 : at_ns);
  }  // an instant below 0 would clear the timer
  // The next draw of this stream, uniform on [0, 1).
  double random(std::uint32_t purpose) {
    return static_cast<double>(host_.random(handle_, purpose, draws_++) >> 11) * 0x1p-53;
  }
  void waiting_for(std::uint32_t agv) {
    if (agv == declared_) return;
    declared_ = agv;
    host_.waiting_for(handle_, agv);
  }
  // Of the program of a computer: which order an AGV works on, and for which other AGV it waits.
  void works_on(std::uint32_t agv, std::uint32_t order_id) { host_.works_on(handle_, agv, order_id); }
  void declare_waiting(std::uint32_t agv, std::uint32_t for_agv) { host_.declare_waiting(handle_, agv, for_agv); }
  // The disk. Of a computer: a host that knows computers has one. False: the record was not taken.
  bool keep(std::uint32_t record, std::span<const std::byte> bytes) {
    return host_.keep(handle_, record, bytes.data(), static_cast<std::uint32_t>(bytes.size())) == FP_OK;
  }
  // Empty if there is no such record. Valid until the next `keep` or the end of the activation.
  std::span<const std::byte> recall(std::uint32_t record) {
    fp_record found{};
    found.struct_size = sizeof(fp_record);
    if (host_.recall(handle_, record, &found) != FP_OK) return {};
    return {static_cast<const std::byte*>(found.bytes), found.size};
  }
  void sometimes(const char* probe) { host_.sometimes(handle_, probe); }

  // Notes for people who look at a trace. A host of an older minor version takes none.
  void describe(const char* kind) {
    if (takes_notes()) host_.describe(handle_, kind);
  }
  // Of a message that is described as "KIND: content", with the requests that it makes and answers.
  void describe(const char* kind_and_content, const char* asks, const char* answers, const char* about = nullptr) {
    if (host_.abi_minor < 7) return describe(kind_and_content);
    const char* content = std::strstr(kind_and_content, ": ");
    const std::string_view kind(kind_and_content, content == nullptr
                                                      ? std::strlen(kind_and_content)
                                                      : static_cast<std::size_t>(content - kind_and_content));
    std::array<char, 32> word{};
    kind.copy(word.data(), word.size() - 1);
    const fp_message_fields fields{
        sizeof(fp_message_fields), word.data(), content == nullptr ? "" : content + 2, asks, answers, about};
    host_.describe_message(handle_, &fields);
  }
  // `state` is a constant.
  void declare_state(const char* state) {
    if (state == state_ || !takes_notes()) return;
    state_ = state;
    host_.declare_state(handle_, state);
  }
  void believe(std::uint32_t agv, Vec position_m, std::int64_t as_of_ns) {
    const fp_pose where{position_m.x, position_m.y, 0.0, 0.0};
    if (takes_notes()) host_.believe(handle_, agv, &where, as_of_ns);
  }

 private:
  bool takes_notes() const { return host_.abi_minor >= 2; }

  const fp_host& host_;
  fp_controller* handle_;
  std::uint64_t draws_;
  std::optional<std::int64_t> clock_ns_;
  std::uint32_t declared_ = FP_NONE;
  const char* state_ = nullptr;
};

}  // namespace fleetproof::agents
