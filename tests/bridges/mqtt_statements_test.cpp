// The table of the normative statements of MQTT 3.1.1: its tests exist. And the statements that no other test shows;
// the numbers stand in brackets.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "core/bridges/mqtt/topics.hpp"
#include "tests/bridges/mqtt_bench.hpp"

namespace fleetproof::mqtt_statements_test {
namespace {

using namespace mqtt;
using namespace std::string_literals;
using testing::ElementsAre;
using testing::HasSubstr;

namespace fs = std::filesystem;

const std::string kTree = FLEETPROOF_SOURCE_DIR;
const std::string kTable = kTree + "/core/bridges/mqtt/statements.md";

std::string text_in(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

struct Statement {
  std::string number, rule, state, last;
};

std::vector<Statement> statements() {
  static const std::regex cells(R"(\| (\d[^|]*) \| ([^|]+) \| (done|left out) \| ([^|]+) \|)");
  std::istringstream lines(text_in(kTable));
  std::vector<Statement> found;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, cells)) found.push_back({match[1], match[2], match[3], match[4]});
  }
  return found;
}

// Files of MQTT in our sources and tests.
std::vector<fs::path> files_of_mqtt() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kTree + "/core/bridges/mqtt")) files.push_back(entry.path());
  for (const auto& entry : fs::directory_iterator(kTree + "/tests/bridges")) {
    if (entry.path().filename().string().starts_with("mqtt_")) files.push_back(entry.path());
  }
  return files;
}

std::set<std::string> found_in_files(const std::regex& wanted) {
  std::set<std::string> found;
  for (const auto& file : files_of_mqtt()) {
    const std::string text = text_in(file);
    for (std::sregex_iterator match(text.begin(), text.end(), wanted), end; match != end; ++match)
      found.insert(match->size() > 2 ? (*match)[1].str() + "." + (*match)[2].str() : (*match)[1].str());
  }
  return found;
}

TEST(MqttStatements, EachOneHasATestThatExistsOrAReason) {
  const auto tests = found_in_files(std::regex(R"(TEST(?:_F)?\(\s*(Mqtt\w+),\s*(\w+)\))"));
  std::set<std::string> numbers;
  for (const Statement& one : statements()) {
    EXPECT_TRUE(numbers.insert(one.number).second) << one.number << " stands twice";
    if (one.state == "done") {
      EXPECT_TRUE(one.last.size() > 2 && tests.contains(one.last.substr(1, one.last.size() - 2)))
          << one.number << ": " << one.last;
    } else {
      EXPECT_TRUE(one.last.size() > 20 && one.last.ends_with('.')) << one.number << ": " << one.last;
    }
  }
  for (const auto& number : found_in_files(std::regex(R"(\[MQTT-(\d[\d.-]*-\d+)\])")))
    EXPECT_TRUE(numbers.contains(number)) << "no statement has the number " << number;
}

TEST(MqttStatements, TheHeadOfTheTableCountsThem) {
  const auto all = statements();
  const auto done = std::ranges::count(all, "done", &Statement::state);
  EXPECT_THAT(text_in(kTable),
              HasSubstr("Of " + std::to_string(all.size()) + " statements, " + std::to_string(done) + " are done and " +
                        std::to_string(static_cast<std::ptrdiff_t>(all.size()) - done) + " are left out."));
}

// [MQTT-1.5.3-3], [MQTT-4.7.3-4]
TEST(MqttStatements, TextsAreComparedByteByByte) {
  const std::string marked = "\xef\xbb\xbf\x61";
  PacketReader reader;
  reader.add(encode(message(marked, "x")));
  EXPECT_EQ(std::get<Publish>(*reader.next()).topic, marked);
  EXPECT_FALSE(matches("a", marked)) << "a byte order mark is a character";
  EXPECT_FALSE(matches("\xc3\xa9", "e\xcc\x81")) << "one letter, two forms";
  EXPECT_FALSE(matches("a", "A"));
}

