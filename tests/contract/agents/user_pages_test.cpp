// The pages for users are followed literally, from an empty folder: files are saved, commands are typed in.
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.hpp"

namespace fleetproof::user_pages_test {
namespace {

using test::source;

// Text between fences: its language, the file name in the sentence "Save this as `NAME`" above it, and its section.
struct Block {
  std::string language, saved_as, text, section;
};

std::string name_to_save(const std::string& paragraph) {
  const auto save = paragraph.find("ave this");
  const auto open = save == std::string::npos ? save : paragraph.find('`', save);
  return open == std::string::npos ? "" : paragraph.substr(open + 1, paragraph.find('`', open + 1) - open - 1);
}

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream lines(page);
  std::string section, paragraph, before;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), name_to_save(paragraph), "", section});
      paragraph.clear();
    } else if (inside) {
      blocks.back().text += line + "\n";
    } else {
      if (line.starts_with("## ")) section = line.substr(3);
      if (before.empty() && !line.empty()) paragraph.clear();
      paragraph += line + " ";
    }
    before = line;
  }
  return blocks;
}

class UserPages : public test::ProgramTest {
 protected:
  // All files are saved first, as a reader has them before the commands that use them.
  test::Finished follow(const std::vector<Block>& blocks) const {
    std::string commands = "mkdir bin && ln -s \"$FLEETPROOF\" bin/fleetproof && export PATH=$PWD/bin:$PATH\n";
    commands += "export FLEETPROOF='" + source("") + "'\n";
    for (const Block& block : blocks) {
      if (!block.saved_as.empty()) {
        write(block.saved_as, block.text);
      } else if (block.language == "sh") {
        commands += block.text;
      }
    }
    return shell(commands);
  }
};

TEST_F(UserPages, APlantOfOnesOwnIsDemonstratedAsThePageSays) {
  const std::vector<Block> blocks = blocks_of(read(source("campaign/own-plant.md")));
  const test::Finished finished = follow(blocks);
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  EXPECT_NE(finished.out.find("hull-lock broke the safety distance of 0.10 m in 0 of 32 runs"), std::string::npos)
      << finished.out << finished.err;
  EXPECT_NE(read(path("report.html")).find("</html>"), std::string::npos);
  std::size_t shown = 0;
  for (const Block& block : blocks) {
    if (block.text.starts_with("plant.csv: ")) {
      ++shown;
      EXPECT_NE((finished.out + finished.err).find(block.text), std::string::npos) << block.text << finished.err;
    }
    if (block.text.starts_with("# vehicles of")) {
      ++shown;
      EXPECT_EQ(read(path("vehicles.toml")), block.text);
    }
  }
  EXPECT_EQ(shown, 2U);
}

// The commands are typed in the folder of the sources: here one that has what they name.
TEST_F(UserPages, ACentralFleetIsTriedAndItsFaultFoundAsThePageSays) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the page builds the fleet without sanitizers";
#endif
  ASSERT_EQ(shell("ln -s '" + source("core") +
                  "' core && mkdir -p build/default tests && ln -s \"$FLEETPROOF\" "
                  "build/default/fleetproof && cp -r '" +
                  source("tests/examples") + "' tests/")
                .exit_code,
            0);
  const std::vector<Block> blocks = blocks_of(read(source("core/sdk/central-fleet.md")));
  const test::Finished finished = follow(blocks);
  EXPECT_EQ(finished.exit_code, 1) << "the last command shows the smallest failure; " << finished.err;
  EXPECT_NE(finished.out.find("as expected: contact"), std::string::npos) << finished.out << finished.err;
  std::size_t shown = 0;
  for (const Block& block : blocks) {
    if (block.language != "text") continue;
    ++shown;
    EXPECT_NE(finished.out.find(block.text), std::string::npos) << block.text << finished.out << finished.err;
  }
  EXPECT_EQ(shown, 3U);
  EXPECT_EQ(run("report depot.db").exit_code, 0) << "it is safe, and delivers loads";
  EXPECT_EQ(run("report impatient.db").exit_code, 1);
  for (const char* page : {"build/good.html", "build/run.html", "build/small.html"})
    EXPECT_NE(read(path(page)).find("</html>"), std::string::npos) << page;
}

// An installation has the same campaign beside the source; only the place of the shared object differs.
TEST_F(UserPages, TheInstalledCampaignOfTheCentralFleetIsThatOfThePage) {
  const test::Finished finished = shell("sed 's|../../build/|build/|g' '" + source("tests/examples/depot.toml") + "'");
  EXPECT_EQ(finished.out, read(source("tests/examples/installed/depot.toml")));
}

class OtherLanguages : public UserPages {
 protected:
  void SetUp() override {
    UserPages::SetUp();
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the runtimes of other languages are not built for sanitizers";
#endif
  }

  // The campaign and one language. The other commands of the section on the campaign choose an installed program.
  test::Finished follow_language(const std::string& language) const {
    std::vector<Block> blocks;
    for (Block& block : blocks_of(read(source("core/sdk/other-languages.md")))) {
      if (block.section == language || block.saved_as == "rover.toml") blocks.push_back(std::move(block));
    }
    return follow(blocks);
  }
};

void expect_the_rover(const test::Finished& finished) {
  EXPECT_NE(finished.out.find("rover broke the safety distance of 0.10 m in 16 of 20 runs;"), std::string::npos)
      << finished.out << finished.err;
}

TEST_F(OtherLanguages, AnAgentInRust) {
  if (shell("command -v rustc").exit_code != 0) GTEST_SKIP() << "there is no rustc";
  expect_the_rover(follow_language("Rust"));
}

TEST_F(OtherLanguages, AnAgentInGo) {
  if (shell("command -v go && command -v gcc").exit_code != 0) GTEST_SKIP() << "there is no Go, or no C compiler";
  expect_the_rover(follow_language("Go"));
}

TEST_F(OtherLanguages, AnAgentInPython) {
  if (shell("/usr/bin/python3-config --includes && command -v gcc").exit_code != 0)
    GTEST_SKIP() << "there are no headers of Python, or no C compiler";
  const test::Finished finished = follow_language("Python");
  expect_the_rover(finished);
  EXPECT_NE(finished.out.find("rover run 0: contact"), std::string::npos)
      << "the last command simulates the saved scenario; " << finished.out << finished.err;
}

}  // namespace
}  // namespace fleetproof::user_pages_test
