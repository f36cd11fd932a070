// What has one place in the sources, read from the sources: the way out of the program, and the list of packages.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace fleetproof::single_places_test {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = FLEETPROOF_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// The lines of all C++ sources in the folders that match, as "path: line".
std::vector<std::string> lines_with(const std::vector<std::string>& folders, const std::regex& pattern,
                                    const std::string& except) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      const auto extension = entry.path().extension();
      const auto path = entry.path().lexically_relative(kRoot).string();
      if ((extension != ".cpp" && extension != ".hpp") || path.starts_with(except)) continue;
      std::istringstream lines(text_of(entry.path()));
      for (std::string line; std::getline(lines, line);) {
        if (std::regex_search(line.substr(0, line.find("//")), pattern)) found.push_back(path + ": " + line);
      }
    }
  }
  return found;
}

// Text that is written elsewhere is not made printable, and a failed write of it is not noticed.
TEST(SinglePlaces, OnlyStreamsWriteToStandardOutputAndError) {
  const std::regex pattern(
      R"(\bstd::(cout|cerr|clog|puts|printf|fputs)\b|\bfmt::print\b|\bstd(out|err)\b|\bSTD(OUT|ERR)_FILENO, )");
  const std::vector<std::string> rooms = {"core", "laws", "generators", "storage", "reports", "campaign"};
  for (const auto& line : lines_with(rooms, pattern, "campaign/cli/streams.cpp")) {
    // The streams of a worker process are its log.
    const bool of_worker = line.starts_with("campaign/workers/forker.cpp") ||
                           line.starts_with("campaign/workers/worker.cpp") ||
                           line.starts_with("campaign/workers/fatal_signals.cpp") ||
                           line.starts_with("core/sdk/fleetproof/blocking.hpp");  // in a plug-in
    if (!of_worker && line.find("print every event on stderr") == std::string::npos) ADD_FAILURE() << line;
  }
  EXPECT_FALSE(lines_with({"campaign"}, std::regex("STDOUT_FILENO"), "nowhere").empty()) << "the pattern is alive";
}

// The parts of a text that match.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    found.push_back(match->str());
  return found;
}

// A value without a word does not compile (-Wswitch) if name_of is a switch without a default.
const std::regex kNameOf(R"(\n(constexpr )?const char\* name_of\([^\n]*\{[^\n]*\n(\}|[^\n]*\n))");
const std::regex kSwitch(R"(name_of\([A-Za-z:]+ ([a-z_]+)\) \{\n  switch \(\1\) \{\n)");
const std::regex kWithDefault(R"(name_of\([A-Za-z:]+ [a-z_]+\) \{\n(  [^\n]*\n)*  +default:)");

TEST(SinglePlaces, WordsOfAnEnumerationStandInASwitchWithoutDefault) {
  std::size_t tables = 0;
  for (const std::string room : {"core", "laws", "generators", "storage", "reports", "campaign"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / room)) {
      const auto extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      if (entry.path().filename() == "replay.cpp") continue;  // two words for three verdicts, on purpose
      const std::string text = text_of(entry.path());
      for (const std::string& table : matches(text, kNameOf)) {
        ++tables;
        EXPECT_TRUE(std::regex_search(table, kSwitch)) << entry.path() << table;
      }
      EXPECT_EQ(matches(text, kWithDefault), std::vector<std::string>{}) << entry.path();
    }
  }
  EXPECT_GT(tables, 20U);
  const std::string planted = "\nconst char* name_of(A a) {\n  switch (a) {\n    case A::B:\n      return \"b\";\n";
  EXPECT_TRUE(std::regex_search(planted, kSwitch));
  EXPECT_FALSE(std::regex_search("name_of(A a) {\n  return a == A::B ? 1 : 2;\n", kSwitch));
  EXPECT_FALSE(std::regex_search(planted, kWithDefault));
  EXPECT_TRUE(std::regex_search(planted + "    default:\n", kWithDefault));
}

const std::vector<std::string> kRooms = {"core", "laws", "generators", "storage", "reports", "campaign"};

// A fact with one home: a pattern that tells it, its home, and a line that would tell it twice.
struct Home {
  const char *fact, *pattern, *home, *planted;
};
const Home kHomes[] = {
    {"the word of a fault", R"-("(breakdown|protective-stop|load-drop|restart|freeze|power-failure)")-",
     "core/scenario/faults.hpp", R"(if (word == "restart") return;)"},
    {"the flags of an outcome", R"(&Outcome::(stuck|crash|hang|indeterminate|engine_error)\b)",
     "core/outcome/outcome.hpp", "for (const auto flag : {&Outcome::crash, &Outcome::hang})"},
    {"the agent of a run", R"(% *\(?[A-Za-z_.]*(agents|agent_count)\b)", "campaign/plan/plan.hpp",
     "const auto agent = run_index % plan.agents.size();"},
    {"an exit code", R"(\bexit_code(\(\))? *(=|==|!=) *[0-9]|\b128 \+ )", "campaign/cli/",
     "if (input.exit_code == 3) return;"},
    // Of a table, a column says what a line is; of an enumeration, a column or a function says what outranks what.
    {"a place in a table", R"(std::size\(k[A-Z]\w*\) *-|\w::[A-Z]\w+\) *[-+] *[0-9])", "nowhere",
     "const auto some = all.first(std::size(kLines) - kToCompare);"},
    {"an order of values",
     R"((<|>|<=|>=) [A-Z]\w*::[A-Z][a-z]\w*\b(?!::| *[(<])|[^<]\b[A-Z]\w*::[A-Z][a-z]\w* (<|<=|>=) [a-z])", "nowhere",
     "if (outcome.outcome_class() <= OutcomeClass::Hang) return;"},
};

TEST(SinglePlaces, AFactHasOneHome) {
  for (const Home& home : kHomes) {
    const std::regex pattern(home.pattern);
    for (const auto& line : lines_with(kRooms, pattern, home.home)) ADD_FAILURE() << home.fact << ": " << line;
    EXPECT_TRUE(std::regex_search(home.planted, pattern)) << home.fact << ": the pattern is alive";
  }
}

TEST(SinglePlaces, PackagesAreNamedInTheirListAlone) {
  const auto list = text_of(kRoot / ".ci/packages");
  std::istringstream lines(list);
  std::size_t packages = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream columns(line);
    std::string package, when, header;
    if (line.starts_with("#") || !(columns >> package >> when >> header)) continue;
    ++packages;
    EXPECT_TRUE(when == "always" || when == "tests" || when == "bench" || when == "wanted") << line;
    if (header == "-") continue;
    for (const auto* file : {"CMakeLists.txt", "get-started"})
      EXPECT_EQ(text_of(kRoot / file).find(package), std::string::npos) << package << " stands in " << file << " too";
  }
  EXPECT_GT(packages, 15U);
}

}  // namespace
}  // namespace fleetproof::single_places_test
