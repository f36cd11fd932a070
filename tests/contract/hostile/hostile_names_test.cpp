// Names from outside reach terminals, pages and command lines: none of them may steer a terminal, end a line or run a
// command. Every verb is asked, with every kind of name.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/base/outside_text.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::hostile_names_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// Escape sequences, a line end, a C1 control character and a change of direction, as TOML reads them.
const std::string kControls = R"(-\u001b[2J\n\u009b1m\u202e)";
// What input files may hold: a change of direction, a command, quotes, Markdown and HTML, no control characters.
const std::string kPlain = "-\xe2\x80\xae$(touch pwned)`touch pwned`'\"|<b></script>]]>&lt;<!-- end";
const std::string kPlainWritten = R"(-\u202e$(touch pwned)`touch pwned`'\"|<b></script>]]>&lt;<!-- end)";

class HostileNames : public test::ProgramTest {
 protected:
  // Nothing that steers a terminal, on either stream.
  test::Finished checked(const std::string& lines) const {
    const auto finished = shell(lines);
    EXPECT_EQ(printable_lines(finished.out), finished.out) << lines;
    EXPECT_EQ(printable_lines(finished.err), finished.err) << lines;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "pwned")) << lines;
    return finished;
  }
  // The page of a report, also with itself as the baseline: well-formed, and with no markup but its own.
  void expect_sound_page(const std::string& report) const {
    const std::string archive = report.substr(report.find(" report ") + 8);
    for (const std::string& more : {std::string(), " --baseline " + archive}) {
      checked(report + " --exit-zero --html page.html" + more);
      const std::string page = read(path("page.html"));
      EXPECT_EQ(printable_lines(page), page);
      const auto linted = shell("xmllint --noout --nonet page.html");
      EXPECT_EQ(linted.exit_code, 0) << linted.err;
      EXPECT_THAT(page, HasSubstr("&lt;/script&gt;]]&gt;&amp;lt;"));
      for (const char* markup : {"<b>", "]]>", "<!--"}) EXPECT_THAT(page, Not(HasSubstr(markup)));
      for (const char* once : {"<script>", "</script>", "<style>", "</html>"})
        EXPECT_EQ(page.find(once), page.rfind(once)) << once;
      EXPECT_THAT(page, HasSubstr("<script>"));
      std::filesystem::remove(path("page.html"));
    }
  }
  void expect_sound_picture(const std::string& file) const {
    const std::string picture = read(path(file));
    EXPECT_EQ(printable_lines(picture), picture);
    EXPECT_EQ(shell("xmllint --noout --nonet " + file).exit_code, 0);
    EXPECT_THAT(picture, HasSubstr("&lt;/script&gt;]]&gt;&amp;lt;"));
    for (const char* markup : {"<b>", "<!-- ", "<script"}) EXPECT_THAT(picture, Not(HasSubstr(markup)));
  }
  // The names are text on the page and in its data, and no markup.
  void expect_sound_replay_page(const std::string& file) const {
    const std::string page = read(path(file));
    EXPECT_EQ(printable_lines(page), page);
    const auto linted = shell("xmllint --noout --nonet " + file);
    EXPECT_EQ(linted.exit_code, 0) << linted.err;
    EXPECT_THAT(page, HasSubstr("&lt;/script&gt;]]&gt;&amp;lt;"));
    for (const char* markup : {"<b>", "<!-- "}) EXPECT_THAT(page, Not(HasSubstr(markup)));
    for (const char* once : {"<style>", "</style>", "</html>"}) EXPECT_EQ(page.find(once), page.rfind(once)) << once;
  }
  static std::string layout() {
    return R"({"version": 1, "layout": {"name": ")" + kPlainWritten +
           R"(", "floor_low_m": [-5, -5], "floor_high_m": [25, 5],
 "stations": [{"name": ")" +
           kPlainWritten + R"(", "position_m": [0, 0], "purposes": ["storage"]},
  {"name": "b", "position_m": [10, 0], "purposes": ["storage"]}, {"name": "c", "position_m": [20, 0], "purposes": ["storage"]}],
 "segments": [{"name": ")" +
           kPlainWritten + R"( s", "from": ")" + kPlainWritten + R"(", "to": "b", "bidirectional": true},
  {"name": "t", "from": "b", "to": "c", "bidirectional": true}]}})";
  }
  void write_campaign() const {
    write("plant.json", layout());
    write("a.toml", "name = \"" + kPlainWritten +
                        "\"\nhorizon_s = 60\n[factors]\nagents = [\"reckless\"]\nlayouts = [{ file = "
                        "\"plant.json\", name = \"" +
                        kPlainWritten + "\" }]\nfleet_sizes = [2]\n[[gate]]\nagent = \"reckless\"\nname = \"" +
                        kPlainWritten + "\"\n");
  }
};

