#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::test {

// Campaigns of short runs, simulated by one machine or in shards.
class ShardedCampaign : public ProgramTest {
 protected:
  void write_campaign(const std::string& name, int replicates,
                      const std::string& agents = "\"hull-lock\", \"reckless\"", const std::string& more = "") const {
    write(name, fmt::format("name = \"c\"\nseed = 5\nreplicates = {}\nhorizon_s = 30\n{}[factors]\nagents = [{}]\n"
                            "layouts = [\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0.0, 0.4]\ndelay_s = [2]\n",
                            replicates, more, agents));
  }
  // The bytes of the file that one machine writes.
  std::string single_file(const std::string& words = "") {
    const auto finished = run("run c.toml --db single.db " + words);
    single_code_ = finished.exit_code;
    EXPECT_TRUE(has_verdict(finished));
    return read(path("single.db"));
  }
  Finished run_shard(const std::string& out, const std::string& shard, const std::string& words = "") const {
    return run("run c.toml --shard " + shard + " --out " + out + " " + words);
  }
  int merge(const std::string& folders, const std::string& archive, const std::string& words = "") const {
    const auto finished = run("merge " + folders + " --db " + archive + " " + words);
    EXPECT_TRUE(has_verdict(finished));
    return finished.exit_code;
  }
  // The same program with other bytes.
  Finished other_program(const std::string& words) const {
    return shell("cp \"$FLEETPROOF\" other-build; echo >>other-build; ./other-build " + words);
  }
  std::size_t chunk_count(const std::string& out) const {
    std::size_t count = 0;
    if (!std::filesystem::exists(folder_ / out / "chunks")) return 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / out / "chunks"))
      count += entry.path().extension() == ".chunk" && entry.path().stem().string().front() != '.' ? 1 : 0;
    return count;
  }
  std::string session_lines(const std::string& out) const {
    std::string lines;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / out / "sessions"))
      lines += read(entry.path());
    return lines;
  }

  int single_code_ = -1;
};

}  // namespace fleetproof::test
