// The verb that draws layouts: the same seed gives the same file, and the layout that worlds of this seed are built on.
#include <gtest/gtest.h>

#include "generators/families/layout_family.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/worlds/world_maker.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::generate_test {
namespace {

class Generate : public test::ProgramTest {};

TEST_F(Generate, WritesTheLayoutOfTheWorldWithThatSeed) {
  for (const auto& family : layout_families()) {
    WorldSpec spec;
    spec.layout = std::string(family.name);
    RejectionCounts counts;
    const Scenario scenario = generate_world(spec, 11, counts);
    if (counts.worlds_rejected > 0) continue;
    const auto finished = run("generate " + std::string(family.name) + " --seed 11");
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.out, to_text(scenario.map->layout())) << family.name;
  }
}

TEST_F(Generate, WritesFilesInsteadAndDrawsAPicture) {
  const auto printed = run("generate fishbone --seed 3");
  const auto finished = run("generate fishbone --seed 3 -o layout.json --svg layout.svg");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(read((folder_ / "layout.json").string()), printed.out);
  EXPECT_EQ(read((folder_ / "layout.svg").string()), read(test::source("tests/layouts/gallery/fishbone.svg")));
}

TEST_F(Generate, StressIsARangeOfEveryFamily) {
  for (const auto& family : layout_families()) {
    const std::string name(family.name);
    const auto finished = run("generate " + name + " --seed 4 --stress");
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.out, run("generate " + name + "/stress --seed 4").out);
    EXPECT_NE(finished.out, run("generate " + name + " --seed 4").out);
  }
}

TEST_F(Generate, APlantHasOneRange) {
  const auto refused = run("generate plant/tight-gap --stress");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--stress: has no meaning for plant/tight-gap"), std::string::npos) << refused.err;
  EXPECT_EQ(run("generate plant/40 --stress").out, run("generate plant/stress/40").out);
}

TEST_F(Generate, MutatesALayoutFileAndTellsWhatWasRefused) {
  const std::string from = " --from '" + test::source("tests/layouts/crossdock.xml") + "'";
  const auto finished = run("generate mutated-import --seed 3" + from);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.out, run("generate mutated-import --seed 3" + from).out);
  EXPECT_NE(finished.out, run("generate mutated-import --seed 4" + from).out);
  std::string talk;
  for (int seed = 0; seed < 8; ++seed) talk += run("generate mutated-import --seed " + std::to_string(seed) + from).err;
  EXPECT_NE(talk.find("draws refused: weak-core"), std::string::npos) << talk;
  EXPECT_NE(run("generate mutated-import").err.find("--from: is missing"), std::string::npos);
  EXPECT_NE(run("generate mutated-import --stress" + from).err.find("--stress: has no meaning"), std::string::npos);
  EXPECT_NE(run("generate fishbone" + from).err.find("--from: belongs to mutated-import alone"), std::string::npos);
}

}  // namespace
}  // namespace fleetproof::generate_test
