#include "core/bridges/mqtt/broker_link.hpp"

#include <algorithm>
#include <utility>

#include "core/bridges/mqtt/mqtt_broker.hpp"

namespace fleetproof::mqtt {
namespace {

constexpr std::int64_t kReconnect_ns = 2'000'000'000;

}  // namespace

BrokerLink::BrokerLink(agents::Controller& controller, const fp_briefing& briefing, ClientSettings settings,
                       std::function<Will()> will)
    : controller_(controller),
      broker_(broker_of(briefing)),
      streams_(controller, briefing.self, briefing.boot),
      client_({[this](std::string_view bytes, std::string_view text) {
                 (void)streams_.send(stream_, std::as_bytes(std::span(bytes)), text);
               },
               [this](std::string_view) { streams_.close(std::exchange(stream_, 0)); }},
              std::move(settings)),
      will_(std::move(will)) {}

BrokerLink::News BrokerLink::take_news() {
  News told;
  const std::int64_t now_ns = controller_.now_ns();
  const bool was_connected = is_connected();
  controller_.drain_inbox(
      [&](std::uint32_t sender, std::span<const std::byte> bytes) { streams_.hear(sender, bytes); });
  client_.tick(now_ns);
  for (auto news = streams_.take_news(); !news.empty(); news = streams_.take_news()) {
    for (const stream::StreamNews& one : news) learn(one);
  }
  told.was_made = client_.take_connected();
  told.was_lost = was_connected && (told.was_made || !is_connected());
  told.messages = client_.take_messages();
  if (stream_ == 0 && now_ns >= connect_from_ns_) {
    connect_from_ns_ = now_ns + kReconnect_ns;
    stream_ = streams_.connect(broker_, kPort);
  }
  return told;
}

void BrokerLink::learn(const stream::StreamNews& news) {
  using Kind = stream::StreamEvent::Kind;
  if (news.stream != stream_) return;
  const std::int64_t now_ns = controller_.now_ns();
  if (news.event.kind == Kind::Opened) {
    if (will_) client_.set_will(will_());
    client_.opened(now_ns);
  } else if (news.event.kind == Kind::Received) {
    const auto& bytes = news.event.bytes;
    client_.received({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, now_ns);
  } else {
    stream_ = 0;
    client_.lost();
  }
}

std::int64_t BrokerLink::deadline_ns() const {
  std::int64_t earliest = INT64_MAX;
  if (stream_ == 0) earliest = std::max(connect_from_ns_, controller_.now_ns() + 1);
  for (const auto deadline : {streams_.deadline_ns(), client_.deadline_ns()}) {
    if (deadline) earliest = std::min(earliest, *deadline);
  }
  return earliest;
}

}  // namespace fleetproof::mqtt
