// What mosquitto's clients, Paho C and npm's mqtt said to the broker: it reads all of it, and answers as it did when
// these clients were content with the answers.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "core/bridges/mqtt/broker.hpp"

namespace fleetproof::mqtt_recordings_test {
namespace {

std::string bytes_of(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

TEST(MqttRecordings, AreReadAndAnsweredAsTheClientsExpect) {
  std::vector<std::string> said;
  std::map<std::uint32_t, mqtt::PacketReader> readers;
  mqtt::Broker broker({[&](std::uint32_t connection, std::string_view bytes, std::string_view text) {
                         said.push_back("< " + std::to_string(connection) + " " + std::string(text));
                         readers[connection].add(bytes);
                         EXPECT_TRUE(readers[connection].next().has_value()) << readers[connection].error();
                       },
                       [&](std::uint32_t connection, std::string_view reason) {
                         said.push_back("! " + std::to_string(connection) + " " + std::string(reason));
                       }});
  std::ifstream file(FLEETPROOF_SOURCE_DIR "/tests/bridges/mqtt_recordings.txt");
  ASSERT_TRUE(file) << "run from the source tree";
  std::set<std::uint32_t> opened;
  std::size_t heard = 0, answers = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] != '>') {
      ASSERT_FALSE(said.empty()) << line;
      EXPECT_EQ(said.front(), line);
      said.erase(said.begin());
      ++answers;
      continue;
    }
    EXPECT_THAT(said, testing::IsEmpty()) << "before " << line;
    std::istringstream words(line.substr(1));
    std::uint32_t connection = 0;
    std::string digits;
    words >> connection >> digits;
    if (opened.insert(connection).second) broker.opened(connection, 0);
    broker.received(connection, bytes_of(digits), 0);
    ++heard;
  }
  EXPECT_THAT(said, testing::IsEmpty());
  EXPECT_GT(heard, 20U);
  EXPECT_GT(answers, 25U);
}

}  // namespace
}  // namespace fleetproof::mqtt_recordings_test