// [MQTT-3.1.4-1], [MQTT-3.1.4-5], [MQTT-4.8.0-1]
TEST(MqttStatements, NothingBehindARefusedConnectCounts) {
  const std::string retained = encode(message("t", "x", 0, true));
  const std::string wrong[] = {"\x10\x0d\0\4MQTT\4\3\0\0\0\1a"s,  // its reserved flag
                               "\x10\x0e\0\4MQTT\5\2\0\0\0\0\1a"s, encode(keeping("")), encode(Connack{}),
                               encode(Pingreq{})};
  std::uint32_t connection = 0;
  for (const std::string& bytes : wrong) {
    BrokerBench bench;
    bench.broker.opened(++connection, 0);
    bench.broker.received(connection, bytes + retained, 0);
    EXPECT_TRUE(bench.closed.contains(connection));
    bench.connect(100, named("watch"), {{"t", 0}});
    EXPECT_THAT(bench.heard(100), ElementsAre("CONNACK: accepted", "SUBACK: packet 1")) << connection;
  }
  BrokerBench bench;
  bench.broker.opened(1, 0);
  bench.broker.received(1, wrong[0], 0);
  EXPECT_THAT(bench.heard(1), ElementsAre()) << "what is malformed gets no CONNACK";
}

// [MQTT-3.1.2-9], [MQTT-3.1.2-11], [MQTT-3.1.2-18] to [MQTT-3.1.2-21], [MQTT-3.1.3-4], [MQTT-3.1.3-10],
// [MQTT-3.1.3-11], [MQTT-3.8.3-1], [MQTT-3.9.3-2], [MQTT-3.10.1-1], [MQTT-3.10.3-1], [MQTT-3.14.1-1]
TEST(MqttStatements, FieldsAndFlagsBelongTogether) {
  const std::string head = "\0\4MQTT\4"s;
  const auto connect = [&](const std::string& rest) {
    return "\x10"s + static_cast<char>(head.size() + rest.size()) + head + rest;
  };
  const std::pair<std::string, std::string> refusals[] = {
      {connect("\6\0\0\0\1a"s), "CONNECT ends too early"},                // a will without fields
      {connect("\6\0\0\0\1a\0\1t"s), "CONNECT ends too early"},           // without a message
      {connect("\2\0\0\0\1a\0\1t\0\1m"s), "CONNECT has bytes behind"},    // fields without a will
      {connect("\2\0\0\0\1a\0\1u"s), "CONNECT has bytes behind"},         // a user without its flag
      {connect("\x82\0\0\0\1a"s), "CONNECT ends too early"},              // and the other way round
      {connect("\x82\0\0\0\1a\0\1u\0\1p"s), "CONNECT has bytes behind"},  // a password without its flag
      {connect("\xc2\0\0\0\1a\0\1u"s), "CONNECT ends too early"},
      {connect("\2\0\0\0\1\xff"s), "CONNECT has a text that is no UTF-8"},
      {connect("\6\0\0\0\1a\0\1\xff\0\0"s), "CONNECT has a text that is no UTF-8"},
      {connect("\x82\0\0\0\1a\0\1\xff"s), "CONNECT has a text that is no UTF-8"},
      {"\x82\x06\0\1\0\1\xff\0"s, "SUBSCRIBE has a text that is no UTF-8"},
      {"\x82\x06\0\1\0\1a\4"s, "SUBSCRIBE asks for a QoS above 2"},
      {"\x90\x03\0\1\3"s, "SUBACK has an unknown return code"},
      {"\xa2\x05\0\1\0\1\xff"s, "UNSUBSCRIBE has a text that is no UTF-8"},
      {"\xa0\x05\0\1\0\1a"s, "UNSUBSCRIBE has reserved flags set"},
      {"\xe1\0"s, "DISCONNECT has reserved flags set"}};
  for (const auto& [bytes, why] : refusals) {
    PacketReader reader;
    reader.add(bytes);
    EXPECT_FALSE(reader.next());
    EXPECT_THAT(reader.error(), testing::StartsWith(why)) << testing::PrintToString(bytes);
  }
}

// [MQTT-3.1.3-5]
TEST(MqttStatements, NamesOf23LettersAndDigitsAreAllowed) {
  BrokerBench bench;
  std::uint32_t connection = 0;
  for (const std::string name : {"0123456789abcdefghijklm", "nopqrstuvwxyzABCDEFGHIJ", "KLMNOPQRSTUVWXYZ"}) {
    bench.connect(++connection, named(name));
    EXPECT_THAT(bench.heard(connection), ElementsAre("CONNACK: accepted"));
  }
}

