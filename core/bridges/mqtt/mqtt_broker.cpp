#include "core/bridges/mqtt/mqtt_broker.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"
#include "core/bridges/mqtt/broker.hpp"
#include "core/bridges/stream/stream_ends.hpp"

namespace fleetproof::mqtt {
namespace {

constexpr std::uint32_t kTimer = 1, kDisk = 1;
constexpr std::string_view kMessagesDropped = "messages-dropped", kConnectionsCut = "connections-cut",
                           kNameTaken = "name-taken";

class BrokerProgram {
 public:
  BrokerProgram(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle, briefing.boot),
        streams_(controller_, briefing.self, briefing.boot),
        broker_({[this](std::uint32_t stream, std::string_view bytes, std::string_view text) {
                   (void)streams_.send(stream, std::as_bytes(std::span(bytes)), text);
                 },
                 [this](std::uint32_t stream, std::string_view) { streams_.close(stream); }}) {
    streams_.listen(kPort);
    if (briefing.boot == 0) return;
    const auto disk = controller_.recall(kDisk);
    const bool is_restored = broker_.restore({reinterpret_cast<const char*>(disk.data()), disk.size()});
    controller_.sometimes(is_restored ? "recalled" : "restarted");
  }

  void on_event(const fp_event& event) {
    controller_.set_clock(event.now_ns);
    if (event.kind == FP_EVENT_FAULT) strike(event);
    controller_.drain_inbox(
        [&](std::uint32_t sender, std::span<const std::byte> bytes) { streams_.hear(sender, bytes); });
    broker_.tick(controller_.now_ns());
    for (auto news = streams_.take_news(); !news.empty(); news = streams_.take_news()) {
      for (const stream::StreamNews& one : news) learn(one);
    }
    keep();
    streams_.flush();
    set_timer();
  }

 private:
  void learn(const stream::StreamNews& news) {
    using Kind = stream::StreamEvent::Kind;
    if (news.event.kind == Kind::Opened) broker_.opened(news.stream, controller_.now_ns());
    if (news.event.kind == Kind::Received) {
      const auto& bytes = news.event.bytes;
      broker_.received(news.stream, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, controller_.now_ns());
    }
    if (news.event.kind == Kind::Broken || news.event.kind == Kind::Closed) broker_.lost(news.stream);
  }
  void strike(const fp_event& fault) {
    const std::string_view word = fault.fault_word;
    if (word == kMessagesDropped) broker_.drop_messages(fault.fault_number);
    if (word == kConnectionsCut) broker_.cut_all();
    if (word == kNameTaken) {
      const auto clients = broker_.connected();
      if (fault.fault_number < clients.size()) broker_.take_over(clients[fault.fault_number]);
    }
  }
  // Before anything is sent that depends on it.
  void keep() {
    if (std::exchange(kept_, broker_.changes()) == broker_.changes()) return;
    const std::string disk = broker_.saved();
    controller_.keep(kDisk, std::as_bytes(std::span(disk)));
  }
  void set_timer() {
    std::int64_t earliest = INT64_MAX;
    for (const auto deadline : {streams_.deadline_ns(), broker_.deadline_ns()}) {
      if (deadline) earliest = std::min(earliest, *deadline);
    }
    if (earliest != INT64_MAX) controller_.set_timer(kTimer, earliest);
  }

  agents::Controller controller_;
  stream::Streams streams_;
  Broker broker_;
  std::uint64_t kept_ = 0;  // changes that are on the disk
};

fp_agent_type broker_type() {
  fp_agent_type type = agents::agent_type<BrokerProgram>(
      "mqtt-broker", "an MQTT 3.1.1 broker, reached by streams",
      [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
        if (briefing->role != FP_COMPUTER) {
          agents::cannot_start(*host, controller, "mqtt-broker runs on a computer, and not on board");
          return nullptr;
        }
        return new BrokerProgram(*host, controller, *briefing);
      });
  type.flags |= FP_SERVES_COMPUTERS;
  type.knows_fault = [](const char* word) -> std::uint32_t {
    const std::string_view known = word;
    return known == kMessagesDropped || known == kConnectionsCut || known == kNameTaken ? 1 : 0;
  };
  return type;
}

}  // namespace

const fp_agent_type kMqttBroker = broker_type();

std::uint32_t broker_of(const fp_briefing& briefing) {
  for (std::uint32_t i = 0; i < briefing.computer_count; ++i) {
    const auto* row = reinterpret_cast<const char*>(briefing.computers) + std::size_t{i} * briefing.computer_stride;
    if (std::string_view(reinterpret_cast<const fp_computer*>(row)->name) == "broker") return briefing.fleet_count + i;
  }
  return briefing.fleet_count;
}

}  // namespace fleetproof::mqtt
