// The include picture, the homes of heavy headers, and what the model may not call, read from the sources. Sizes and
// formatting: architecture/style_test.cpp. The picture for readers is in ARCHITECTURE.md; the tests compare both.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
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
      {"core/bridges", {"core/agents", "core/sdk"}},
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
  rooms["reports/comparison"].insert("core/outcome");  // it compares runs one by one
  rooms["reports/markup"] = {"core/base", "reports/page"};
  rooms["reports/sections"] = with(pages, subjects);
  rooms["reports/formats"] = with(pages, {"core/outcome", "reports/sections"});  // tables of judged runs
  rooms["reports/campaign_page"] = with(pages, {"reports/sections", "reports/markup"});
  rooms["reports/replay_page"] = {"core/base", "core/outcome", "reports/page", "reports/markup"};
  const std::set<std::string> reports =
      with(with(pages, subjects),
           {"reports/sections", "reports/formats", "reports/markup", "reports/campaign_page", "reports/replay_page"});
  rooms["campaign/plan"] = with(with(model, generators), {"core/outcome", "core/bridges", "laws", "storage"});
  rooms["campaign/run"] = with(with(core, generators), {"core/engine", "core/sdk", "core/agents", "core/bridges",
                                                        "laws", "storage", "reports/evidence", "campaign/plan"});
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

// Folders of sources inside a room, each with the reason why they are no rooms of their own.
const std::map<std::string, std::string> kInsideARoom = {
    {"campaign/cli/evidence", "one verb of campaign/cli"},
    {"core/agents/central", "the pair of core/agents for fleets with a computer"},
    {"core/bridges/lockstep", "one way in of core/bridges"},
    {"core/bridges/mqtt", "a broker and its clients, of core/bridges"},
    {"core/bridges/stream", "a small TCP, of core/bridges"},
    {"core/bridges/vda5050", "VDA 5050, of core/bridges"},
    {"core/bridges/wrapped", "the faults around any way in, of core/bridges"},
    {"core/agents/faulty", "the faulty agents of core/agents"},
    {"core/sdk/starting", "programs of core/sdk to start from: data of the verb new"},
    {"core/sdk/fleetproof", "the headers of core/sdk, under the name by which agents include them"},
};

// The innermost room that a file stands in; empty for a file that stands in none, as in the folder of a room with rooms
// of its own.
std::string room_of(const std::string& path) {
  if (path.starts_with("tests/")) return "tests";
  for (auto room = kMayInclude.rbegin(); room != kMayInclude.rend(); ++room) {  // "reports/evidence" before "reports"
    if (path.starts_with(room->first + "/")) return room->first;
  }
  return {};
}

// The one header with a third-party header: agents in straight-line code include it, and nothing of the product does.
const std::string kFiberHeader = "core/sdk/fleetproof/fiber.hpp";

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
    {"boost/context", {kFiberHeader}},
    {"boost/math", {"reports/evidence/"}},
    {"boost/multiprecision", {"reports/evidence/release_gate.cpp"}},
    {"boost/graph", {"generators/"}},
    {"boost/random", {"campaign/plan/sobol.cpp"}},
    {"toml++/", {"campaign/plan/toml_table.cpp"}},
    {"pugixml", {"generators/"}},
    {"yaml-cpp/", {"generators/"}},
    {"nlohmann/json.hpp", {"core/base/json_text.cpp", "core/bridges/", "generators/", "reports/", "campaign/"}},
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
      if (!at_home || (source.is_header() && source.path != kFiberHeader))
        found.push_back(source.path + " includes " + include);
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

// ---- folders that the picture does not know

std::string top_of(const std::string& path) { return path.substr(0, path.find('/')); }

std::vector<std::string> unknown_folder(const Source& source) {
  const std::string folder = fs::path(source.path).parent_path().generic_string();
  if (top_of(folder) == "tests" || kMayInclude.contains(folder) || kInsideARoom.contains(folder)) return {};
  return {source.path + " stands in a folder that kMayInclude does not know"};
}

