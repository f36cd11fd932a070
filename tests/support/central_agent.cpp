// A central fleet in one program. The server lets each AGV go that asks; from then on that AGV is `reckless`.
// Parameters of the server: "deaf" answers nobody, "late" answers a second later. It keeps on its disk how often it was
// asked, and it knows the fault "deaf": it answers nobody while that lasts.
#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/agents/agents.h"
#include "core/sdk/fleetproof/agent.h"

namespace {

constexpr uint32_t kAskAgain = 0xffff, kAnswer = 0xfffe;
constexpr uint32_t kAsked = 7;  // the number of a record
constexpr int64_t kSecond_ns = 1'000'000'000;
constexpr std::string_view kAsk = "ASK", kGo = "GO";

struct Agent {
  const fp_host* host;
  fp_controller* controller;
  const fp_briefing* briefing;
  const fp_agent_type* driver = nullptr;  // of an AGV
  void* driving = nullptr;                // once it may go
  std::vector<fp_event> waiting;          // orders that came before
  std::vector<uint32_t> to_answer;        // of the server
  uint32_t asked = 0;                     // the same: so often, also before its restarts
  int64_t deaf_until_ns = 0;              // the same
};

const fp_agent_type* reckless() {
  for (uint32_t i = 0; const fp_agent_type* type = fp_reference_agent(i); ++i) {
    if (std::string_view(type->name) == "reckless") return type;
  }
  return nullptr;
}

void ask(Agent& self, int64_t now_ns) {
  for (uint32_t i = 0; i < self.briefing->computer_count; ++i)
    self.host->send_unicast(self.controller, kAsk.data(), kAsk.size(), self.briefing->fleet_count + i);
  self.host->set_timer(self.controller, kAskAgain, now_ns + kSecond_ns);
}

void go(Agent& self, int64_t now_ns) {
  self.host->set_timer(self.controller, kAskAgain, -1);
  self.driving = self.driver->create(self.host, self.controller, self.briefing);
  fp_event start{};
  start.struct_size = sizeof start;
  start.kind = FP_EVENT_START;
  start.now_ns = now_ns;
  self.driver->on_event(self.driving, &start);
  for (const fp_event& order : self.waiting) self.driver->on_event(self.driving, &order);
  self.waiting.clear();
}

void on_board(Agent& self, const fp_event& event) {
  if (event.kind == FP_EVENT_START) return ask(self, event.now_ns);
  if (event.kind == FP_EVENT_TIMER && event.timer == kAskAgain) return ask(self, event.now_ns);
  if (event.kind == FP_EVENT_MESSAGE) {
    fp_message message{};
    message.struct_size = sizeof message;
    while (self.host->get_message(self.controller, &message) == FP_OK) {
      const std::string_view words(static_cast<const char*>(message.bytes), message.size);
      if (words == kGo && self.driving == nullptr) go(self, event.now_ns);
    }
  } else if (self.driving != nullptr) {
    self.driver->on_event(self.driving, &event);
  } else if (event.kind == FP_EVENT_ORDER) {
    self.waiting.push_back(event);
  }
}

void let_go(Agent& self, uint32_t agv) {
  self.host->describe(self.controller, "GO: you may drive");
  self.host->send_unicast(self.controller, kGo.data(), kGo.size(), agv);
}

void remember(Agent& self) {
  fp_record record{};
  record.struct_size = sizeof record;
  if (self.briefing->boot == 0) return;
  if (self.host->recall(self.controller, kAsked, &record) == FP_OK && record.size == sizeof self.asked) {
    std::memcpy(&self.asked, record.bytes, sizeof self.asked);
    self.host->sometimes(self.controller, "remembered");
  } else {
    self.host->sometimes(self.controller, "remembered nothing");
  }
}

void on_server(Agent& self, const fp_event& event) {
  const std::string_view config = self.briefing->config;
  if (event.kind == FP_EVENT_START) remember(self);
  if (event.kind == FP_EVENT_FAULT) {
    self.deaf_until_ns = event.now_ns + event.fault_length_ns;
    self.host->sometimes(self.controller, event.fault_number == 1 ? "deaf once" : "deaf otherwise");
  }
  if (event.kind == FP_EVENT_TIMER) {
    for (const uint32_t agv : self.to_answer) let_go(self, agv);
    self.to_answer.clear();
  }
  fp_message message{};
  message.struct_size = sizeof message;
  while (event.kind == FP_EVENT_MESSAGE && self.host->get_message(self.controller, &message) == FP_OK) {
    if (config == "deaf" || event.now_ns < self.deaf_until_ns) continue;
    self.host->sometimes(self.controller, "asked");
    ++self.asked;
    self.host->keep(self.controller, kAsked, &self.asked, sizeof self.asked);
    if (config == "late") {
      self.to_answer.push_back(message.sender);
      self.host->set_timer(self.controller, kAnswer, event.now_ns + kSecond_ns);
    } else {
      let_go(self, message.sender);
    }
  }
}

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  auto* self = new Agent{};
  self->host = host, self->controller = controller, self->briefing = briefing;
  if (briefing->role == FP_AGV) self->driver = reckless();
  return self;
}

void on_event(void* agent, const fp_event* event) {
  Agent& self = *static_cast<Agent*>(agent);
  self.briefing->role == FP_COMPUTER ? on_server(self, *event) : on_board(self, *event);
}

void destroy(void* agent) {
  const auto* self = static_cast<Agent*>(agent);
  if (self->driving != nullptr) self->driver->destroy(self->driving);
  delete self;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type type{
      sizeof(fp_agent_type),
      FP_ABI_MAJOR,
      FP_ABI_MINOR,
      FP_DETERMINISTIC | FP_SERVES_COMPUTERS,
      "central",
      "a server that lets reckless AGVs go",
      create,
      on_event,
      destroy,
      [](const char* word) -> uint32_t { return std::string_view(word) == "deaf" ? 1 : 0; }};
  return &type;
}
