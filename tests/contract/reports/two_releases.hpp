#pragma once

#include <fmt/format.h>

#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::test {

// old.db: a release that keeps the distance. new.db: one that does not, in the same twelve worlds.
class TwoReleases : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    run_release("old", "hull-lock", 1);
    run_release("new", "reckless", 1);
  }
  void run_release(const std::string& name, const std::string& agent, int seed) {
    write(name + ".toml", fmt::format("seed = {}\nreplicates = 12\nhorizon_s = 120\n[factors]\nagents = [{{ agent = "
                                      "\"{}\", name = \"candidate\" }}]\nlayouts = [\"aisle-grid\"]\n"
                                      "fleet_sizes = [4]\nloss = [0.0, 0.4]\ndelay_s = [1]\n",
                                      seed, agent));
    run(fmt::format("run {0}.toml --db {0}.db", name));
  }
};

}  // namespace fleetproof::test
