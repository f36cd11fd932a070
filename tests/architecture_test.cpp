// The include picture, the homes of heavy headers, what the model may not call, and the sizes of files and functions, read from the sources.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Source {
  std::string path;  // from the project's root
  std::vector<std::string> lines;
  bool is_header() const { return path.ends_with(".hpp") || path.ends_with(".h"); }
};

// Longest prefix first.
const std::vector<std::string> kRooms = {"core/sdk", "core/agents", "campaign/cli", "reports/evidence", "core",
                                         "laws",     "generators",  "storage",      "campaign",         "reports", "tests"};

std::string room_of(const std::string& path) {
  for (const std::string& room : kRooms) {
    if (path.starts_with(room + "/")) return room;
  }
  return {};
}

// Who may include whom (a room may always include itself).
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core/sdk", {}},
    {"core/agents", {"core/sdk"}},
    {"core", {"core/sdk"}},
    {"laws", {"core"}},
    {"generators", {"core"}},
    {"storage", {"core"}},
    {"reports/evidence", {"core", "storage"}},
    {"reports", {"core", "storage", "reports/evidence"}},
    {"campaign", {"core", "core/sdk", "core/agents", "laws", "generators", "storage", "reports/evidence"}},
    {"campaign/cli", {"core", "core/sdk", "core/agents", "laws", "generators", "storage", "campaign", "reports", "reports/evidence"}},
};

// Third-party headers that cost seconds to compile: in these sources and in no header.
struct Home {
  std::string prefix;
  std::vector<std::string> allowed;  // path prefixes of .cpp files
};
const std::vector<Home> kHomes = {
    {"fcl/", {"laws/"}},
    {"tbb/", {"campaign/task_pool.cpp"}},
    {"oneapi/", {}},
    {"sqlite3.h", {"storage/"}},
    {"SQLiteCpp/", {"storage/"}},
    {"CLI/", {"campaign/cli/command_line.cpp"}},
    {"boost/math", {"reports/evidence/"}},
    {"boost/graph", {"generators/"}},
    {"boost/random", {"campaign/sobol.cpp"}},
    {"toml++/", {"campaign/toml_table.cpp"}},
    {"pugixml", {"generators/"}},
    {"yaml-cpp/", {"generators/"}},
    {"nlohmann/", {"generators/", "reports/", "campaign/"}},
    {"Random123/", {"core/random.cpp"}},
    {"xxhash.h", {"core/", "generators/", "storage/"}},
};

std::vector<std::string> includes_of(const Source& source) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::vector<std::string> all;
  std::smatch match;
  for (const std::string& line : source.lines) {
    if (std::regex_search(line, match, pattern)) all.push_back(match[1]);
  }
  return all;
}

std::vector<std::string> forbidden_includes(const Source& source) {
  std::vector<std::string> found;
  const std::string room = room_of(source.path);
  if (room == "tests" || room.empty()) return found;
  for (const std::string& include : includes_of(source)) {
    const std::string target = room_of(include);
    if (!target.empty() && target != room && !kMayInclude.at(room).contains(target)) found.push_back(source.path + " includes " + include);
  }
  return found;
}

std::vector<std::string> homeless_headers(const Source& source) {
  std::vector<std::string> found;
  if (room_of(source.path) == "tests") return found;
  for (const std::string& include : includes_of(source)) {
    if (include.starts_with("Eigen/") && source.path != "core/geometry/pose.hpp") found.push_back(source.path + " includes " + include);
    for (const Home& home : kHomes) {
      if (!include.starts_with(home.prefix)) continue;
      const bool at_home = std::ranges::any_of(home.allowed, [&](const std::string& prefix) { return source.path.starts_with(prefix); });
      if (!at_home || source.is_header()) found.push_back(source.path + " includes " + include);
    }
  }
  return found;
}

