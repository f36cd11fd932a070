#include "core/bridges/mqtt/packets.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/bridges/mqtt/topics.hpp"

namespace fleetproof::mqtt {
namespace {

enum Type : std::uint8_t {
  kConnect = 1,
  kConnack,
  kPublish,
  kPuback,
  kPubrec,
  kPubrel,
  kPubcomp,
  kSubscribe,
  kSuback,
  kUnsubscribe,
  kUnsuback,
  kPingreq,
  kPingresp,
  kDisconnect
};
constexpr std::uint8_t kAsk = 2;  // the flags of SUBSCRIBE and UNSUBSCRIBE
constexpr std::string_view kMqtt = "MQTT";

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
// clang 14 needs it.
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

// ---- writing

void put_number(std::string& bytes, std::size_t number) {
  bytes += static_cast<char>(number >> 8U);
  bytes += static_cast<char>(number & 0xffU);
}
void put_text(std::string& bytes, std::string_view text) {
  put_number(bytes, text.size());
  bytes += text;
}

std::string framed(Type type, std::uint8_t flags, std::string_view body) {
  std::string packet(1, static_cast<char>(type << 4U | flags));
  std::size_t left = body.size();
  do {
    const std::size_t part = left % 128;
    left /= 128;
    packet += static_cast<char>(left > 0 ? part | 0x80U : part);
  } while (left > 0);
  return packet.append(body);
}
std::string framed(Type type, std::uint16_t id) {
  std::string body;
  put_number(body, id);
  return framed(type, 0, body);
}

std::string encoded(const Connect& connect) {
  std::string body;
  put_text(body, kMqtt);
  body += static_cast<char>(connect.level);
  std::uint8_t flags = connect.is_clean ? 0x02 : 0;
  if (connect.will) {
    const unsigned qos = connect.will->qos;
    flags = static_cast<std::uint8_t>(flags | 0x04U | qos << 3U | (connect.will->retain ? 0x20U : 0U));
  }
  body += static_cast<char>(flags);
  put_number(body, connect.keep_alive_s);
  put_text(body, connect.client);
  if (connect.will) {
    put_text(body, connect.will->topic);
    put_text(body, connect.will->payload);
  }
  return framed(kConnect, 0, body);
}

std::string encoded(const Publish& publish) {
  std::string body;
  put_text(body, publish.topic);
  if (publish.qos > 0) put_number(body, publish.id);
  body += publish.payload;
  const unsigned flags =
      (publish.is_again ? 8U : 0U) | static_cast<unsigned>(publish.qos) << 1U | (publish.retain ? 1U : 0U);
  return framed(kPublish, static_cast<std::uint8_t>(flags), body);
}

std::string encoded(const Subscribe& subscribe) {
  std::string body;
  put_number(body, subscribe.id);
  for (const Filter& filter : subscribe.filters) {
    put_text(body, filter.text);
    body += static_cast<char>(filter.qos);
  }
  return framed(kSubscribe, kAsk, body);
}

std::string encoded(const Suback& suback) {
  std::string body;
  put_number(body, suback.id);
  for (const std::uint8_t code : suback.codes) body += static_cast<char>(code);
  return framed(kSuback, 0, body);
}

std::string encoded(const Unsubscribe& unsubscribe) {
  std::string body;
  put_number(body, unsubscribe.id);
  for (const std::string& filter : unsubscribe.filters) put_text(body, filter);
  return framed(kUnsubscribe, kAsk, body);
}

std::string encoded(const Connack& connack) {
  return framed(kConnack, 0, std::string{connack.session_present ? '\1' : '\0', static_cast<char>(connack.code)});
}
std::string encoded(const Puback& puback) { return framed(kPuback, puback.id); }
std::string encoded(const Unsuback& unsuback) { return framed(kUnsuback, unsuback.id); }
std::string encoded(const Pingreq&) { return framed(kPingreq, 0, std::string_view()); }
std::string encoded(const Pingresp&) { return framed(kPingresp, 0, std::string_view()); }
std::string encoded(const Disconnect&) { return framed(kDisconnect, 0, std::string_view()); }

// ---- reading

// The body of one packet. Once something is missing or wrong, it reads zeros, and `trouble` says what.
class Body {
 public:
  explicit Body(std::string_view rest) : rest_(rest) {}

