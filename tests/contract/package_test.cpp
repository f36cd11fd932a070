// What an installation promises: an agent in C and one in C++ are built against it, outside the sources, and tried.
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/program.hpp"

namespace fleetproof {
namespace {

class Package : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const std::string build = std::filesystem::path(FLEETPROOF_PROGRAM).parent_path();
    ASSERT_EQ(shell("DESTDIR=" + path("root") + " cmake --install " + build + " --prefix /usr"), 0);
  }
  // Without what the tests' own environment would add.
  int shell(const std::string& command) const {
    const std::string clean = "env -i HOME=/nonexistent PATH=" + path("root/usr/bin") + ":/usr/bin:/bin ";
    return std::system((clean + "sh -c 'cd " + path("") + " && " + command + "' > " + path("said") + " 2>&1").c_str());
  }
};

TEST_F(Package, BuildsAndTriesAgentsOutsideTheSources) {
  ASSERT_EQ(shell("cp -r root/usr/share/doc/fleetproof/examples agents"), 0) << read(path("said"));
  ASSERT_EQ(shell("cmake -S agents -B agents/build -DCMAKE_PREFIX_PATH=" + path("root/usr")), 0) << read(path("said"));
  ASSERT_EQ(shell("cmake --build agents/build"), 0) << read(path("said"));
  EXPECT_EQ(shell("cd agents && ! fleetproof run rover.toml"), 0) << read(path("said"));
  EXPECT_NE(read(path("said")).find("rover  violation"), std::string::npos) << read(path("said"));
  EXPECT_EQ(shell("cd agents && fleetproof run beacon.toml --exit-zero"), 0) << read(path("said"));
  EXPECT_NE(read(path("said")).find("beacon"), std::string::npos);
}

TEST_F(Package, NamesNoFolderOfTheBuild) {
  for (const char* folder : {"include", "share"}) {
    EXPECT_NE(shell("grep -rlF " + test::source("") + " root/usr/" + folder), 0) << read(path("said"));
  }
}

TEST_F(Package, ThePageAndTheCompletionsFollowTheVerbs) {
  const std::string page = read(path("root/usr/share/man/man1/fleetproof.1"));
  const std::string bash = read(path("root/usr/share/bash-completion/completions/fleetproof"));
  const std::string zsh = read(path("root/usr/share/zsh/vendor-completions/_fleetproof"));
  const std::string help = run("--help").out;
  std::size_t verbs = 0;
  for (std::size_t line = help.find("Subcommands:"); (line = help.find("\n  ", line)) != std::string::npos; ++line) {
    const std::string verb = help.substr(line + 3, help.find(' ', line + 3) - line - 3);
    if (verb.empty()) continue;
    ++verbs;
    EXPECT_NE(page.find(".SS " + verb + "\n"), std::string::npos) << verb;
    EXPECT_NE(bash.find("    " + verb + ") options="), std::string::npos) << verb;
    EXPECT_NE(zsh.find("    " + verb + ")\n"), std::string::npos) << verb;
  }
  EXPECT_GE(verbs, 20U);
}

TEST_F(Package, BashCompletesVerbsAndOptions) {
  write("try.bash", R"(
source root/usr/share/bash-completion/completions/fleetproof
ask() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _fleetproof; echo "${COMPREPLY[*]}"; }
ask fleetproof rep
ask fleetproof run --sha
)");
  ASSERT_EQ(shell("bash try.bash"), 0) << read(path("said"));
  EXPECT_EQ(read(path("said")), "report replay\n--shard --shards\n");
}

}  // namespace
}  // namespace fleetproof
