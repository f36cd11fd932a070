#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents::testing {

// A controller that notes what a program calls, for tests of one program alone: what arrives is put into `inbox`, and a
// disk keeps records. The AGV is idle and stands where a test says; every move is accepted.
struct StubHost {
  using Bytes = std::vector<std::byte>;

  fp_host table = make_table();
  std::deque<std::pair<std::uint32_t, Bytes>> inbox;  // sender and message
  std::vector<Bytes> sent;
  std::vector<std::uint32_t> moves;  // segments
  std::string state;                 // as declared
  std::multiset<std::string> probes;
  fp_pose pose{0.0, 0.0, 1.0, 0.0};
  std::map<std::uint32_t, Bytes> disk;
  bool disk_is_full = false;

  fp_controller* handle() { return reinterpret_cast<fp_controller*>(this); }

 private:
  static StubHost& of(fp_controller* controller) { return *reinterpret_cast<StubHost*>(controller); }
  static Bytes bytes_of(const void* bytes, std::uint32_t size) {
    const auto* first = static_cast<const std::byte*>(bytes);
    return {first, first + size};
  }

  static std::int32_t get_message(fp_controller* c, fp_message* out) {
    StubHost& self = of(c);
    if (self.inbox.empty()) return FP_EMPTY;
    self.in_hand = std::move(self.inbox.front());
    self.inbox.pop_front();
    out->sender = self.in_hand.first;
    out->bytes = self.in_hand.second.data();
    out->size = static_cast<std::uint32_t>(self.in_hand.second.size());
    return FP_OK;
  }
  static std::int32_t keep(fp_controller* c, std::uint32_t record, const void* bytes, std::uint32_t size) {
    if (of(c).disk_is_full) return FP_REFUSED;
    of(c).disk[record] = bytes_of(bytes, size);
    return FP_OK;
  }
  static std::int32_t recall(fp_controller* c, std::uint32_t record, fp_record* out) {
    const auto found = of(c).disk.find(record);
    if (found == of(c).disk.end()) return FP_EMPTY;
    out->bytes = found->second.data();
    out->size = static_cast<std::uint32_t>(found->second.size());
    return FP_OK;
  }

  static fp_host make_table() {
    fp_host table{};
    table.struct_size = sizeof table;
    table.abi_major = FP_ABI_MAJOR, table.abi_minor = FP_ABI_MINOR;
    table.move = [](fp_controller* c, std::uint32_t segment) -> std::int32_t {
      of(c).moves.push_back(segment);
      return FP_OK;
    };
    table.send_unicast = [](fp_controller* c, const void* bytes, std::uint32_t size, std::uint32_t) -> std::int32_t {
      of(c).sent.push_back(bytes_of(bytes, size));
      return FP_OK;
    };
    table.get_position = [](fp_controller* c, fp_pose* out) -> std::int32_t { return *out = of(c).pose, FP_OK; };
    table.get_battery_level = [](fp_controller*, double* out) -> std::int32_t { return *out = 1.0, FP_OK; };
    table.get_message = get_message;
    table.get_action = [](fp_controller*, std::uint32_t* out) -> std::int32_t { return *out = FP_IDLE, FP_OK; };
    table.now_ns = [](fp_controller*) -> std::int64_t { return 0; };
    table.set_timer = [](fp_controller*, std::uint32_t, std::int64_t) -> std::int32_t { return FP_OK; };
    table.random = [](fp_controller*, std::uint32_t, std::uint64_t) -> std::uint64_t { return 0; };
    table.sometimes = [](fp_controller* c, const char* name) -> std::int32_t {
      return of(c).probes.insert(name), FP_OK;
    };
    table.works_on = [](fp_controller*, std::uint32_t, std::uint32_t) -> std::int32_t { return FP_OK; };
    table.declare_waiting = [](fp_controller*, std::uint32_t, std::uint32_t) -> std::int32_t { return FP_OK; };
    table.get_load = [](fp_controller*, std::uint32_t* out) -> std::int32_t { return *out = FP_NONE, FP_OK; };
    table.describe = [](fp_controller*, const char*) {};
    table.describe_message = [](fp_controller*, const fp_message_fields*) {};
    table.declare_state = [](fp_controller* c, const char* text) { of(c).state = text; };
    table.keep = keep;
    table.recall = recall;
    return table;
  }

  std::pair<std::uint32_t, Bytes> in_hand;
};

}  // namespace fleetproof::agents::testing