bool holds_sources(const fs::path& folder) {
  return std::any_of(fs::recursive_directory_iterator(folder), {}, [](const fs::directory_entry& entry) {
    const std::string ending = entry.path().extension().string();
    return ending == ".cpp" || ending == ".hpp" || ending == ".h" || ending == ".c";
  });
}

// Of the folders at the top level of the tree; what tools leave there is no part of the tree.
std::vector<std::string> unknown_top_folders(const fs::path& root) {
  std::set<std::string> known = {"tests", "build"};
  for (const auto& [room, below] : kMayInclude) known.insert(top_of(room));
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && !name.starts_with('.') && !known.contains(name) && holds_sources(entry.path()))
      found.push_back(name);
  }
  return found;
}

// ---- the picture in ARCHITECTURE.md

// 1 for a room that includes no other room; else one more than the highest room that it may include.
int floor_of(const std::string& room) {
  static std::map<std::string, int> floors;
  if (const auto known = floors.find(room); known != floors.end()) return known->second;
  int below = 0;
  for (const std::string& next : kMayInclude.at(room)) below = std::max(below, floor_of(next));
  return floors[room] = below + 1;
}

// All rooms of a folder but `self`, each by its name in the folder.
std::vector<std::string> rooms_in(const std::string& folder, const std::string& self) {
  std::vector<std::string> names;
  for (const auto& [room, below] : kMayInclude) {
    if (room != self && room.starts_with(folder + "/")) names.push_back(room.substr(folder.size() + 1));
  }
  return names;
}

// What a room may include, in short: "core/{base,geometry} laws"; "core/*" for all rooms of a folder but itself.
std::string arrows_of(const std::string& room) {
  std::map<std::string, std::vector<std::string>> inner;  // by folder
  std::string text;
  for (const std::string& next : kMayInclude.at(room)) {
    if (next.find('/') == std::string::npos) {
      inner[next];
    } else {
      inner[top_of(next)].push_back(next.substr(next.find('/') + 1));
    }
  }
  for (const auto& [folder, names] : inner) {
    if (kMayInclude.at(room).contains(folder)) text += " " + folder;
    if (names.empty()) continue;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
    if (names.size() > 1 && names == rooms_in(folder, room)) {
      list = "*";
    } else if (names.size() > 1) {
      list = "{" + list + "}";
    }
    text += " " + folder + "/" + list;
  }
  return text;
}

// Each room with its floor, the highest first.
std::vector<std::string> expected_picture() {
  constexpr std::size_t kMargin = 28, kColumns = 120;
  std::set<std::pair<int, std::string>> order;
  for (const auto& [room, below] : kMayInclude) order.emplace(-floor_of(room), room);
  std::vector<std::string> lines;
  for (const auto& [minus_floor, room] : order) {
    std::string line = (minus_floor > -10 ? " " : "") + std::to_string(-minus_floor) + "  " + room;
    std::istringstream arrows(arrows_of(room));
    for (std::string arrow; arrows >> arrow; line += " " + arrow) {
      if (line.size() + 1 + arrow.size() > kColumns) lines.push_back(std::exchange(line, ""));
      line.resize(std::max(line.size(), kMargin), ' ');
    }
    lines.push_back(line);
  }
  return lines;
}

