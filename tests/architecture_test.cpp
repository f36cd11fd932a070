// The include picture, the homes of heavy headers, and what the model may not call, read from the sources. Sizes and
// formatting: architecture/style_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture_test {
namespace {

namespace fs = std::filesystem;

using architecture::Source;
using architecture::sources;

// Which room may include which rooms (a room may always include itself). Every arrow points down: a room stands below
// all rooms that include it.
const std::map<std::string, std::set<std::string>> kMayInclude = [] {
  const std::set<std::string> core = {"core/base",      "core/geometry", "core/motion", "core/scenario",
                                      "core/clearance", "core/radio",    "core/outcome"};
  const auto with = [](std::set<std::string> rooms, const std::set<std::string>& more) {
    rooms.insert(more.begin(), more.end());
    return rooms;
  };
  const std::set<std::string> generators = {"generators/text",     "generators/map",           "generators/formats",
                                            "generators/families", "generators/scenario_file", "generators/worlds"};
  const std::set<std::string> model = {"core/base", "core/geometry", "core/motion", "core/scenario"};
  std::map<std::string, std::set<std::string>> rooms = {
      {"core/sdk", {}},
      {"core/base", {}},
      {"core/geometry", {"core/base"}},
      {"core/agents", {"core/sdk"}},
      {"core/motion", {"core/base", "core/geometry"}},
      {"core/scenario", {"core/base", "core/geometry", "core/motion"}},
      {"core/clearance", {"core/base", "core/geometry", "core/motion"}},
      {"core/radio", model},
      {"core/outcome", model},
      {"core/engine", with(core, {"core/sdk"})},
      {"laws", {"core/base", "core/geometry", "core/motion", "core/scenario", "core/clearance", "core/outcome"}},
      {"generators/text", {"core/base", "core/geometry"}},
      {"generators/map", with(model, {"generators/text"})},
      {"generators/formats", with(model, {"generators/text", "generators/map"})},
      {"generators/families", with(model, {"generators/text", "generators/map"})},
      {"generators/scenario_file",
       with(model, {"core/radio", "generators/text", "generators/map", "generators/formats"})},
      {"generators/worlds", with(model, {"core/radio", "generators/text", "generators/map", "generators/formats",
                                         "generators/families", "generators/scenario_file"})},
      {"storage", {"core/base", "core/outcome"}},
      {"reports/evidence", {"core/base", "core/outcome", "storage"}},
      {"reports/page", {"core/base", "storage", "reports/evidence"}},
  };
  // The rooms of reports by floors, the lowest first. One floor's rooms do not know each other.
  const std::set<std::string> pages = {"core/base", "storage", "reports/evidence", "reports/page"};
  const std::set<std::string> subjects = {"reports/attempts", "reports/comparison", "reports/findings",
                                          "reports/sensitivity"};
  for (const std::string& subject : subjects) rooms[subject] = pages;
  rooms["reports/markup"] = {"core/base", "reports/page"};
  rooms["reports/sections"] = with(pages, subjects);
  rooms["reports/formats"] = with(pages, {"reports/sections"});
  rooms["reports/campaign_page"] = with(pages, {"reports/sections", "reports/markup"});
  rooms["reports/replay_page"] = {"core/base", "reports/page", "reports/markup"};
  const std::set<std::string> reports =
      with(with(pages, subjects),
           {"reports/sections", "reports/formats", "reports/markup", "reports/campaign_page", "reports/replay_page"});
  rooms["campaign/plan"] = with(with(model, generators), {"core/outcome", "laws", "storage"});
  rooms["campaign/run"] = with(with(core, generators), {"core/engine", "core/sdk", "core/agents", "laws", "storage",
                                                        "reports/evidence", "campaign/plan"});
  rooms["campaign/workers"] = with(rooms["campaign/run"], {"campaign/run"});
  rooms["campaign/batch"] = with(rooms["campaign/workers"], {"campaign/workers"});
  rooms["campaign/shards"] = with(rooms["campaign/batch"], {"campaign/batch"});
  rooms["campaign/shrink"] = with(rooms["campaign/batch"], {"campaign/batch"});
  rooms["campaign/explain"] = with(rooms["campaign/shrink"], {"campaign/shrink"});
  rooms["campaign/findings"] = with(rooms["campaign/explain"], {"campaign/explain"});
  rooms["campaign/watch"] = with(rooms["campaign/run"], {"campaign/run", "reports/page", "reports/formats",
                                                         "reports/markup", "reports/replay_page"});
  rooms["campaign/cli"] =
      with(with(rooms["campaign/findings"], reports), {"campaign/findings", "campaign/shards", "campaign/watch"});
  return rooms;
}();

// The innermost room that a file stands in; empty for a file that stands in none, as in the folder of a room with rooms
// of its own.
std::string room_of(const std::string& path) {
  if (path.starts_with("tests/")) return "tests";
  for (auto room = kMayInclude.rbegin(); room != kMayInclude.rend(); ++room) {  // "reports/evidence" before "reports"
    if (path.starts_with(room->first + "/")) return room->first;
  }
  return {};
}

// Third-party headers that cost seconds to compile: in these sources and in no header.
struct Home {
  std::string prefix;
  std::vector<std::string> allowed;  // path prefixes of .cpp files
};
const std::vector<Home> kHomes = {
    {"fcl/", {"laws/"}},
    {"tbb/", {"campaign/batch/task_pool.cpp"}},
    {"oneapi/", {}},
    {"sqlite3.h", {"storage/"}},
    {"SQLiteCpp/", {"storage/"}},
    {"CLI/", {"campaign/cli/command_line.cpp"}},
    {"boost/math", {"reports/evidence/"}},
    {"boost/multiprecision", {"reports/evidence/release_gate.cpp"}},
    {"boost/graph", {"generators/"}},
    {"boost/random", {"campaign/plan/sobol.cpp"}},
    {"toml++/", {"campaign/plan/toml_table.cpp"}},
    {"pugixml", {"generators/"}},
    {"yaml-cpp/", {"generators/"}},
    {"nlohmann/", {"generators/", "reports/", "campaign/"}},
    {"Random123/", {"core/base/random.cpp"}},
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
  if (room == "tests") return found;
  if (room.empty()) return {source.path + " stands in no room"};
  for (const std::string& include : includes_of(source)) {
    const std::string target = room_of(include);
    if (!target.empty() && target != room && !kMayInclude.at(room).contains(target))
      found.push_back(source.path + " includes " + include);
  }
  return found;
}

std::vector<std::string> homeless_headers(const Source& source) {
  std::vector<std::string> found;
  if (room_of(source.path) == "tests") return found;
  for (const std::string& include : includes_of(source)) {
    if (include.starts_with("Eigen/") && source.path != "core/geometry/pose.hpp")
      found.push_back(source.path + " includes " + include);
    for (const Home& home : kHomes) {
      if (!include.starts_with(home.prefix)) continue;
      const bool at_home =
          std::ranges::any_of(home.allowed, [&](const std::string& prefix) { return source.path.starts_with(prefix); });
      if (!at_home || source.is_header()) found.push_back(source.path + " includes " + include);
    }
  }
  return found;
}

// What would make a result depend on the CPU, the clock or chance.
std::vector<std::string> impure_calls(const Source& source) {
  std::vector<std::string> found;
  const std::string room = room_of(source.path);
  const bool model = room.starts_with("core/") || room.starts_with("generators/") || room == "laws";
  if (!model || room == "core/sdk") return found;
  static const std::regex pattern(
      R"(\b(std::)?(sin|cos|tan|asin|acos|atan|atan2|exp|exp2|log|log2|log10|pow|cbrt|fmod|sincos)\()"
      R"(|steady_clock|system_clock|high_resolution_clock|random_device|\brand\(|mt19937)"
      R"(|unordered_(map|set)|Rotation2D|AngleAxis)");
  for (std::string line : source.lines) {
    line = line.substr(0, line.find("//"));
    if (std::regex_search(line, pattern)) found.push_back(source.path + ": " + line);
  }
  return found;
}

// Whether an arrow of the picture leads back to its own room.
bool reaches(const std::string& from, const std::string& goal, std::set<std::string>& seen) {
  return std::ranges::any_of(kMayInclude.at(from), [&](const std::string& next) {
    return next == goal || (seen.insert(next).second && reaches(next, goal, seen));
  });
}

std::vector<std::string> names_used_twice() {
  std::map<std::string, std::string> first;
  std::vector<std::string> found;
  for (const Source& source : sources()) {
    const auto [at, fresh] = first.emplace(fs::path(source.path).filename().string(), source.path);
    if (!fresh) found.push_back(at->second + " and " + source.path);
  }
  return found;
}

TEST(Architecture, ThePictureHasNoCircle) {
  for (const auto& [room, below] : kMayInclude) {
    std::set<std::string> seen;
    EXPECT_FALSE(reaches(room, room, seen)) << room;
  }
}
TEST(Architecture, NoTwoFilesHaveOneName) { EXPECT_EQ(names_used_twice(), std::vector<std::string>{}); }
TEST(Architecture, ReadsTheWholeTree) { EXPECT_GT(sources().size(), 80U); }
TEST(Architecture, IncludesFollowThePicture) { architecture::expect_none(sources(), forbidden_includes); }
TEST(Architecture, HeavyHeadersStayAtHome) { architecture::expect_none(sources(), homeless_headers); }
TEST(Architecture, TheModelCallsNothingImpure) { architecture::expect_none(sources(), impure_calls); }

TEST(Architecture, FindsWhatIsPlanted) {
  EXPECT_EQ(forbidden_includes({"core/engine/world.cpp", {"#include \"laws/laws.hpp\""}}).size(), 1U);
  EXPECT_EQ(forbidden_includes({"core/agents/a.cpp", {"#include \"core/motion/piece.hpp\""}}).size(), 1U);
  EXPECT_EQ(forbidden_includes({"laws/a.cpp", {"#include \"core/motion/piece.hpp\"", "#include <vector>"}}).size(), 0U);
  EXPECT_EQ(homeless_headers({"laws/a.hpp", {"#include <fcl/fcl.h>"}}).size(), 1U);
  EXPECT_EQ(homeless_headers({"core/base/a.cpp", {"#include <Eigen/Geometry>"}}).size(), 1U);
  EXPECT_EQ(impure_calls({"core/base/a.cpp", {"double y = std::sin(x);"}}).size(), 1U);
  EXPECT_EQ(impure_calls({"core/base/a.cpp", {"double y = std::sqrt(x);  // not sin(x)"}}).size(), 0U);
}

}  // namespace
}  // namespace fleetproof::architecture_test
