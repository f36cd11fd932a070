// A central fleet in one program. The server lets each AGV go that asks; from then on that AGV is `reckless`. If the
// transports are open, the server gives each free AGV the oldest one that nobody has, and declares so.
// Parameters of the server: "deaf" answers nobody, "late" answers a second later. It keeps on its disk how often it was
// asked, and it knows the fault "deaf": it answers nobody while that lasts.
#include <algorithm>
#include <cstring>
#include <map>
#include <string_view>
#include <vector>

#include "core/agents/agents.h"
#include "core/sdk/fleetproof/agent.h"

namespace {

constexpr uint32_t kAskAgain = 0xffff, kAnswer = 0xfffe;
constexpr uint32_t kAsked = 7;  // the number of a record
constexpr int64_t kSecond_ns = 1'000'000'000;
constexpr std::string_view kAsk = "ASK", kGo = "GO";

struct Order {
  uint32_t id = FP_NONE, from = 0, to = 0;
};

// An AGV reports once a second. An order is its answer.
enum class Report : uint32_t { Free, Busy, Delivered, Missed };
struct State {
  Report report = Report::Free;
  uint32_t order = FP_NONE;  // that it has, or has had last
};

struct Agent {
  const fp_host* host = nullptr;
  fp_controller* controller = nullptr;
  const fp_briefing* briefing = nullptr;
  const fp_agent_type* driver = nullptr;  // of an AGV
  void* driving = nullptr;                // once it may go
  std::vector<fp_event> waiting;          // orders that came before
  std::vector<uint32_t> to_answer;        // of the server
  uint32_t asked = 0;                     // the same: so often, also before its restarts
  int64_t deaf_until_ns = 0;              // the same
  // With open transports: what an AGV does; what the server knows of orders, and who has which.
  State state;
  bool has_loaded = false;
  std::vector<Order> orders;  // oldest first
  std::map<uint32_t, uint32_t> order_of;
  std::vector<uint32_t> withdrawn;
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

template <class Content>
void send(Agent& self, const Content& content, uint32_t receiver) {
  self.host->send_unicast(self.controller, &content, sizeof content, receiver);
}

template <class Content>
Content content_of(const fp_message& message) {
  Content content;
  if (message.size == sizeof content) std::memcpy(&content, message.bytes, sizeof content);
  return content;
}

// ---- an AGV, with open transports: `reckless` carries out one at a time

void report(Agent& self, int64_t now_ns) {
  send(self, self.state, self.briefing->fleet_count);
  self.host->set_timer(self.controller, kAskAgain, now_ns + kSecond_ns);
}

void take(Agent& self, const Order& order, int64_t now_ns) {
  const bool is_new = order.id != FP_NONE && order.id != self.state.order;
  if (self.state.report == Report::Busy || !is_new) return;
  self.state = {Report::Busy, order.id};
  self.has_loaded = false;
  fp_event event{};
  event.struct_size = sizeof event;
  event.kind = FP_EVENT_ORDER;
  event.now_ns = now_ns;
  event.order_id = order.id, event.from = order.from, event.to = order.to;
  self.driver->on_event(self.driving, &event);
}

void action_done(Agent& self, const fp_event& event) {
  uint32_t on_board = FP_NONE, action = FP_DRIVING;
  self.host->get_load(self.controller, &on_board);
  self.has_loaded = self.has_loaded || on_board == self.state.order;
  self.driver->on_event(self.driving, &event);
  self.host->get_action(self.controller, &action);
  if (self.state.report == Report::Busy && action == FP_IDLE)
    self.state.report = self.has_loaded && on_board == FP_NONE ? Report::Delivered : Report::Missed;
}

void on_board_with_open_orders(Agent& self, const fp_event& event) {
  if (event.kind == FP_EVENT_START) go(self, event.now_ns);
  if (event.kind == FP_EVENT_START || event.kind == FP_EVENT_TIMER) return report(self, event.now_ns);
  if (event.kind == FP_EVENT_ACTION_DONE) return action_done(self, event);
  fp_message message{};
  message.struct_size = sizeof message;
  while (event.kind == FP_EVENT_MESSAGE && self.host->get_message(self.controller, &message) == FP_OK)
    take(self, content_of<Order>(message), event.now_ns);
}

// ---- the server, with open transports

Order order_with(const Agent& self, uint32_t id) {
  const auto found = std::find_if(self.orders.begin(), self.orders.end(), [&](const Order& o) { return o.id == id; });
  return found == self.orders.end() ? Order() : *found;
}

bool has_no_agv(const Agent& self, const Order& order) {
  return std::none_of(self.order_of.begin(), self.order_of.end(),
                      [&](const auto& has) { return has.second == order.id; });
}

void forget(Agent& self, uint32_t id) {
  std::erase_if(self.orders, [&](const Order& order) { return order.id == id; });
}

// The AGV is free: it gets what it has been given before, or else the oldest order that no AGV has.
void give_order(Agent& self, uint32_t agv) {
  if (order_with(self, self.order_of[agv]).id == FP_NONE) self.order_of[agv] = FP_NONE;
  for (const Order& order : self.orders) {
    if (self.order_of[agv] == FP_NONE && has_no_agv(self, order)) self.order_of[agv] = order.id;
  }
  self.host->works_on(self.controller, agv, self.order_of[agv]);
  if (self.order_of[agv] != FP_NONE) send(self, order_with(self, self.order_of[agv]), agv);
}

void take_report(Agent& self, uint32_t agv, const State& state) {
  uint32_t& order = self.order_of.try_emplace(agv, FP_NONE).first->second;
  if (state.report == Report::Busy) return void(order = state.order);
  const bool was_withdrawn = std::count(self.withdrawn.begin(), self.withdrawn.end(), state.order) > 0;
  if (state.report == Report::Delivered || (state.report == Report::Missed && was_withdrawn)) forget(self, state.order);
  if (order == state.order) order = FP_NONE;  // delivered, or to be given to another one
  give_order(self, agv);
}

void on_server_with_open_orders(Agent& self, const fp_event& event) {
  if (event.kind == FP_EVENT_ORDER) self.orders.push_back({event.order_id, event.from, event.to});
  if (event.kind == FP_EVENT_WITHDRAWN) {
    self.withdrawn.push_back(event.order_id);  // the AGV that has it, if there is one, may have its load on board
    if (has_no_agv(self, order_with(self, event.order_id))) forget(self, event.order_id);
  }
  fp_message message{};
  message.struct_size = sizeof message;
  while (event.kind == FP_EVENT_MESSAGE && self.host->get_message(self.controller, &message) == FP_OK) {
    if (std::string_view(self.briefing->config) != "deaf")
      take_report(self, message.sender, content_of<State>(message));
  }
}

// ---- assigned transports

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
  const bool is_server = self.briefing->role == FP_COMPUTER;
  if (self.briefing->orders == FP_ORDERS_OPEN)
    return is_server ? on_server_with_open_orders(self, *event) : on_board_with_open_orders(self, *event);
  is_server ? on_server(self, *event) : on_board(self, *event);
}

void destroy(void* agent) {
  const auto* self = static_cast<Agent*>(agent);
  if (self->driving != nullptr) self->driver->destroy(self->driving);
  delete self;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type type{sizeof(fp_agent_type),
                                  FP_ABI_MAJOR,
                                  FP_ABI_MINOR,
                                  FP_DETERMINISTIC | FP_SERVES_COMPUTERS,
                                  "central",
                                  "a server that lets reckless AGVs go",
                                  create,
                                  on_event,
                                  destroy,
                                  [](const char* word) -> uint32_t { return std::string_view(word) == "deaf" ? 1 : 0; },
                                  nullptr};
  return &type;
}
