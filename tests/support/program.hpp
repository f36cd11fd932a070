#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

// Runs the built program as a user would.
namespace fleetproof::test {

struct Finished {
  int exit_code = -1;
  std::string out, err;
};

// Whether the program came to a verdict: demonstrated (0), violated (1) or not demonstrated (4).
inline testing::AssertionResult has_verdict(const Finished& finished) {
  if (finished.exit_code == 0 || finished.exit_code == 1 || finished.exit_code == 4) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "exit code " << finished.exit_code << "\n" << finished.out << finished.err;
}

class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("fleetproof-") + info->test_suite_name() + "-" + info->name() + "-XXXXXX";
    std::ranges::replace(name, '/', '-');  // tests with parameters have one in their names
    name = (std::filesystem::temp_directory_path() / name).string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr) << name;
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  static std::string read(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

  // The words are given to the shell; runs in the test's folder.
  Finished run(const std::string& words) const { return shell("\"$FLEETPROOF\" " + words); }

  // Lines for bash in the test's folder, where $FLEETPROOF is the program. A hanging program is stopped: exit code 124.
  Finished shell(const std::string& lines) const {
    write("command.sh", "cd '" + folder_.string() + "'\n" + lines + "\n");
    const std::string command = std::string("FLEETPROOF='") + FLEETPROOF_PROGRAM + "' timeout 600 bash '" +
                                path("command.sh") + "' >'" + path("stdout.txt") + "' 2>'" + path("stderr.txt") +
                                "' </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(path("stdout.txt")), read(path("stderr.txt"))};
  }

  std::filesystem::path folder_;
};

inline std::string source(const std::string& file) { return std::string(FLEETPROOF_SOURCE_DIR) + "/" + file; }

}  // namespace fleetproof::test
