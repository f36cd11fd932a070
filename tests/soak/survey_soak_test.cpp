// Every layout file in the folder FLEETPROOF_LAYOUTS: imported as the survey reads it, or refused for a fault that the
// survey finds, too.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/program.hpp"

namespace fleetproof::survey_soak_test {
namespace {

using SurveySoak = test::ProgramTest;

TEST_F(SurveySoak, RealLayouts) {
  const char* folder = std::getenv("FLEETPROOF_LAYOUTS");
  if (folder == nullptr) GTEST_SKIP() << "set FLEETPROOF_LAYOUTS to a folder of real layouts";
  const auto finished = shell("python3 -B '" + test::source("tests/survey/survey.py") + "' \"$FLEETPROOF\" '" +
                              std::filesystem::absolute(folder).string() + "'");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(finished.out.ends_with("\n\nno difference\n"));
  GTEST_LOG_(INFO) << "\n" << finished.out;
}

}  // namespace
}  // namespace fleetproof::survey_soak_test
