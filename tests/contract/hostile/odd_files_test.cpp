// What is no regular file is refused with one clear error, and never waited for.
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "tests/support/program.hpp"

namespace fleetproof::odd_files_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class OddFiles : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    for (const std::string ending : {"", ".toml", ".json", ".csv", ".xml", ".so", ".db"}) {
      ASSERT_EQ(mkfifo(path("pipe" + ending).c_str(), 0644), 0);
      std::filesystem::create_directory(path("folder" + ending));
      std::filesystem::create_symlink("/dev/zero", path("device" + ending));
      make_socket("socket" + ending);
    }
  }
  void make_socket(const std::string& name) const {
    // A socket's path is short; the folder's may not be.
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder_);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path, sizeof address.sun_path - 1);
    const int made = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    close(made);
    std::filesystem::current_path(before);
  }
  // `words` with each kind of file in the place of FILE.
  void expect_refused(const std::string& words, const std::string& ending) const {
    for (const auto& [name, what] :
         {std::pair{"pipe", "pipe"}, {"folder", "folder"}, {"device", "device"}, {"socket", "socket"}}) {
      auto line = words;
      line.replace(line.find("FILE"), 4, name + ending);
      const auto finished = shell("timeout 20 \"$FLEETPROOF\" " + line);
      EXPECT_EQ(finished.exit_code, 2) << line << "\n" << finished.err;
      EXPECT_THAT(finished.err, AllOf(HasSubstr(name + ending), HasSubstr(what))) << line;
      EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << line << "\n" << finished.err;
      EXPECT_EQ(finished.out, "") << line;
    }
  }
  std::string campaign(const std::string& layout, const std::string& rest = "") const {
    return "horizon_s = 1\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"" + layout + "\"]\nfleet_sizes = [2]\n" +
           rest;
  }
};

TEST_F(OddFiles, AsInputs) {
  expect_refused("run FILE", ".toml");
  expect_refused("check FILE", ".toml");
  expect_refused("check FILE", ".json");
  expect_refused("simulate FILE", ".json");
  expect_refused("import layout FILE", ".json");
  expect_refused("import opentcs FILE", ".xml");
  expect_refused("generate mutated-import --from FILE", ".json");
  expect_refused("simulate '" + test::source("tests/scenarios/figure4.json") + "' --plugin FILE", ".so");
}

TEST_F(OddFiles, AsArchives) {
  expect_refused("report FILE", ".db");
  expect_refused("replay FILE 0", ".db");
  write("a.toml", campaign("aisle-grid"));
  for (const std::string name : {"pipe.db", "device.db", "socket.db"}) {
    EXPECT_EQ(shell("timeout 20 \"$FLEETPROOF\" run a.toml --db " + name).exit_code, 2);
    const auto finished = shell("timeout 20 \"$FLEETPROOF\" run a.toml --overwrite --db " + name);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("not a results file"));
  }
}

// SQLite opens these by itself, and would wait at a pipe.
TEST_F(OddFiles, BesideAnArchive) {
  write("a.toml", campaign("aisle-grid"));
  ASSERT_EQ(run("run a.toml --db a.db").exit_code, 4);
  for (const std::string name : {"a.db-journal", "a.db-wal"}) {
    ASSERT_EQ(mkfifo(path(name).c_str(), 0644), 0);
    const auto finished = shell("timeout 20 \"$FLEETPROOF\" report a.db");
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr(name + ": this is no regular file"));
    std::filesystem::remove(path(name));
  }
  ASSERT_EQ(mkfifo(path("b.sessions.jsonl").c_str(), 0644), 0);
  const auto finished = shell("timeout 20 \"$FLEETPROOF\" run a.toml --db b.db");
  EXPECT_EQ(finished.exit_code, 2) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("b.sessions.jsonl: is a pipe"));
}

TEST_F(OddFiles, InACampaignFile) {
  for (const std::string name : {"pipe", "folder", "device", "socket"}) {
    const auto refused = [&](const std::string& text, const std::string& file) {
      write("a.toml", text);
      const auto finished = shell("timeout 20 \"$FLEETPROOF\" run a.toml --db a.db");
      EXPECT_EQ(finished.exit_code, 2) << finished.err;
      EXPECT_THAT(finished.err, AllOf(HasSubstr(file), HasSubstr("is a " + name))) << text;
      EXPECT_FALSE(std::filesystem::exists(folder_ / "a.db"));
    };
    refused(campaign("./" + name + ".xml"), name + ".xml");
    write("plant.json", run("generate aisle-grid --seed 1").out);
    refused(campaign("plant.json", "[world]\norders = \"" + name + ".csv\"\n"), name + ".csv");
    refused(campaign("aisle-grid", "[radio]\ntrace = \"" + name + ".csv\"\n"), name + ".csv");
    refused("[factors]\nagents = [\"./" + name + ".so\"]\nlayouts = [\"aisle-grid\"]\n", name + ".so");
  }
}

TEST_F(OddFiles, AsOutputs) {
  write("a.toml", campaign("aisle-grid"));
  ASSERT_EQ(run("run a.toml --db a.db").exit_code, 4);
  expect_refused("generate fishbone -o FILE", "");
  expect_refused("generate fishbone --svg FILE", "");
  expect_refused("report a.db -o FILE", "");
  expect_refused("replay a.db 0 --scenario FILE", "");
  for (const std::string name : {"pipe", "socket"}) {
    EXPECT_NE(std::filesystem::status(path(name)).type(), std::filesystem::file_type::regular);
  }
}

TEST_F(OddFiles, AnAgentWithAnImpossibleName) {
  write("a.toml",
        std::string("[factors]\nagents = [\"") + FLEETPROOF_NAMED_AGENT + "\"]\nlayouts = [\"aisle-grid\"]\n");
  const auto refused = [&](const std::string& name, const std::string& why) {
    const std::string scenario = "'" + test::source("tests/scenarios/figure4.json") + "'";
    const std::vector<std::string> verbs = {"run a.toml",
                                            "simulate " + scenario + " --plugin " + FLEETPROOF_NAMED_AGENT};
    for (const auto& verb : verbs) {
      const auto finished = shell(name + "\n\"$FLEETPROOF\" " + verb);
      EXPECT_EQ(finished.exit_code, 2) << finished.err;
      EXPECT_THAT(finished.err, AllOf(HasSubstr("named_agent"), HasSubstr(why)));
      EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
    }
  };
  const std::string set = "export FLEETPROOF_TEST_AGENT=";
  refused("unset FLEETPROOF_TEST_AGENT", "has no name");
  refused(set, "has no name");
  refused(set + "$'caf\\xe9'", "calls itself \"caf\\xe9\"; an agent's name is UTF-8");
  refused(set + "$'a\\nb'", "calls itself \"a\\nb\"; an agent's name is UTF-8 without control characters");
  refused(set + "$'a\\xc2\\x9b'", "without control characters");
  refused(set + "$(printf '%0101d' 0)", "at most 100 bytes");
  refused(set + "$(printf '%090000d' 0)", "at most 100 bytes");
  refused(set + "hull-lock", "calls itself \"hull-lock\", as another program does");
}

}  // namespace
}  // namespace fleetproof::odd_files_test
