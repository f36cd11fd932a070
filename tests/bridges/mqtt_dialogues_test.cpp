// What clients of others said to our broker, and mosquitto to our client: recorded by programs/record_mqtt, when they
// were all content with the answers. Our answers are still the same.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bridges/mqtt_bench.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::mqtt_dialogues_test {
namespace {

using namespace mqtt;

struct Line {
  std::string what;
  std::uint32_t connection = 0;
  std::int64_t at_ms = 0;
  std::string text;  // of `hear` and `say`: bytes
  friend bool operator==(const Line&, const Line&) = default;
};
void PrintTo(const Line& line, std::ostream* out) {
  *out << line.what << " " << line.connection << " at " << line.at_ms << " ms " << testing::PrintToString(line.text);
}

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

using Recording = std::vector<Line>;

// By the name of the other side.
std::map<std::string, Recording> recordings() {
  std::ifstream in(test::source("tests/bridges/mqtt_dialogues.txt"));
  std::map<std::string, Recording> all;
  std::string name;
  for (std::string text; std::getline(in, text);) {
    if (text.starts_with("#")) continue;
    if (text.starts_with("= ")) {
      name = text.substr(2);
      continue;
    }
    Line line;
    std::istringstream words(text);
    words >> line.what >> line.connection >> line.at_ms;
    words.get();
    std::getline(words, line.text);
    if (line.what == "hear" || line.what == "say") line.text = from_hex(line.text);
    all[name].push_back(line);
  }
  return all;
}

bool is_of_client(const std::string& name) { return name.starts_with("our client"); }
bool is_ours(const Line& line) { return line.what == "say" || line.what == "close"; }

// The lines of the recording with what our side says and closes now.
Recording replayed_by_broker(const Recording& recording) {
  Recording now;
  std::int64_t at_ms = 0;
  Broker broker({[&](std::uint32_t connection, std::string_view bytes, std::string_view) {
                   now.push_back({"say", connection, at_ms, std::string(bytes)});
                 },
                 [&](std::uint32_t connection, std::string_view reason) {
                   now.push_back({"close", connection, at_ms, std::string(reason)});
                 }});
  for (const Line& line : recording) {
    if (is_ours(line) && line.text != "cut") continue;
    at_ms = line.at_ms;
    if (line.what != "close") now.push_back(line);
    const std::int64_t now_ns = at_ms * 1'000'000;
    if (line.what == "open") broker.opened(line.connection, now_ns);
    if (line.what == "hear") broker.received(line.connection, line.text, now_ns);
    if (line.what == "lost") broker.lost(line.connection);
    if (line.text == "cut") broker.cut_all();  // for the first connection that is cut; then there is none
  }
  return now;
}

Recording replayed_by_client(const Recording& recording) {
  Recording now;
  const Line* cause = nullptr;
  const auto note = [&](const char* what, std::string_view text) {
    now.push_back({what, cause->connection, cause->at_ms, std::string(text)});
  };
  Client client({[&](std::string_view bytes, std::string_view) { note("say", bytes); },
                 [&](std::string_view reason) { note("close", reason); }},
                {.name = "agv",
                 .is_clean = false,
                 .keep_alive_s = 1,
                 .will = Will{"c/agv", "CONNECTIONBROKEN", 1, true},
                 .filters = {{"order/#", 1}, {"actions", 0}}});
  for (const Line& line : recording) {
    if (is_ours(line)) continue;
    cause = &line;
    now.push_back(line);
    const std::int64_t now_ns = line.at_ms * 1'000'000;
    if (line.what == "open") client.opened(now_ns);
    if (line.what == "hear") client.received(line.text, now_ns);
    if (line.what == "lost") client.lost();
    if (line.what == "tick") client.tick(now_ns);
    if (line.what != "publish") continue;
    std::istringstream words(line.text);
    Publish publish;
    int qos = 0;
    words >> qos >> publish.retain >> publish.topic >> publish.payload;
    publish.qos = static_cast<std::uint8_t>(qos);
    client.publish(publish, {}, now_ns);
  }
  return now;
}

// Milliseconds may pass between a cause and what is said.
Recording without_times(Recording recording) {
  for (Line& line : recording) line.at_ms = 0;
  return recording;
}

TEST(MqttDialogues, OurBrokerAnswersAsItsClientsAccepted) {
  std::size_t clients = 0;
  for (const auto& [name, recording] : recordings()) {
    if (is_of_client(name)) continue;
    ++clients;
    EXPECT_EQ(without_times(replayed_by_broker(recording)), without_times(recording)) << name;
  }
  EXPECT_EQ(clients, 8U);
}

TEST(MqttDialogues, OurClientAnswersAsMosquittoAccepted) {
  std::size_t brokers = 0;
  for (const auto& [name, recording] : recordings()) {
    if (!is_of_client(name)) continue;
    ++brokers;
    EXPECT_EQ(without_times(replayed_by_client(recording)), without_times(recording)) << name;
  }
  EXPECT_EQ(brokers, 1U);
}

// In both directions, and in whatever pieces; CONNECTs with passwords and of other versions are read, but never
// written.
TEST(MqttDialogues, EachPacketIsReadAndWrittenAsItCame) {
  std::map<std::string, std::size_t> kinds;
  for (const auto& [name, recording] : recordings()) {
    std::map<std::pair<std::string, std::uint32_t>, std::string> streams;
    for (const Line& line : recording) {
      if (line.what == "hear" || line.what == "say") streams[{line.what, line.connection}] += line.text;
    }
    for (const auto& [key, bytes] : streams) {
      PacketReader at_once, in_pieces;
      std::string written;
      bool is_refused = false;
      at_once.add(bytes);
      for (const char byte : bytes) {
        in_pieces.add({&byte, 1});
        while (const auto packet = in_pieces.next()) {
          EXPECT_EQ(packet, at_once.next()) << name;
          written += encode(*packet);
          const std::string text = text_of(*packet);
          ++kinds[text.substr(0, text.find(':'))];
          const auto* connect = std::get_if<Connect>(&*packet);
          is_refused = is_refused || (connect != nullptr && (connect->level != 4 || connect->has_user));
        }
      }
      EXPECT_FALSE(at_once.next()) << name;
      EXPECT_EQ(in_pieces.error(), at_once.error()) << name;
      if (!in_pieces.error().empty() || is_refused) continue;
      EXPECT_EQ(written, bytes) << name << ", " << key.first << " " << key.second;
    }
  }
  EXPECT_EQ(kinds.size(), 11U) << "all kinds of packets: " << testing::PrintToString(kinds);
}

}  // namespace
}  // namespace fleetproof::mqtt_dialogues_test