TEST_F(HostileNames, ACampaignFromTheFirstRunToTheLastReport) {
  write_campaign();
  const auto ran = checked("\"$FLEETPROOF\" run a.toml");
  EXPECT_TRUE(test::has_verdict(ran));
  // The replay line does what it says when a person copies it.
  const auto report = ran.out.find("fleetproof report ");
  ASSERT_NE(report, std::string::npos) << ran.out;
  const auto copied = ran.out.substr(report + 11, ran.out.find('\n', report) - report - 11);
  EXPECT_EQ(checked("\"$FLEETPROOF\" " + copied).exit_code, ran.exit_code) << copied;
  for (const auto* format : {"text", "summary", "markdown", "json"}) {
    const auto page = checked("\"$FLEETPROOF\" " + copied + " --format " + format);
    EXPECT_EQ(page.exit_code, ran.exit_code) << page.err;
    if (std::string(format) == "json") {
      EXPECT_EQ(nlohmann::json::parse(page.out)["campaign"]["name"], kPlain) << "JSON keeps the name to the byte";
    }
  }
  expect_sound_page("\"$FLEETPROOF\" " + copied);
  checked("\"$FLEETPROOF\" check a.toml");
  EXPECT_EQ(checked("\"$FLEETPROOF\" plan a.toml --max-time 1h").exit_code, 0);
  EXPECT_EQ(checked("\"$FLEETPROOF\" plan a.toml --json").exit_code, 0);
  checked("\"$FLEETPROOF\" run a.toml --db \"$(printf 'x\\033[2J\\n.db')\"");
}

// Of campaigns, agents, layouts and gates: refused in one line that shows the name and steers nothing.
TEST_F(HostileNames, ControlCharactersAreRefused) {
  const std::string name = "name = \"" + kControls + "\"", factors = "[factors]\nfleet_sizes = [2]\n",
                    agents = "agents = [\"reckless\"]\n", layouts = "layouts = [\"aisle-grid\"]\n";
  write("plant.json", layout());
  for (const std::string& text : {name + "\n" + factors + agents + layouts,
                                  factors + "agents = [{ agent = \"reckless\", " + name + " }]\n" + layouts,
                                  factors + agents + "layouts = [{ file = \"plant.json\", " + name + " }]\n",
                                  factors + agents + layouts + "[[gate]]\nagent = \"reckless\"\n" + name + "\n"}) {
    write("a.toml", text);
    for (const std::string verb : {"run", "check"}) {
      const auto refused = checked("\"$FLEETPROOF\" " + verb + " a.toml");
      EXPECT_EQ(refused.exit_code, 2) << text << refused.err;
      EXPECT_THAT(refused.err, HasSubstr("[2J"));
      EXPECT_THAT(refused.err, HasSubstr("is refused: a name is UTF-8 without control characters"));
      EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
    }
  }
}

TEST_F(HostileNames, AScenarioThroughReplayAndSimulate) {
  write_campaign();
  checked("\"$FLEETPROOF\" run a.toml --db a.db");
  const auto replayed = checked(
      "\"$FLEETPROOF\" replay a.db 0 --trace --scenario s.json --html p.html "
      "--at 2.5 --svg p.svg");
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(printable_lines(read(path("s.json"))), read(path("s.json")));
  expect_sound_replay_page("p.html");
  expect_sound_picture("p.svg");
  checked("\"$FLEETPROOF\" replay a.db 0 --json");
  const auto simulated = checked(
      "\"$FLEETPROOF\" simulate s.json --agent reckless --trace --html q.html "
      "--at 2.5 --svg q.svg");
  EXPECT_TRUE(test::has_verdict(simulated));
  EXPECT_EQ(nlohmann::json::parse(checked("\"$FLEETPROOF\" simulate s.json --agent reckless --json").out)["scenario"],
            nlohmann::json::parse(read(path("s.json")))["name"]);
  expect_sound_replay_page("q.html");
  expect_sound_picture("q.svg");
  checked("\"$FLEETPROOF\" check s.json");
}