// [MQTT-3.3.1-3], [MQTT-4.3.2-2]
TEST(MqttStatements, TheSamePacketAgainIsANewMessageToOthers) {
  BrokerBench bench;
  bench.connect(1, named("master"), {{"t", 1}});
  bench.connect(2, named("agv"));
  bench.heard(1);
  Publish again = message("t", "x", 1);
  bench.say(2, again);
  again.is_again = true;
  bench.say(2, again);
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: t, QoS 1, 1 bytes x", "PUBLISH: t, QoS 1, 1 bytes x"));
  EXPECT_THAT(bench.heard(2), ElementsAre("CONNACK: accepted", "PUBACK: packet 1", "PUBACK: packet 1"));
}

// [MQTT-3.1.2.7], [MQTT-3.3.1-7], [MQTT-3.3.1-12], [MQTT-3.8.4-3]
TEST(MqttStatements, RetainedComesWithEachFilter) {
  BrokerBench bench;
  bench.connect(1, named("agv"));
  bench.say(1, message("t", "first", 1, true));
  bench.say(1, message("t", "second", 0, true));
  bench.say(1, message("t", "passing"));
  bench.say(1, Disconnect{});
  bench.connect(2, named("master"), {{"t", 1}});
  EXPECT_THAT(bench.heard(2),
              ElementsAre("CONNACK: accepted", "SUBACK: packet 1", "PUBLISH: t, QoS 0, retained, 6 bytes second"));
  bench.say(2, Subscribe{2, {{"t", 0}}});
  EXPECT_THAT(bench.heard(2), ElementsAre("SUBACK: packet 2", "PUBLISH: t, QoS 0, retained, 6 bytes second"));
  bench.connect(3, named("agv"));
  bench.say(3, message("t", "x", 1));
  EXPECT_THAT(bench.heard(2), ElementsAre("PUBLISH: t, QoS 0, 1 bytes x")) << "once, by the newer subscription";
}

// [MQTT-3.8.4-4], [MQTT-3.8.4-5], [MQTT-3.9.3-1], [MQTT-3.8.4-6]
TEST(MqttStatements, OneSubackAnswersAllFiltersInTheirOrder) {
  BrokerBench bench;
  bench.connect(1, named("agv"));
  bench.heard(1);
  bench.say(1, Subscribe{9, {{"a", 0}, {"$SYS/#", 1}, {"b", 2}, {"c", 1}}});
  const auto suback = bench.out[1].next();
  ASSERT_TRUE(suback.has_value());
  EXPECT_EQ(std::get<Suback>(*suback), (Suback{9, {0, kRefused, 1, 1}}));
  EXPECT_FALSE(bench.out[1].next());
}

// [MQTT-3.10.4-1] to [MQTT-3.10.4-6]
TEST(MqttStatements, UnsubscribingEndsWhatHasNotBegun) {
  BrokerBench bench;
  bench.connect(1, keeping("agv"), {{"a/+", 1}, {"b", 1}});
  bench.connect(2, named("master"));
  bench.say(2, message("a/1", "begun", 1));
  bench.say(1, Unsubscribe{4, {"a/1", "A/+", "nothing"}});
  bench.say(2, message("a/1", "wanted", 1));
  bench.say(1, Unsubscribe{5, {"a/+", "b"}});
  bench.say(2, message("a/1", "no", 1));
  bench.say(2, message("b", "no", 1));
  EXPECT_THAT(bench.heard(1),
              ElementsAre("CONNACK: accepted", "SUBACK: packet 1", "PUBLISH: a/1, QoS 1, 5 bytes begun",
                          "UNSUBACK: packet 4", "PUBLISH: a/1, QoS 1, 6 bytes wanted", "UNSUBACK: packet 5"));
  bench.broker.lost(1);
  bench.connect(3, keeping("agv"));
  EXPECT_THAT(bench.heard(3),
              ElementsAre("CONNACK: accepted, session present", "PUBLISH: a/1, QoS 1, again, 5 bytes begun",
                          "PUBLISH: a/1, QoS 1, again, 6 bytes wanted"));
}

