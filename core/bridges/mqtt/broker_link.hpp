// A client of the broker over a stream that is opened again whenever it breaks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/agents/controller.hpp"
#include "core/bridges/mqtt/client.hpp"
#include "core/bridges/stream/stream_ends.hpp"

namespace fleetproof::mqtt {

class BrokerLink {
 public:
  // `will`: for each connection anew; none: it has no last will. Requires: the controller outlives it.
  BrokerLink(agents::Controller& controller, const fp_briefing& briefing, ClientSettings settings,
             std::function<Will()> will = {});
  BrokerLink(const BrokerLink&) = delete;
  BrokerLink& operator=(const BrokerLink&) = delete;

  // What has happened since the last call, in order: it was lost, it was made, messages came.
  struct News {
    bool was_lost = false, was_made = false;
    std::vector<Publish> messages{};
  };
  // Once in each activation: takes the inbox, and connects if need be.
  News take_news();
  bool is_connected() const { return client_.is_connected(); }
  void publish(Publish message, std::string_view text) {
    client_.publish(std::move(message), text, controller_.now_ns());
  }
  // Sends all that is due. At the end of each activation.
  void flush() { streams_.flush(); }
  // When the next activation has to be at the latest.
  std::int64_t deadline_ns() const;

 private:
  void learn(const stream::StreamNews& news);

  agents::Controller& controller_;
  const std::uint32_t broker_;
  stream::Streams streams_;
  Client client_;
  std::function<Will()> will_;
  stream::StreamNumber stream_ = 0;
  std::int64_t connect_from_ns_ = 0;
};

}  // namespace fleetproof::mqtt
