#include "tests/support/program.hpp"

namespace fleetproof::wrong_load_test {
namespace {

class WrongLoad : public test::ProgramTest {};

// The computer of an AGV restarts while the AGV puts a load down, and is frozen until that is done. Then it is told of
// the order once more, although the order is done, and a younger load waits where the old one was.
TEST_F(WrongLoad, AnOrderThatIsDoneDoesNotTakeTheLoadOfAnother) {
  for (const std::string scenario : {"frozen_while_dropping", "restarted_while_dropping"}) {
    const auto finished = run("simulate " + test::source("tests/scenarios/" + scenario + ".json") +
                              " --agent hull-lock --law containment");
    EXPECT_NE(finished.out.find("agent: restarted"), std::string::npos) << finished.out << finished.err;
    EXPECT_EQ(finished.out.find("load-at-wrong-station"), std::string::npos) << finished.out;
  }
}

}  // namespace
}  // namespace fleetproof::wrong_load_test