// The lines between the first two fences after a heading.
std::vector<std::string> block_below(const std::string& heading) {
  std::ifstream page(std::string(FLEETPROOF_SOURCE_DIR) + "/ARCHITECTURE.md");
  std::vector<std::string> lines;
  bool found = false, inside = false;
  for (std::string line; std::getline(page, line);) {
    found = found || line == heading;
    if (!found) continue;
    if (line.starts_with("```")) {
      if (inside) break;
      inside = true;
    } else if (inside) {
      lines.push_back(line);
    }
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// Which folder of the top level may include which.
std::set<std::pair<std::string, std::string>> arrows_between_folders() {
  std::set<std::pair<std::string, std::string>> arrows;
  for (const auto& [room, below] : kMayInclude) {
    for (const std::string& next : below) {
      if (top_of(room) != top_of(next)) arrows.emplace(top_of(room), top_of(next));
    }
  }
  return arrows;
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
TEST(Architecture, ThePictureKnowsEveryFolder) {
  architecture::expect_none(sources(), unknown_folder);
  EXPECT_EQ(unknown_top_folders(FLEETPROOF_SOURCE_DIR), std::vector<std::string>{});
  for (const auto& [folder, reason] : kInsideARoom) {
    EXPECT_FALSE(kMayInclude.contains(folder)) << folder << " is a room: take it out of kInsideARoom";
    EXPECT_TRUE(fs::is_directory(fs::path(FLEETPROOF_SOURCE_DIR) / folder)) << folder << " does not exist";
  }
}

TEST(Architecture, TheMapShowsThePicture) {
  const std::vector<std::string> expected = expected_picture();
  EXPECT_TRUE(block_below("### Rooms") == expected)
      << "the block below \"### Rooms\" of ARCHITECTURE.md must be this:\n"
      << joined(expected);
}

// Each folder has one line in the drawing, "| NAME:"; its arrows point to lines below it.
TEST(Architecture, TheMapDrawsEveryArrowDownwards) {
  const std::vector<std::string> drawing = block_below("## The house");
  const auto line_of = [&](const std::string& folder) {
    const auto line = std::ranges::find_if(
        drawing, [&](const std::string& text) { return text.find("| " + folder + ":") != std::string::npos; });
    EXPECT_NE(line, drawing.end()) << folder << " is missing in the drawing";
    return line - drawing.begin();
  };
  for (const auto& [from, to] : arrows_between_folders()) EXPECT_LT(line_of(from), line_of(to)) << from << " -> " << to;
}

TEST(Architecture, HeavyHeadersStayAtHome) { architecture::expect_none(sources(), homeless_headers); }
TEST(Architecture, TheModelCallsNothingImpure) { architecture::expect_none(sources(), impure_calls); }

TEST(Architecture, FindsWhatIsPlanted) {
  EXPECT_EQ(forbidden_includes({"core/engine/world.cpp", {"#include \"laws/laws.hpp\""}}).size(), 1U);
  EXPECT_EQ(forbidden_includes({"core/agents/a.cpp", {"#include \"core/motion/piece.hpp\""}}).size(), 1U);
  EXPECT_EQ(forbidden_includes({"laws/a.cpp", {"#include \"core/motion/piece.hpp\"", "#include <vector>"}}).size(), 0U);
  EXPECT_EQ(homeless_headers({"laws/a.hpp", {"#include <fcl/fcl.h>"}}).size(), 1U);
  EXPECT_EQ(homeless_headers({"core/base/a.cpp", {"#include <Eigen/Geometry>"}}).size(), 1U);
  EXPECT_EQ(homeless_headers({"core/sdk/a.hpp", {"#include <boost/context/fiber.hpp>"}}).size(), 1U);
  EXPECT_EQ(
      homeless_headers({kFiberHeader, {"#include <boost/context/fiber.hpp>", "#include <boost/graph/a.hpp>"}}).size(),
      1U);
  EXPECT_EQ(impure_calls({"core/base/a.cpp", {"double y = std::sin(x);"}}).size(), 1U);
  EXPECT_EQ(unknown_folder({"core/base/deep/a.cpp", {}}).size(), 1U);
  EXPECT_EQ(unknown_folder({"core/a.cpp", {}}).size(), 1U);
  EXPECT_EQ(unknown_folder({"tools/a.cpp", {}}).size(), 1U);
  EXPECT_EQ(unknown_folder({"core/base/a.cpp", {}}).size(), 0U);
  EXPECT_GT(unknown_top_folders(fs::path(FLEETPROOF_SOURCE_DIR) / "tests").size(), 5U);
  EXPECT_EQ(impure_calls({"core/base/a.cpp", {"double y = std::sqrt(x);  // not sin(x)"}}).size(), 0U);
}

}  // namespace
}  // namespace fleetproof::architecture_test
