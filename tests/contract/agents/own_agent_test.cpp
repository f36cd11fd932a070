// The agent that the root README shows is the agent in tests/examples, and its campaign ends as the README says.
#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::own_agent_test {
namespace {

using test::source;
using OwnAgent = test::ProgramTest;

TEST_F(OwnAgent, IsShownInTheReadmeAsItIs) {
  const std::string readme = read(source("README.md"));
  const std::string fence = "```cpp\n";
  const std::size_t begin = readme.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t first = begin + fence.size();
  const std::string shown = readme.substr(first, readme.find("```", first) - first);
  EXPECT_GT(shown.size(), 100U);
  EXPECT_NE(read(source("tests/examples/rover.cpp")).find(shown), std::string::npos) << shown;
}

TEST_F(OwnAgent, BreaksTheSafetyDistance) {
  std::string campaign = read(source("tests/examples/rover.toml"));
  const std::string as_the_readme_builds_it = "../../build/rover.so";
  const std::size_t place = campaign.find(as_the_readme_builds_it);
  ASSERT_NE(place, std::string::npos) << campaign;
  write("rover.toml", campaign.replace(place, as_the_readme_builds_it.size(), FLEETPROOF_EXAMPLE));
  const auto result = run("run rover.toml");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.out.find("agent rover broke the safety distance"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace fleetproof::own_agent_test
