// An agent that says and does what its parameters list, whatever it hears. A call is "AGV MILLISECOND WHAT ARGUMENT",
// calls are separated by ";": `all KIND` and `to0 KIND` send a message of a kind to all or to AGV 0, `plain TEXT`
// sends to all what it does not describe, with a number in front, `say WORD` declares a state, `move SEGMENT` drives
// the segment of that number.
#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

struct Call {
  std::int64_t at_ns = 0;
  std::string what, argument;
};

struct Talker {
  const fp_host* host = nullptr;
  fp_controller* controller = nullptr;
  std::vector<Call> calls;
  std::size_t next = 0;

  void play(const Call& call) const {
    if (call.what == "say") return host->declare_state(controller, call.argument.c_str());
    if (call.what == "move") {
      host->move(controller, static_cast<std::uint32_t>(std::stoul(call.argument)));
      return;
    }
    if (call.what == "plain") {
      const auto number = static_cast<std::uint32_t>(next);
      std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
      bytes += call.argument;
      host->send_broadcast(controller, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      return;
    }
    host->describe(controller, call.argument.c_str());
    const std::string bytes = call.argument + " " + std::to_string(next);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    if (call.what == "all") {
      host->send_broadcast(controller, bytes.data(), size);
    } else {
      host->send_unicast(controller, bytes.data(), size, static_cast<std::uint32_t>(std::stoul(call.what.substr(2))));
    }
  }
};

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  auto* talker = new Talker{host, controller, {}};
  std::istringstream list(briefing->config);
  for (std::string text; std::getline(list, text, ';');) {
    std::istringstream words(text);
    std::uint32_t agv = 0;
    std::int64_t at_ms = 0;
    Call call;
    words >> agv >> at_ms >> call.what >> call.argument;
    call.at_ns = at_ms * kMillisecond_ns;
    if (agv == briefing->self) talker->calls.push_back(call);
  }
  return talker;
}

void on_event(void* agent, const fp_event* event) {
  auto& self = *static_cast<Talker*>(agent);
  if (event->kind == FP_EVENT_MESSAGE) {
    fp_message message{};
    message.struct_size = sizeof message;
    while (self.host->get_message(self.controller, &message) == FP_OK) {
    }
  }
  while (self.next < self.calls.size() && self.calls[self.next].at_ns <= event->now_ns) {
    self.play(self.calls[self.next]);
    ++self.next;
  }
  if (self.next < self.calls.size()) self.host->set_timer(self.controller, 0, self.calls[self.next].at_ns);
}

void destroy(void* agent) { delete static_cast<Talker*>(agent); }

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.abi_minor = FP_ABI_MINOR;
  type.flags = FP_DETERMINISTIC;
  type.name = "talker";
  type.description = "says and does what its parameters list";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
