#include "core/bridges/mqtt/broker.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>
#include <vector>

#include "core/bridges/mqtt/topics.hpp"

namespace fleetproof::mqtt {
namespace {

constexpr std::uint8_t kMostQos = 1;
constexpr std::string_view kSaved = "fleetproof mqtt 1\n";

}  // namespace

void Broker::opened(std::uint32_t connection, std::int64_t now_ns) {
  links_.insert_or_assign(connection, Link{.reader = PacketReader(settings_.most_packet_bytes), .heard_ns = now_ns});
}

void Broker::received(std::uint32_t connection, std::string_view bytes, std::int64_t now_ns) {
  auto link = links_.find(connection);
  if (link == links_.end()) return;
  link->second.reader.add(bytes);
  while (const auto packet = link->second.reader.next()) {
    if (link->second.is_connected) link->second.heard_ns = now_ns;  // whole packets count, bytes do not
    handle(connection, link->second, *packet, now_ns);
    link = links_.find(connection);
    if (link == links_.end()) return;
  }
  if (!link->second.reader.error().empty()) end(connection, std::string(link->second.reader.error()));
}

void Broker::lost(std::uint32_t connection) {
  if (links_.contains(connection)) end(connection, {});
}

void Broker::tick(std::int64_t now_ns) {
  std::vector<std::uint32_t> silent;
  for (const auto& [connection, link] : links_) {
    if (silent_at_ns(link).value_or(now_ns + 1) <= now_ns) silent.push_back(connection);
  }
  for (const std::uint32_t connection : silent) {
    const auto link = links_.find(connection);  // it may be gone: wills are published meanwhile
    if (link == links_.end()) continue;
    end(connection,
        link->second.is_connected ? "silent for more than its keep-alive time and a half" : "no CONNECT in time");
  }
}

std::optional<std::int64_t> Broker::deadline_ns() const {
  std::optional<std::int64_t> earliest;
  for (const auto& [connection, link] : links_) {
    const auto at = silent_at_ns(link);
    if (at && (!earliest || *at < *earliest)) earliest = at;
  }
  return earliest;
}

// One and a half times the keep-alive time: [MQTT-3.1.2-24].
std::optional<std::int64_t> Broker::silent_at_ns(const Link& link) const {
  if (!link.is_connected) return link.heard_ns + settings_.connect_within_ns;
  if (link.keep_alive_s == 0) return std::nullopt;
  return link.heard_ns + std::int64_t{link.keep_alive_s} * 1'500'000'000;
}

void Broker::handle(std::uint32_t connection, Link& link, const Packet& packet, std::int64_t now_ns) {
  if (const auto* first = std::get_if<Connect>(&packet)) return connect(connection, link, *first, now_ns);
  if (!link.is_connected) return end(connection, "its first packet is no CONNECT");  // [MQTT-3.1.0-1]
  if (const auto* one = std::get_if<Publish>(&packet)) return take(connection, *one);
  if (const auto* one = std::get_if<Puback>(&packet)) return acknowledge(link, one->id);
  if (const auto* one = std::get_if<Subscribe>(&packet)) return subscribe(connection, link, *one);
  if (const auto* one = std::get_if<Unsubscribe>(&packet)) return unsubscribe(connection, link, *one);
  if (std::holds_alternative<Pingreq>(packet)) return send(connection, Pingresp{});
  if (!std::holds_alternative<Disconnect>(packet)) return end(connection, "sends what only a server sends");
  link.will.reset();  // [MQTT-3.14.4-3]
  end(connection, "said that it goes");
}

void Broker::connect(std::uint32_t connection, Link& link, const Connect& connect, std::int64_t now_ns) {
  if (link.is_connected) return end(connection, "a second CONNECT");  // [MQTT-3.1.0-2]
  const auto refuse = [&](ConnectCode code, std::string_view why) {
    send(connection, Connack{false, code});
    end(connection, why);
  };
  if (connect.level != 4) return refuse(ConnectCode::WrongLevel, "asks for another version than MQTT 3.1.1");
  if (connect.has_user || connect.has_password)
    return refuse(ConnectCode::NotAuthorized, "has a user or a password; this broker has none");
  if (connect.client.empty() && !connect.is_clean)  // [MQTT-3.1.3-8]
    return refuse(ConnectCode::WrongClient, "has no name, and asks for a session that is kept");
  if (connect.will && (connect.will->qos > kMostQos || is_of_server(connect.will->topic)))
    return refuse(ConnectCode::NotAuthorized, "has a will with QoS 2, or to a topic of the server");
  const std::string client = connect.client.empty() ? free_name() : connect.client;
  if (!sessions_.contains(client) && sessions_.size() >= settings_.most_sessions)
    return refuse(ConnectCode::NotNow, "one session more than are possible");
  const auto former = sessions_.find(client);
  if (former != sessions_.end() && former->second.connection)  // [MQTT-3.1.4-2]
    end(*former->second.connection, "another client has connected with its name");
  if (connect.is_clean) changes_ += sessions_.erase(client);
  const bool is_present = sessions_.contains(client);
  Session& session = sessions_[client];
  changes_ += connect.is_clean || is_present ? 0 : 1;
  session.is_clean = connect.is_clean;
  session.connection = connection;
  link.client = client;
  link.is_connected = true;
  link.will = connect.will;
  link.keep_alive_s = connect.keep_alive_s;
  link.heard_ns = now_ns;
  send(connection, Connack{is_present, ConnectCode::Accepted});
  for (Publish& again : session.unacknowledged) {  // [MQTT-4.4.0-1]
    send(connection, again);
    changes_ += again.is_again ? 0 : 1;
    again.is_again = true;
  }
}

// [MQTT-3.1.3-6]
std::string Broker::free_name() {
  std::string name;
  do name = "nameless-" + std::to_string(++nameless_);
  while (sessions_.contains(name));
  return name;
}

void Broker::take(std::uint32_t connection, const Publish& publish) {
  if (publish.qos > kMostQos) return end(connection, "publishes with QoS 2, which is not offered");
  if (is_of_server(publish.topic))
    return end(connection, "publishes to a topic of the server: " + printable(publish.topic));
  if (publish.qos == 0 && to_drop_ > 0) {
    --to_drop_;
    return;
  }
  if (publish.qos == 1) send(connection, Puback{publish.id});
  if (publish.retain) retain(publish);
  route(publish);
}

// [MQTT-3.3.1-5], [MQTT-3.3.1-10]
void Broker::retain(const Publish& publish) {
  ++changes_;
  if (publish.payload.empty()) {
    retained_.erase(publish.topic);
  } else if (retained_.contains(publish.topic) || retained_.size() < settings_.most_retained) {
    retained_[publish.topic] = {publish.topic, publish.payload, publish.qos, true};
  }
}

void Broker::route(const Publish& publish) {
  for (auto& [client, session] : sessions_) {
    int qos = -1;
    for (const auto& [filter, granted] : session.subscriptions) {
      if (matches(filter, publish.topic)) qos = std::max<int>(qos, granted);
    }
    if (qos < 0) continue;
    Publish copy = publish;
    copy.qos = static_cast<std::uint8_t>(std::min<int>(qos, publish.qos));
    copy.retain = false;  // [MQTT-3.3.1-9]
    deliver(session, std::move(copy));
  }
}

void Broker::deliver(Session& session, Publish publish) {
  publish.is_again = false;
  publish.id = 0;
  if (publish.qos == 0) {
    if (session.connection) send(*session.connection, publish);
    return;
  }
  if (session.unacknowledged.size() >= settings_.most_of_session) return;
  const auto is_free = [&](std::uint16_t id) {
    return id > 0 && std::ranges::count(session.unacknowledged, id, &Publish::id) == 0;
  };
  do ++session.last_id;
  while (!is_free(session.last_id));
  publish.id = session.last_id;
  changes_ += session.is_clean ? 0 : 1;
  session.unacknowledged.push_back(publish);
  if (!session.connection) return;
  send(*session.connection, publish);
  session.unacknowledged.back().is_again = true;
}

void Broker::subscribe(std::uint32_t connection, Link& link, const Subscribe& subscribe) {
  Session& session = sessions_.at(link.client);
  Suback suback{subscribe.id, {}};
  std::vector<Filter> granted;
  for (const Filter& filter : subscribe.filters) {
    const bool is_full = session.subscriptions.size() >= settings_.most_of_session;
    if (is_of_server(filter.text) || (is_full && !session.subscriptions.contains(filter.text))) {
      suback.codes.push_back(kRefused);
      continue;
    }
    const auto qos = std::min(filter.qos, kMostQos);
    session.subscriptions[filter.text] = qos;
    changes_ += session.is_clean ? 0 : 1;
    suback.codes.push_back(qos);
    granted.push_back({filter.text, qos});
  }
  send(connection, suback);
  for (const Filter& filter : granted) {  // [MQTT-3.3.1-6], [MQTT-3.3.1-8]
    for (const auto& [topic, kept] : retained_) {
      if (!matches(filter.text, topic)) continue;
      Publish copy = kept;
      copy.qos = std::min(kept.qos, filter.qos);
      deliver(session, std::move(copy));
    }
  }
}

void Broker::unsubscribe(std::uint32_t connection, Link& link, const Unsubscribe& unsubscribe) {
  Session& session = sessions_.at(link.client);
  for (const std::string& filter : unsubscribe.filters)
    changes_ += session.subscriptions.erase(filter) > 0 && !session.is_clean ? 1 : 0;
  send(connection, Unsuback{unsubscribe.id});
}

void Broker::acknowledge(const Link& link, std::uint16_t id) {
  Session& session = sessions_.at(link.client);
  changes_ +=
      std::erase_if(session.unacknowledged, [&](const Publish& one) { return one.id == id; }) > 0 && !session.is_clean
          ? 1
          : 0;
}

void Broker::end(std::uint32_t connection, std::string_view reason) {
  const auto found = links_.find(connection);
  const Link link = std::move(found->second);
  links_.erase(found);
  if (!reason.empty()) wires_.close(connection, reason);
  if (!link.is_connected) return;
  const auto session = sessions_.find(link.client);
  session->second.connection.reset();
  if (session->second.is_clean) sessions_.erase(session);
  if (!link.will) return;
  const Publish will{link.will->topic, link.will->payload, link.will->qos, link.will->retain};
  if (will.retain) retain(will);
  route(will);
}

void Broker::send(std::uint32_t connection, const Packet& packet) {
  wires_.send(connection, encode(packet), text_of(packet));
}

void Broker::cut_all() {
  std::vector<std::uint32_t> connections;
  for (const auto& [connection, link] : links_) connections.push_back(connection);
  for (const std::uint32_t connection : connections) {
    if (links_.contains(connection)) end(connection, "cut");
  }
}

void Broker::take_over(const std::string& client) {
  const auto session = sessions_.find(client);
  if (session != sessions_.end() && session->second.connection)
    end(*session->second.connection, "another client has connected with its name");
}

std::vector<std::string> Broker::connected() const {
  std::vector<std::string> clients;
  for (const auto& [client, session] : sessions_) {
    if (session.connection) clients.push_back(client);
  }
  return clients;
}

// ---- the disk: packets, as MQTT writes them, behind a line that says how many of each there are

std::string Broker::saved() const {
  std::string packets;
  std::size_t sessions = 0;
  for (const auto& [topic, kept] : retained_) {
    Publish one = kept;
    one.id = one.qos > 0 ? 1 : 0;
    packets += encode(one);
  }
  for (const auto& [client, session] : sessions_) {
    if (session.is_clean) continue;
    ++sessions;
    packets += encode(Connect{.client = client, .is_clean = false});
    for (const auto& [filter, qos] : session.subscriptions) packets += encode(Subscribe{1, {{filter, qos}}});
    for (const Publish& one : session.unacknowledged) packets += encode(one);
    packets += encode(Pingreq{});  // the end of a session
  }
  return std::string(kSaved) + std::to_string(retained_.size()) + " " + std::to_string(sessions) + " " +
         std::to_string(packets.size()) + "\n" + packets;
}

namespace {

// The numbers of a line, which is taken from the text. Empty: it has others.
std::vector<std::size_t> take_numbers(std::string_view& text, std::size_t count) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const auto read = static_cast<std::size_t>(end - text.data());
    if (error != std::errc{} || read == text.size() || text[read] != (i + 1 == count ? '\n' : ' ')) return {};
    text.remove_prefix(read + 1);
    numbers.push_back(number);
  }
  return numbers;
}