  std::uint8_t byte() {
    if (rest_.empty()) refuse("ends too early");
    const auto value = rest_.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(rest_.empty() ? 0 : 1);
    return value;
  }
  std::uint16_t number() {
    const std::uint8_t high = byte();
    return static_cast<std::uint16_t>(high << 8U | byte());
  }
  // [MQTT-2.3.1-1]
  std::uint16_t id() {
    const std::uint16_t id = number();
    if (id == 0) refuse("has packet identifier 0");
    return id;
  }
  std::string bytes() {
    const std::uint16_t size = number();
    if (rest_.size() < size) refuse("ends too early");
    std::string value(rest_.substr(0, size));
    rest_.remove_prefix(value.size());
    return value;
  }
  // [MQTT-1.5.3-1], [MQTT-1.5.3-2]
  std::string text() {
    std::string value = bytes();
    if (!is_mqtt_text(value)) refuse("has a text that is no UTF-8, or has U+0000 in it");
    return value;
  }
  std::string topic() {
    std::string value = text();
    if (!is_topic(value)) refuse("has a topic that is empty or has a wildcard in it");
    return value;
  }
  std::string filter() {
    std::string value = text();
    if (!is_filter(value)) refuse("has a topic filter that is empty, or has a wildcard where none may be");
    return value;
  }
  std::string all() { return std::string(std::exchange(rest_, {})); }
  bool is_at_end() const { return rest_.empty() || !trouble_.empty(); }
  void refuse(std::string_view why) {
    if (trouble_.empty()) trouble_ = why;
  }
  const std::string& trouble() {
    if (!rest_.empty()) refuse("has bytes behind its end");
    return trouble_;
  }

