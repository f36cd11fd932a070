// Output files: whole or not at all, and never in the place of another kind of file.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/support/program.hpp"

namespace fleetproof::output_files_test {
namespace {

using testing::HasSubstr;

class OutputFiles : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml",
          "horizon_s = 20\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
    run("run a.toml --db a.db");
    ASSERT_EQ(run("generate fishbone -o layout.json --svg picture.svg").exit_code, 0);
    run("report a.db -o report.txt");
    run("report a.db --format markdown -o report.md");
    run("report a.db --format json -o report.json");
    run("report a.db --html report.html");
    run("import layout layout.json -o tables.csv");
    run("import layout layout.json -o vda.lif.json");
    ASSERT_EQ(run("replay a.db 0 --scenario scenario.json --html case.html").exit_code, 0);
  }
};

// Each option over each file: its own kind is replaced, all else stays.
TEST_F(OutputFiles, ReplaceOnlyTheirOwnKind) {
  write("notes.txt", "mine\n");
  write("data.json", "{\"mine\": true}\n");
  write("empty", "");
  const std::vector<std::string> files = {"a.toml",        "a.db",        "layout.json", "picture.svg", "report.txt",
                                          "report.md",     "report.json", "tables.csv",  "report.html", "vda.lif.json",
                                          "scenario.json", "case.html",   "notes.txt",   "data.json"};
  struct Option {
    std::string words;
    std::set<std::string> own;
  };
  const Option options[] = {{"generate fishbone -o ", {"layout.json", "tables.csv", "vda.lif.json"}},
                            {"generate fishbone --svg ", {"picture.svg"}},
                            {"import layout layout.json --svg ", {"picture.svg"}},
                            {"replay a.db 0 --scenario ", {"scenario.json"}},
                            {"replay a.db 0 --html ", {"case.html"}},
                            {"replay a.db 0 --at 5 --svg ", {"picture.svg"}},
                            {"report a.db -o ", {"report.txt", "report.md", "report.json", "report.html"}},
                            {"report a.db --html ", {"report.txt", "report.md", "report.json", "report.html"}},
                            {"report a.db --json -o ", {"report.txt", "report.md", "report.json", "report.html"}}};
  for (const auto& option : options) {
    for (const auto& file : files) {
      const auto before = read(path(file));
      const auto finished = run(option.words + file);
      if (option.own.contains(file)) {
        EXPECT_NE(finished.exit_code, 2) << option.words << file << "\n" << finished.err;
      } else {
        EXPECT_EQ(finished.exit_code, 2) << option.words << file;
        EXPECT_THAT(finished.err, HasSubstr(file + ": is there already and is not ")) << option.words;
        EXPECT_EQ(read(path(file)), before) << option.words << file;
      }
      write(file, before);
    }
    EXPECT_NE(run(option.words + "empty").exit_code, 2) << option.words;
    EXPECT_NE(read(path("empty")), "");
    write("empty", "");
  }
  EXPECT_EQ(run("import layout layout.json -o tables.csv").exit_code, 0);
  EXPECT_EQ(run("import layout layout.json -o vda.lif.json").exit_code, 0);
  EXPECT_EQ(run("generate fishbone -o drawn.csv").exit_code, 0);
  EXPECT_EQ(read(path("drawn.csv")), read(path("tables.csv"))) << "by its name a table, as import writes it";
  write("mine.csv", "name,age\n");
  EXPECT_EQ(run("import layout layout.json -o mine.csv").exit_code, 2);
}

// The second run of a command replaces what the first one left, however large that is.
TEST_F(OutputFiles, ReplaceTheirOwnKindAboveTheLimitOfInputs) {
  const std::string much((std::size_t{64} << 20) + 1, ' ');
  for (const char* option : {"--chrome-trace", "--pieces", "--trace-output"}) {
    const std::string replay = std::string("replay a.db 0 ") + option + " large";
    ASSERT_EQ(run(replay).exit_code, 0);
    const std::string first = read(path("large"));
    write("large", first + much);
    EXPECT_EQ(run(replay).exit_code, 0) << option;
    EXPECT_EQ(read(path("large")), first) << option;
    write("large", "{\"mine\": true}" + much);
    EXPECT_THAT(run(replay).err, HasSubstr("large: is there already and is not ")) << option;
    std::filesystem::remove(path("large"));
  }
}

TEST_F(OutputFiles, KeepTheirLinkAndTheirPermissions) {
  std::filesystem::create_symlink("layout.json", path("link.json"));
  std::filesystem::permissions(path("layout.json"), std::filesystem::perms(0640));
  const auto before = read(path("layout.json"));
  ASSERT_EQ(run("generate fishbone --seed 5 -o link.json").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.json")));
  EXPECT_NE(read(path("layout.json")), before);
  EXPECT_EQ(std::filesystem::status(path("layout.json")).permissions(), std::filesystem::perms(0640));
  std::filesystem::create_symlink("nowhere.json", path("dangling.json"));
  EXPECT_EQ(run("generate fishbone -o dangling.json").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("nowhere.json")));
}

TEST_F(OutputFiles, AreNamedInTheirErrors) {
  EXPECT_THAT(
      run("report a.db -o nowhere/r.txt").err,
      HasSubstr("nowhere/r.txt: cannot be written (No such file or directory); choose another path for --output"));
  EXPECT_THAT(
      run("report a.db --html nowhere/r.html").err,
      HasSubstr("nowhere/r.html: cannot be written (No such file or directory); choose another path for --html"));
  for (const char* no_file : {"/dev/full", "/dev/null", "."})
    EXPECT_EQ(run(std::string("report a.db --html ") + no_file).exit_code, 2) << no_file;
  EXPECT_THAT(run("replay a.db 0 --scenario a.toml/s.json").err,
              HasSubstr("a.toml/s.json: cannot be written (Not a directory); choose another path for --scenario"));
  EXPECT_EQ(run("generate fishbone -o ''").exit_code, 0) << "no path: standard output";
}

}  // namespace
}  // namespace fleetproof::output_files_test