TEST_F(HostileNames, ALayoutThroughImportAndBack) {
  write("plant.json", layout());
  const auto imported = checked("\"$FLEETPROOF\" import layout plant.json --svg p.svg");
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(nlohmann::json::parse(imported.out)["layout"]["name"], kPlain);
  expect_sound_picture("p.svg");
  checked("\"$FLEETPROOF\" import layout plant.json -o p.lif.json && \"$FLEETPROOF\" import lif p.lif.json");
  checked("\"$FLEETPROOF\" import layout plant.json -o p.csv && \"$FLEETPROOF\" import csv p.csv");
}

TEST_F(HostileNames, AnAgentOfASharedObject) {
  const std::string with = "export FLEETPROOF_TEST_AGENT=\"$(printf '" + std::string("%b") +
                           "' '-\\0342\\0200\\0256$(touch pwned) |<b>')\"\n";
  write("a.toml", std::string("horizon_s = 20\n[factors]\nagents = [\"") + FLEETPROOF_NAMED_AGENT +
                      "\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n");
  const auto ran = checked(with + "\"$FLEETPROOF\" run a.toml --db a.db");
  EXPECT_EQ(ran.exit_code, 4) << ran.err;
  for (const auto* format : {"text", "markdown", "json"})
    checked(std::string("\"$FLEETPROOF\" report a.db --format ") + format);
  EXPECT_EQ(checked(with + "\"$FLEETPROOF\" verify a.db").exit_code, 0);
  std::filesystem::remove(path("a.sessions.jsonl"));  // it remembers the file of the agent
  for (const std::string verb : {"replay a.db 0", "verify a.db"})
    EXPECT_THAT(checked("\"$FLEETPROOF\" " + verb).err, HasSubstr("\\u202e$(touch pwned)"));
  EXPECT_EQ(checked(with + "\"$FLEETPROOF\" replay a.db 0 --plugin " + FLEETPROOF_NAMED_AGENT).exit_code, 0);
}

TEST_F(HostileNames, ErrorsAboutFilesAndWords) {
  const std::string file = "\"$(printf 'x\\033[2J\\n\\302\\233.toml')\"";
  for (const std::string verb : {"run", "check", "plan", "sensitivity", "simulate", "report", "verify", "merge",
                                 "missing", "import layout", "import opentcs"}) {
    const auto missing = checked("\"$FLEETPROOF\" " + verb + " " + file);
    EXPECT_EQ(missing.exit_code, 2) << missing.err;
    EXPECT_THAT(missing.err, HasSubstr("x\\x1b[2J\\n\\u009b.toml"));
    EXPECT_EQ(std::ranges::count(missing.err, '\n'), 1) << missing.err;
  }
  for (const std::string words :
       {"list ", "report x --format ", "", "run --", "generate ", "simulate x --law ", "evidence ",
        "evidence clopper-pearson --units 3 --failing ", "evidence fisher --path "}) {
    const auto refused = checked("\"$FLEETPROOF\" " + words + "\"$(printf 'x\\033[2J\\n\\302\\233')\"");
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  }
}

TEST_F(HostileNames, TheNameOfACampaignIsNoPath) {
  std::filesystem::create_directories(folder_ / "deep/er");
  const auto archive_of = [&](const std::string& name) {
    write("deep/er/a.toml",
          "name = \"" + name +
              "\"\nhorizon_s = 1\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n");
    const auto ran = shell("cd deep/er && \"$FLEETPROOF\" run a.toml --overwrite");
    EXPECT_EQ(ran.exit_code, 4) << ran.err;
    std::string found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (entry.path().extension() != ".db") continue;
      EXPECT_EQ(entry.path().parent_path(), folder_ / "deep/er");
      found = entry.path().filename();
      std::filesystem::remove(entry.path());
    }
    return found;
  };
  EXPECT_EQ(archive_of("night run"), "night run.db");
  EXPECT_EQ(archive_of("../../x"), "x.db");
  EXPECT_EQ(archive_of("/tmp/fleetproof-x"), "tmp-fleetproof-x.db");
  EXPECT_EQ(archive_of("a/b"), "a-b.db");
  EXPECT_EQ(archive_of("."), "campaign.db");
  EXPECT_EQ(archive_of(".hidden"), "hidden.db");
  EXPECT_EQ(archive_of("--overwrite"), "overwrite.db");
  std::string accents;
  for (int i = 0; i < 300; ++i) accents += "\xc3\xa9";
  EXPECT_EQ(archive_of(accents), accents.substr(0, 200) + ".db");
}

}  // namespace
}  // namespace fleetproof::hostile_names_test