// What would make a result depend on the CPU, the clock or chance.
std::vector<std::string> impure_calls(const Source& source) {
  std::vector<std::string> found;
  const std::string room = room_of(source.path);
  if (!std::set<std::string>{"core", "core/agents", "laws", "generators"}.contains(room)) return found;
  static const std::regex pattern(
      R"(\b(std::)?(sin|cos|tan|asin|acos|atan|atan2|exp|exp2|log|log2|log10|pow|cbrt|fmod|sincos)\(|steady_clock|system_clock|high_resolution_clock|random_device|\brand\(|mt19937|unordered_(map|set)|Rotation2D|AngleAxis)");
  for (std::string line : source.lines) {
    line = line.substr(0, line.find("//"));
    if (std::regex_search(line, pattern)) found.push_back(source.path + ": " + line);
  }
  return found;
}

std::vector<std::string> too_long(const Source& source) {
  std::vector<std::string> found;
  const std::size_t most = source.is_header() && room_of(source.path) != "tests" ? 260 : 400;
  if (source.lines.size() > most) found.push_back(source.path + " has " + std::to_string(source.lines.size()) + " lines");
  // A function's body begins on an unindented line that ends in ") ... {" and ends with the next unindented brace.
  static const std::regex opening(R"(^[A-Za-z].*\).*\{$)");
  std::size_t begin = 0;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const std::string& line = source.lines[i];
    if (begin == 0 && std::regex_search(line, opening)) begin = i + 1;
    if (begin != 0 && line == "}") {
      if (i + 1 - begin > 70) found.push_back(source.path + ":" + std::to_string(begin) + " is a function of " + std::to_string(i + 1 - begin) + " lines");
      begin = 0;
    }
  }
  return found;
}

const std::vector<Source>& sources() {
  static const std::vector<Source> all = [] {
    std::vector<Source> found;
    const fs::path root = FLEETPROOF_SOURCE_DIR;
    for (const char* folder : {"core", "campaign", "generators", "laws", "storage", "reports", "tests"}) {
      for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".cpp" && extension != ".hpp" && extension != ".h" && extension != ".c") continue;
        Source source{fs::relative(entry.path(), root).generic_string(), {}};
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) source.lines.push_back(line);
        found.push_back(std::move(source));
      }
    }
    return found;
  }();
  return all;
}

template <class Check>
void expect_none(Check check) {
  std::ostringstream list;
  for (const Source& source : sources()) {
    for (const std::string& finding : check(source)) list << "\n  " << finding;
  }
  EXPECT_EQ(list.str(), "");
}

TEST(Architecture, ReadsTheWholeTree) { EXPECT_GT(sources().size(), 80U); }
TEST(Architecture, IncludesFollowThePicture) { expect_none(forbidden_includes); }
TEST(Architecture, HeavyHeadersStayAtHome) { expect_none(homeless_headers); }
TEST(Architecture, TheModelCallsNothingImpure) { expect_none(impure_calls); }
TEST(Architecture, FilesAndFunctionsFitAReader) { expect_none(too_long); }

TEST(Architecture, FindsWhatIsPlanted) {
  EXPECT_EQ(forbidden_includes({"core/world.cpp", {"#include \"laws/laws.hpp\""}}).size(), 1U);
  EXPECT_EQ(forbidden_includes({"core/agents/a.cpp", {"#include \"core/piece.hpp\""}}).size(), 1U);
  EXPECT_EQ(forbidden_includes({"laws/a.cpp", {"#include \"core/piece.hpp\"", "#include <vector>"}}).size(), 0U);
  EXPECT_EQ(homeless_headers({"laws/a.hpp", {"#include <fcl/fcl.h>"}}).size(), 1U);
  EXPECT_EQ(homeless_headers({"core/a.cpp", {"#include <Eigen/Geometry>"}}).size(), 1U);
  EXPECT_EQ(impure_calls({"core/a.cpp", {"double y = std::sin(x);"}}).size(), 1U);
  EXPECT_EQ(impure_calls({"core/a.cpp", {"double y = std::sqrt(x);  // not sin(x)"}}).size(), 0U);
  std::vector<std::string> body = {"void f() {"};
  body.resize(80, "  g();");
  body.push_back("}");
  EXPECT_EQ(too_long({"core/a.cpp", body}).size(), 1U);
}

}  // namespace
