// A campaign that is stopped keeps what it has and claims nothing.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::interruption_test {
namespace {

using testing::HasSubstr;

class Interruption : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("long.toml",
          "replicates = 1000000\nhorizon_s = 60\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nloss "
          "= [0.4]\ndelay_s = [2]\n[[gate]]\nagent = "
          "\"hull-lock\"\nlimit = 0.5\nmethod = \"fixed\"\nmin_transports_per_agv_hour = 0\n");
  }
};

TEST_F(Interruption, AnInterruptKeepsTheResultsAndDemonstratesNothing) {
  const std::string command = "cd '" + folder_.string() + "' && { " + FLEETPROOF_PROGRAM +
                              " run long.toml --db long.db >out.txt 2>err.txt & pid=$!; sleep 1; kill -INT $pid; wait "
                              "$pid; echo $? >code.txt; }";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read(path("code.txt")), "130\n");
  EXPECT_THAT(read(path("err.txt")), HasSubstr("interrupted"));
  const auto report = run("report long.db --json");
  EXPECT_EQ(report.exit_code, 4) << "the number of replicates was not fixed beforehand";
  const auto json = nlohmann::json::parse(report.out);
  EXPECT_EQ(json["verdict"], "not demonstrated");
  EXPECT_GT(json["campaign"]["stored_runs"], 10);
  EXPECT_EQ(run("replay long.db 3").exit_code, 0);
}

TEST_F(Interruption, ATimeBudgetStopsByItself) {
  const auto finished = run("run long.toml --db long.db --max-time 1");
  EXPECT_EQ(finished.exit_code, 4) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("not demonstrated"));
}

TEST_F(Interruption, AKillKeepsWhatWasCommitted) {
  const std::string command =
      "cd '" + folder_.string() + "' && { " + FLEETPROOF_PROGRAM +
      " run long.toml --db long.db >out.txt 2>err.txt & pid=$!; sleep 4; kill -9 $pid; wait $pid; true; }";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_FALSE(std::filesystem::exists(path("long.db")));
  const auto report = run("report long.db.partial --json");
  EXPECT_EQ(report.exit_code, 4) << report.err;
  EXPECT_GT(nlohmann::json::parse(report.out)["campaign"]["stored_runs"], 10);
  EXPECT_EQ(run("replay long.db.partial 3").exit_code, 0);
}

}  // namespace
}  // namespace fleetproof::interruption_test
