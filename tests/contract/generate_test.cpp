// The verb that draws layouts: the same seed gives the same file, and the layout that worlds of this seed are built on.
#include <gtest/gtest.h>

#include "generators/layout_family.hpp"
#include "generators/layout_file.hpp"
#include "generators/world.hpp"
#include "tests/support/program.hpp"

namespace fleetproof {
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

}  // namespace
}  // namespace fleetproof
