#include "core/bridges/mqtt/client.hpp"

#include <algorithm>

namespace fleetproof::mqtt {

void Client::opened(std::int64_t now_ns) {
  state_ = State::Connecting;
  reader_ = PacketReader();
  answer_by_ns_ = now_ns + settings_.patience_ns;
  send(Connect{4, settings_.name, settings_.is_clean, settings_.keep_alive_s, settings_.will}, now_ns);
}

void Client::received(std::string_view bytes, std::int64_t now_ns) {
  if (state_ == State::Away) return;
  reader_.add(bytes);
  while (state_ != State::Away) {
    const auto packet = reader_.next();
    if (!packet) break;
    handle(*packet, now_ns);
  }
  if (state_ != State::Away && !reader_.error().empty()) end(reader_.error());
}

void Client::handle(const Packet& packet, std::int64_t now_ns) {
  if (const auto* connack = std::get_if<Connack>(&packet)) return welcome(*connack, now_ns);
  if (state_ == State::Connecting) return end("the broker says something before CONNACK");
  if (const auto* publish = std::get_if<Publish>(&packet)) {
    if (publish->qos > 1) return end("the broker sends a message at QoS 2");
    if (publish->qos == 1) send(Puback{publish->id}, now_ns);
    messages_.push_back(*publish);
  } else if (const auto* puback = std::get_if<Puback>(&packet)) {
    std::erase_if(unacknowledged_, [&](const Unacknowledged& one) { return one.publish.id == puback->id; });
  } else if (std::holds_alternative<Pingresp>(packet)) {
    answer_by_ns_.reset();
  } else if (!std::holds_alternative<Suback>(packet) && !std::holds_alternative<Unsuback>(packet)) {
    end("the broker sends what only a client sends");
  }
}

void Client::welcome(const Connack& connack, std::int64_t now_ns) {
  if (state_ == State::Connected) return end("the broker says CONNACK twice");
  if (connack.code != ConnectCode::Accepted)
    return end("the broker refuses: code " + std::to_string(static_cast<unsigned>(connack.code)));
  state_ = State::Connected;
  has_connected_ = true;
  answer_by_ns_.reset();
  if (!settings_.filters.empty()) send(Subscribe{next_id(), settings_.filters}, now_ns);
  for (Unacknowledged& one : unacknowledged_) {
    send(one.publish, now_ns, one.text);
    one.publish.is_again = true;
  }
}

void Client::publish(Publish publish, std::string_view text, std::int64_t now_ns) {
  if (publish.qos == 0) {
    if (is_connected()) send(publish, now_ns, text);
    return;
  }
  publish.id = next_id();
  publish.is_again = false;
  unacknowledged_.push_back({std::move(publish), std::string(text)});
  if (!is_connected()) return;
  send(unacknowledged_.back().publish, now_ns, text);
  unacknowledged_.back().publish.is_again = true;
}

std::uint16_t Client::next_id() {
  const auto is_free = [&](std::uint16_t id) {
    return id > 0 && std::ranges::none_of(unacknowledged_, [&](const auto& one) { return one.publish.id == id; });
  };
  do ++last_id_;
  while (!is_free(last_id_));
  return last_id_;
}

void Client::lost() {
  state_ = State::Away;
  answer_by_ns_.reset();
}

void Client::tick(std::int64_t now_ns) {
  if (answer_by_ns_ && now_ns >= *answer_by_ns_)
    return end(state_ == State::Connecting ? "no CONNACK" : "no answer to PINGREQ");
  const std::int64_t pause_ns = std::int64_t{settings_.keep_alive_s} * 1'000'000'000;
  if (!is_connected() || pause_ns == 0 || answer_by_ns_ || now_ns - sent_ns_ < pause_ns) return;
  send(Pingreq{}, now_ns);
  answer_by_ns_ = now_ns + settings_.patience_ns;
}

std::optional<std::int64_t> Client::deadline_ns() const {
  if (answer_by_ns_ || !is_connected() || settings_.keep_alive_s == 0) return answer_by_ns_;
  return sent_ns_ + std::int64_t{settings_.keep_alive_s} * 1'000'000'000;
}

void Client::send(const Packet& packet, std::int64_t now_ns, std::string_view text) {
  sent_ns_ = now_ns;
  wire_.send(encode(packet), text.empty() ? text_of(packet) : std::string(text));
}

void Client::end(std::string_view reason) {
  lost();
  wire_.close(reason);
}

}  // namespace fleetproof::mqtt
