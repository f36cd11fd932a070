// What an installation promises: an agent in C and one in C++ are built against it, outside the sources, and tried.
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.hpp"

namespace fleetproof::package_test {
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

// The commands of the README: its first block, and those between backticks that have arguments.
std::vector<std::string> commands_of(const std::string& readme) {
  std::vector<std::string> commands;
  const std::size_t block = readme.find("```sh\n") + 6, end = readme.find("```", block);
  std::istringstream lines(readme.substr(block, end - block));
  for (std::string line; std::getline(lines, line);) commands.push_back(line);
  const std::regex inline_command("`(fleetproof [a-z]+ [^`]+)`");
  const std::string rest = readme.substr(end + 3);
  for (std::sregex_iterator found(rest.begin(), rest.end(), inline_command), none; found != none; ++found)
    commands.push_back((*found)[1]);
  return commands;
}

// `run` and `report` end with 1: the example breaks the safety distance.
TEST_F(Package, BuildsAndTriesAgentsOutsideTheSourcesAsItsReadmeSays) {
  const auto commands = commands_of(read(test::source("core/sdk/package/README.md")));
  ASSERT_EQ(commands.size(), 7U);
  std::string script = "set -e\nexport CMAKE_PREFIX_PATH=" + path("root/usr") + "\n";
  for (std::string command : commands) {
    if (const auto at = command.find("/usr/share"); at != std::string::npos) command.insert(at, path("root"));
    const bool judges = command.starts_with("fleetproof run") || command.starts_with("fleetproof report");
    script += command + (judges ? " || [ $? = 1 ]\n" : "\n");
  }
  write("walk.sh", script + "fleetproof run beacon.toml --exit-zero\nfleetproof run depot.toml\n");
  ASSERT_EQ(shell("sh walk.sh"), 0) << script << read(path("said"));
  EXPECT_NE(read(path("said")).find("rover  violation"), std::string::npos) << read(path("said"));
  EXPECT_NE(read(path("said")).find("beacon"), std::string::npos);
  EXPECT_NE(read(path("said")).find("demonstrated | depot broke"), std::string::npos);
  for (const char* page : {"agents/report.html", "agents/run.html"})
    EXPECT_NE(read(path(page)).find("</html>"), std::string::npos) << page;
}

// Each start in each language, from an empty folder. The commands that `new agent` prints are typed for one of each way
// to build; one project builds all others, because CMake takes its time to look at a compiler.
TEST_F(Package, AStartInEachLanguageRunsAtOnce) {
  const std::vector<std::string> typed = {"c callbacks", "python callbacks", "python straight", "python master"};
  const std::vector<std::string> together = {"c master", "cpp callbacks", "cpp straight", "cpp master"};
  std::string script =
      "set -e\nshort() { sed -i \"s/^replicates = .*/replicates = 2/\" $1/$1.toml; }\n"
      "tried() { fleetproof check $1.toml; fleetproof run $1.toml || case $? in 1|4) ;; *) exit 9;; esac; }\n"
      "start() { fleetproof new agent $1-$2 --language $1 --style $2; short $1-$2; }\n";
  for (const std::string& words : typed) {
    const std::string name = std::regex_replace(words, std::regex(" "), "-");
    script += "start " + words + " | sed -n \"s/^  //p\" > next.sh\nsed -i \"/replay/d; s/fleetproof check.*/tried " +
              name + "/\" next.sh\n(. ./next.sh)\n";
  }
  std::string project = "cmake_minimum_required(VERSION 3.25)\nproject(all C CXX)\n";
  std::string tries;
  for (const std::string& words : together) {
    const std::string name = std::regex_replace(words, std::regex(" "), "-");
    script += "start " + words + "\n";
    project += "add_subdirectory(" + name + ")\nset_target_properties(" + name +
               " PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_SOURCE_DIR}/" + name + "/build)\n";
    tries += "(cd " + name + "; tried " + name + ")\n";
  }
  write("CMakeLists.txt", project);
  write("walk.sh", script + "cmake -B build && cmake --build build\n" + tries);
  ASSERT_EQ(shell("sh walk.sh"), 0) << read(path("said"));
  const std::string said = read(path("said"));
  for (const auto* list : {&typed, &together}) {
    for (const std::string& words : *list) {
      const std::string name = std::regex_replace(words, std::regex(" "), "-");
      EXPECT_NE(said.find(name + " broke the safety distance"), std::string::npos) << name << said;
    }
  }
  EXPECT_EQ(said.find("crash"), std::string::npos) << said;
}

TEST_F(Package, NamesNoFolderOfTheBuild) {
  EXPECT_TRUE(std::filesystem::exists(path("root/usr/bin/fleetproof")));
  const int status = shell("grep -rlF " + test::source("") + " root");
  EXPECT_EQ(WEXITSTATUS(status), 1) << "1 says that grep read all and found nothing: " << read(path("said"));
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
ask 'fleetproof rep' 'simulate one run of a campaign again' 'judge a results file'
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
}  // namespace fleetproof::package_test
