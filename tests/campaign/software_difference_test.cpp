// Which software made a campaign, as its archive says, and which one is at hand.
#include <gmock/gmock.h>

#include "campaign/run/engine_identity.hpp"
#include "campaign/run/replay.hpp"

namespace fleetproof::software_difference_test {
namespace {

using testing::HasSubstr;

std::string digest(char digit) { return std::string(64, digit); }

std::string difference(const EngineIdentity& stored, const AgentProgram& now) {
  return software_difference(stored, {&now});
}

AgentProgram plugin(char digit) {
  AgentProgram agent;
  agent.name = "mine";
  agent.source = {ProgramKind::Plugin, "/mine.so", digest(digit)};
  return agent;
}

EngineIdentity made_with(const std::string& libraries) {
  EngineIdentity stored = engine_identity();
  stored.libraries = libraries;
  return stored;
}

TEST(SoftwareDifference, IsNoneWhereTheSameSoftwareMadeAllRuns) {
  const auto stored =
      made_with("SQLite 3, plug-in mine2 sha256 " + digest('c') + ", plug-in mine sha256 " + digest('a'));
  EXPECT_EQ(stored_plugins(stored, "mine"), std::vector{digest('a')});
  EXPECT_EQ(difference(stored, plugin('a')), "");
  EXPECT_THAT(difference(stored, plugin('b')), HasSubstr(digest('a') + " then, " + digest('b') + " now"));
}

// Nobody knows which of them made a run: that it comes out otherwise is no fault of the engine.
TEST(SoftwareDifference, IsThereWhereSeveralWroteToTheArchive) {
  const auto plugins = made_with("plug-in mine sha256 " + digest('b') + "; begun by fleetproof 0.1.0 sha256 " +
                                 engine_identity().program_sha256 + " (GNU; plug-in mine sha256 " + digest('a') + ")");
  for (const char now : {'a', 'b'})
    EXPECT_THAT(difference(plugins, plugin(now)), HasSubstr(digest('b') + " and " + digest('a') + " then"));
  const auto engines = made_with("SQLite 3; begun by fleetproof 0.0.9 sha256 " + digest('e') + " (GNU; SQLite 3)");
  EXPECT_THAT(difference(engines, AgentProgram{}), HasSubstr(" and " + digest('e') + " then"));
}

}  // namespace
}  // namespace fleetproof::software_difference_test