// A message as `saved` writes it: of a QoS that is offered.
const Publish* saved_message(const std::optional<Packet>& packet) {
  const auto* message = packet ? std::get_if<Publish>(&*packet) : nullptr;
  return message != nullptr && message->qos <= kMostQos ? message : nullptr;
}

// One session, up to its end. Session: that of the broker, which is its own.
template <class Session>
bool read_session(PacketReader& reader, std::map<std::string, Session>& sessions) {
  const auto first = reader.next();
  const auto* client = first ? std::get_if<Connect>(&*first) : nullptr;
  if (client == nullptr) return false;
  Session& session = sessions[client->client];
  session.is_clean = false;
  for (auto packet = reader.next(); packet; packet = reader.next()) {
    if (std::holds_alternative<Pingreq>(*packet)) return true;
    if (const auto* one = std::get_if<Subscribe>(&*packet)) {
      if (one->filters.front().qos > kMostQos) return false;
      session.subscriptions[one->filters.front().text] = one->filters.front().qos;
    } else if (const Publish* kept = saved_message(packet)) {
      session.unacknowledged.push_back(*kept);
      session.last_id = kept->id;
    } else {
      return false;
    }
  }
  return false;  // its end is missing
}

}  // namespace

bool Broker::restore(std::string_view text) {
  if (!text.starts_with(kSaved)) return false;
  text.remove_prefix(kSaved.size());
  const auto numbers = take_numbers(text, 3);
  if (numbers.empty() || numbers[2] != text.size()) return false;
  PacketReader reader(settings_.most_packet_bytes);
  reader.add(text);
  std::map<std::string, Publish> retained;
  std::map<std::string, Session> sessions;
  for (std::size_t i = 0; i < numbers[0]; ++i) {
    const auto packet = reader.next();
    const Publish* kept = saved_message(packet);
    if (kept == nullptr) return false;
    retained[kept->topic] = *kept;
  }
  for (std::size_t i = 0; i < numbers[1]; ++i) {
    if (!read_session(reader, sessions)) return false;
  }
  if (reader.left() > 0) return false;
  retained_ = std::move(retained);
  sessions_ = std::move(sessions);
  return true;
}

}  // namespace fleetproof::mqtt