// [MQTT-2.3.1-4], [MQTT-3.2.2-3]
TEST(MqttStatements, TheBrokerSaysAgainUnderTheSameIds) {
  BrokerBench bench;
  bench.connect(1, keeping("agv"), {{"t", 1}});
  EXPECT_THAT(bench.heard(1), ElementsAre("CONNACK: accepted", "SUBACK: packet 1")) << "no session was there";
  bench.connect(2, named("master"));
  bench.say(2, message("t", "first", 1));
  bench.say(2, message("t", "second", 1));
  bench.heard(1);
  const auto id = bench.last_id;
  bench.broker.lost(1);
  bench.say(2, message("t", "third", 1));
  bench.connect(3, keeping("agv"));
  bench.say(3, Puback{id});
  bench.broker.lost(3);
  bench.connect(4, keeping("agv"));
  EXPECT_THAT(bench.heard(4),
              ElementsAre("CONNACK: accepted, session present", "PUBLISH: t, QoS 1, again, 5 bytes first",
                          "PUBLISH: t, QoS 1, again, 5 bytes third"));
  EXPECT_NE(bench.last_id, id);
}

// [MQTT-3.1.2-10], [MQTT-3.1.2-12], [MQTT-3.1.2-16]
TEST(MqttStatements, AWillIsPublishedOnceAndOnlyIfThereIsOne) {
  BrokerBench bench;
  bench.connect(1, named("master"), {{"#", 0}});
  bench.heard(1);
  Connect agv = named("agv");
  agv.will = Will{"c", "gone", 0, false};
  bench.connect(2, agv);
  bench.broker.lost(2);
  bench.connect(3, named("agv"));
  bench.broker.lost(3);
  EXPECT_THAT(bench.heard(1), ElementsAre("PUBLISH: c, QoS 0, 4 bytes gone"));
  bench.connect(4, named("late"), {{"#", 0}});
  EXPECT_THAT(bench.heard(4), ElementsAre("CONNACK: accepted", "SUBACK: packet 1")) << "it is not retained";
}

std::vector<std::uint16_t> ids_of_messages(ClientBench& bench) {
  std::vector<std::uint16_t> ids;
  while (const auto packet = bench.out.next()) {
    if (const auto* publish = std::get_if<Publish>(&*packet)) ids.push_back(publish->id);
  }
  return ids;
}

// [MQTT-2.3.1-2], [MQTT-2.3.1-3], [MQTT-4.3.2-1], [MQTT-4.4.0-1], [MQTT-4.6.0-1]
TEST(MqttStatements, TheClientSaysAgainUnderTheSameIdsInOrder) {
  ClientBench bench({.name = "agv", .is_clean = false});
  Client& client = bench.client;
  client.opened(0);
  client.received(encode(Connack{}), 0);
  for (const char* text : {"1", "2", "3"}) client.publish(message("t", text, 1), {}, 0);
  const auto ids = ids_of_messages(bench);
  EXPECT_THAT(ids, ElementsAre(1, 2, 3));
  client.received(encode(Puback{2}), 0);
  client.publish(message("t", "4", 1), {}, 0);
  EXPECT_THAT(ids_of_messages(bench), ElementsAre(4));
  client.lost();
  client.opened(1);
  client.received(encode(Connack{true}), 1);
  EXPECT_THAT(ids_of_messages(bench), ElementsAre(1, 3, 4));
  for (int i = 0; i < 65'535; ++i) {
    client.publish(message("t", "x", 1), {}, 1);
    const auto id = ids_of_messages(bench).at(0);
    ASSERT_TRUE(id > 4 || id == 2) << "the others are in use";
    client.received(encode(Puback{id}), 1);
  }
}

// [MQTT-4.5.0-2], [MQTT-4.6.0-2]
TEST(MqttStatements, TheClientAcknowledgesInTheOrderInWhichMessagesCame) {
  ClientBench bench;
  bench.client.opened(0);
  bench.client.received(encode(Connack{}), 0);
  bench.said();
  std::string bytes;
  for (const int id : {7, 3, 7, 9}) {
    Publish one = message("never/asked/for", "x", 1);
    one.id = static_cast<std::uint16_t>(id);
    bytes += encode(one);
  }
  bench.client.received(bytes, 1);
  EXPECT_THAT(bench.said(),
              ElementsAre("PUBACK: packet 7", "PUBACK: packet 3", "PUBACK: packet 7", "PUBACK: packet 9"));
}

}  // namespace
}  // namespace fleetproof::mqtt_statements_test