 private:
  std::string_view rest_;
  std::string trouble_;
};

Connect read_connect(Body& body) {
  Connect connect;
  // Of another protocol, nothing behind the level is known.
  const std::string protocol = body.bytes();
  if (protocol != kMqtt) body.refuse("asks for the protocol \"" + printable(protocol) + "\"; this is MQTT 3.1.1");
  connect.level = body.byte();
  if (connect.level != 4) {
    (void)body.all();
    return connect;
  }
  const std::uint8_t flags = body.byte();
  if ((flags & 1U) != 0) body.refuse("has its reserved flag set");  // [MQTT-3.1.2-3]
  connect.is_clean = (flags & 2U) != 0;
  connect.has_user = (flags & 0x80U) != 0;
  connect.has_password = (flags & 0x40U) != 0;
  const bool has_will = (flags & 4U) != 0;
  const auto will_qos = static_cast<std::uint8_t>(flags >> 3U & 3U);
  if (will_qos > (has_will ? 2 : 0)) body.refuse("has a wrong QoS of its will");  // [MQTT-3.1.2-13], [MQTT-3.1.2-14]
  if (!has_will && (flags & 0x20U) != 0) body.refuse("retains a will that it does not have");   // [MQTT-3.1.2-15]
  if (connect.has_password && !connect.has_user) body.refuse("has a password without a user");  // [MQTT-3.1.2-22]
  connect.keep_alive_s = body.number();
  connect.client = body.text();
  if (has_will) {
    Will& will = connect.will.emplace();
    will.topic = body.topic();
    will.payload = body.bytes();
    will.qos = will_qos;
    will.retain = (flags & 0x20U) != 0;
  }
  if (connect.has_user) (void)body.text();
  if (connect.has_password) (void)body.bytes();
  return connect;
}

Connack read_connack(Body& body) {
  const std::uint8_t flags = body.byte(), code = body.byte();
  if (flags > 1) body.refuse("has reserved flags set");
  if (code > static_cast<std::uint8_t>(ConnectCode::NotAuthorized)) body.refuse("has an unknown return code");
  if (flags == 1 && code > 0) body.refuse("refuses and has a session");  // [MQTT-3.2.2-4]
  return {flags == 1, static_cast<ConnectCode>(code)};
}

Publish read_publish(Body& body, std::uint8_t flags) {
  Publish publish;
  publish.is_again = (flags & 8U) != 0;
  publish.qos = static_cast<std::uint8_t>(flags >> 1U & 3U);
  publish.retain = (flags & 1U) != 0;
  if (publish.qos == 3) body.refuse("has QoS 3");                                       // [MQTT-3.3.1-4]
  if (publish.qos == 0 && publish.is_again) body.refuse("repeats a message of QoS 0");  // [MQTT-3.3.1-2]
  publish.topic = body.topic();
  if (publish.qos > 0) publish.id = body.id();
  publish.payload = body.all();
  return publish;
}

Subscribe read_subscribe(Body& body) {
  Subscribe subscribe;
  subscribe.id = body.id();
  do {  // at least one: [MQTT-3.8.3-3]
    std::string filter = body.filter();
    const std::uint8_t qos = body.byte();
    if (qos > 2) body.refuse("asks for a QoS above 2");  // [MQTT-3-8.3-4]
    subscribe.filters.push_back({std::move(filter), qos});
  } while (!body.is_at_end());
  return subscribe;
}

Suback read_suback(Body& body) {
  Suback suback;
  suback.id = body.id();
  do {
    suback.codes.push_back(body.byte());
    if (suback.codes.back() > 2 && suback.codes.back() != kRefused) body.refuse("has an unknown return code");
  } while (!body.is_at_end());
  return suback;
}

Unsubscribe read_unsubscribe(Body& body) {
  Unsubscribe unsubscribe;
  unsubscribe.id = body.id();
  do unsubscribe.filters.push_back(body.filter());  // at least one: [MQTT-3.10.3-2]
  while (!body.is_at_end());
  return unsubscribe;
}

const char* packet_name(std::uint8_t type) {
  constexpr const char* kNames[] = {"a packet of type 0",
                                    "CONNECT",
                                    "CONNACK",
                                    "PUBLISH",
                                    "PUBACK",
                                    "PUBREC",
                                    "PUBREL",
                                    "PUBCOMP",
                                    "SUBSCRIBE",
                                    "SUBACK",
                                    "UNSUBSCRIBE",
                                    "UNSUBACK",
                                    "PINGREQ",
                                    "PINGRESP",
                                    "DISCONNECT",
                                    "a packet of type 15"};
  return kNames[type];
}

Packet read_packet(std::uint8_t type, std::uint8_t flags, Body& body) {
  const std::uint8_t expected = type == kSubscribe || type == kUnsubscribe || type == kPubrel ? kAsk : 0;
  if (type != kPublish && flags != expected) body.refuse("has reserved flags set");  // [MQTT-2.2.2-1]
  switch (type) {
    case kConnect:
      return read_connect(body);
    case kConnack:
      return read_connack(body);
    case kPublish:
      return read_publish(body, flags);
    case kPuback:
      return Puback{body.id()};
    case kSubscribe:
      return read_subscribe(body);
    case kSuback:
      return read_suback(body);
    case kUnsubscribe:
      return read_unsubscribe(body);
    case kUnsuback:
      return Unsuback{body.id()};
    case kPingreq:
      return Pingreq{};
    case kPingresp:
      return Pingresp{};
    case kDisconnect:
      return Disconnect{};
    case kPubrec:
    case kPubrel:
    case kPubcomp:
      body.refuse("belongs to QoS 2, which is not offered");
      return Disconnect{};
    default:
      body.refuse("is none of MQTT 3.1.1");
      return Disconnect{};
  }
}

}  // namespace

std::string encode(const Packet& packet) {
  return std::visit([](const auto& one) { return encoded(one); }, packet);
}

std::string text_of(const Packet& packet) {
  const auto id = [](std::uint16_t number) { return "packet " + std::to_string(number); };
  return std::visit(
      Overloaded{[](const Connect& one) { return "CONNECT: " + printable(one.client); },
                 [](const Connack& one) {
                   const auto code = static_cast<unsigned>(one.code);
                   return std::string("CONNACK: ") +
                          (code == 0 ? "accepted" : "refused, code " + std::to_string(code)) +
                          (one.session_present ? ", session present" : "");
                 },
                 [](const Publish& one) {
                   return "PUBLISH: " + printable(one.topic) + ", QoS " + std::to_string(one.qos) +
                          (one.retain ? ", retained" : "") + (one.is_again ? ", again" : "") + ", " +
                          std::to_string(one.payload.size()) + " bytes";
                 },
                 [&](const Puback& one) { return "PUBACK: " + id(one.id); },
                 [](const Subscribe& one) {
                   return "SUBSCRIBE: " + printable(one.filters.front().text) +
                          (one.filters.size() > 1 ? " and " + std::to_string(one.filters.size() - 1) + " more" : "");
                 },
                 [&](const Suback& one) { return "SUBACK: " + id(one.id); },
                 [&](const Unsubscribe& one) { return "UNSUBSCRIBE: " + printable(one.filters.front()); },
                 [&](const Unsuback& one) { return "UNSUBACK: " + id(one.id); },
                 [](const Pingreq&) { return std::string("PINGREQ"); },
                 [](const Pingresp&) { return std::string("PINGRESP"); },
                 [](const Disconnect&) { return std::string("DISCONNECT"); }},
      packet);
}

void PacketReader::add(std::string_view bytes) {
  if (!error_.empty()) return;
  bytes_.erase(0, std::exchange(read_, 0));
  bytes_ += bytes;
}

std::optional<std::size_t> PacketReader::next_size() {
  const auto rest = std::string_view(bytes_).substr(read_);
  if (rest.empty()) return std::nullopt;
  if (is_first_ && rest.front() == '\x16') error_ = "the client speaks TLS, which is not offered";
  if (is_first_ && rest.front() == 'G') error_ = "the client speaks HTTP (WebSockets), which is not offered";
  if (!error_.empty()) return std::nullopt;
  std::size_t size = 0, place = 1;
  for (std::size_t weight = 1; place < rest.size(); weight *= 128) {
    const auto digit = static_cast<unsigned char>(rest[place++]);
    size += (digit & 0x7fU) * weight;
    if ((digit & 0x80U) == 0) {
      if (place + size > most_bytes_)
        error_ = "a packet of " + std::to_string(place + size) + " bytes; the most is " + std::to_string(most_bytes_);
      return error_.empty() ? std::optional(place + size) : std::nullopt;
    }
    if (place > 4) {
      error_ = "a length of more than four bytes";
      return std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<Packet> PacketReader::next() {
  if (!error_.empty()) return std::nullopt;
  const auto size = next_size();
  if (!size || bytes_.size() - read_ < *size) return std::nullopt;
  std::string_view packet = std::string_view(bytes_).substr(read_, *size);
  const auto first = static_cast<unsigned char>(packet.front());
  while ((static_cast<unsigned char>(packet[1]) & 0x80U) != 0) packet.remove_prefix(1);
  Body body(packet.substr(2));
  std::optional<Packet> read(read_packet(first >> 4U, first & 0xfU, body));
  if (!body.trouble().empty()) {
    error_ = std::string(packet_name(first >> 4U)) + " " + body.trouble();
    return std::nullopt;
  }
  read_ += *size;
  is_first_ = false;
  return read;
}

}  // namespace fleetproof::mqtt
