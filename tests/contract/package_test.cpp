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
  ASSERT_EQ(shell("cp -r root/usr/share/fleetproof/examples agents"), 0) << read(path("said"));
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

// A shell in a terminal of its own, in which somebody presses the tabulator.
TEST_F(Package, ZshCompletesVerbsAndOptions) {
  write("try.zsh", R"(
zmodload zsh/zpty
zpty terminal zsh -f -i
zpty -w terminal 'PS1=; fpath=(root/usr/share/zsh/vendor-completions $fpath); autoload -U compinit'
zpty -w terminal 'compinit -u -d known; stty cols 200; print rea""dy'
zpty -r terminal heard '*ready*'
ask() {
  zpty -w -n terminal "$1"$'\t\t'
  zpty -r terminal heard "*$2*$3*"
  print -r -- "${heard//$'\e'\[[0-9;]#[A-Za-z]/}"
  zpty -w terminal $'\x15'
}
ask 'fleetproof rep' 'simulate one run of a campaign again' 'judge a campaign file'
ask 'fleetproof run --sha' 'simulate one part of the campaign: i/n' 'the number of shards'
)");
  ASSERT_EQ(shell("timeout 60 zsh -f try.zsh"), 0) << read(path("said"));
  const std::string said = read(path("said"));
  for (const char* offered : {"replay  -- ", "report  -- ", "--shard   -- ", "--shards  -- "}) {
    EXPECT_NE(said.find(offered), std::string::npos) << offered << said;
  }
  EXPECT_EQ(said.find("retest"), std::string::npos) << said;
}

}  // namespace
}  // namespace fleetproof
