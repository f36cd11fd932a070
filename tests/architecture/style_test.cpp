// Sizes, formatting and pages: what keeps the sources readable, checked for every file.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string_view>

#include "tests/architecture/source_outline.hpp"
#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture::style_test {
namespace {

namespace fs = std::filesystem;

using Findings = std::vector<std::string>;

constexpr std::size_t kMostColumns = 120, kMostLines = 700, kMostLinesOfAHeader = 400, kMostLinesOfAFunction = 70;
constexpr std::size_t kMostMemberFunctions = 25, kMostDataMembers = 15;

// The contract for agents in all languages is one header that people copy.
constexpr std::string_view kContract = "core/sdk/fleetproof/agent.h";

// Classes above these sizes, each with the reason why it stays as it is.
const std::map<std::string, std::string> kLargeClasses = {
    {"core/agents/central/fleet_planner.hpp FleetPlanner", "all its rules choose among the work of all AGVs"},
    {"core/agents/hull_lock.hpp HullLock", "one agent, one state machine: every event may change every member"},
    {"core/agents/neighbours.hpp Neighbour", "plain data: everything that one AGV knows about another"},
    {"core/agents/lock_protocol.hpp LockProtocol", "the protocol's messages and the lock state that they change"},
    {"core/bridges/vda5050/documents.hpp Edge", "plain data: every field that the standard has for it"},
    {"core/bridges/vda5050/documents.hpp State", "plain data: every field that the standard has for it"},
    {"core/bridges/vda5050/vehicle_protocol.hpp VehicleProtocol", "one state machine: all may change with every fact"},
    {"core/scenario/scenario.hpp Scenario", "plain data: everything that one simulation needs"},
    {"core/scenario/vehicle_type.hpp VehicleType", "plain data: everything that a kind of AGV can do"},
    {"core/outcome/counters.hpp Counters", "plain data: one number for each counter"},
    {"core/scenario/radio_setup.hpp RadioSetup", "plain data: everything that a scenario says of its radio"},
    {"core/engine/agent_host.hpp AgentHost", "all that happens to agents, in one order"},
    {"core/agents/controller.hpp Controller", "one function for each call of an agent"},
    {"core/engine/agv_controller.hpp AgvController", "one function for each call of an agent"},
    {"core/sdk/fleetproof/blocking.hpp Controller", "one function for each call of a program"},
    {"core/engine/messenger.hpp Messenger", "all that happens to a message, from the sender's hand to the inbox"},
    {"core/engine/engine.hpp Parts", "one member for each part of the engine"},
    {"core/outcome/outcome.hpp Outcome", "plain data: everything that a run leaves"},
    {"storage/records.hpp CampaignRecord", "plain data: everything that a file says of its campaign"},
    {"reports/attempts/attempt_history.hpp AttemptHistory", "plain data: everything that a page tells of attempts"},
    {"reports/attempts/attempt_ledger.hpp Attempt", "plain data: everything that a ledger says of one"},
    {"campaign/batch/audit_queue.hpp AuditQueue", "one queue: what waits, what was found, and the threads between"},
    {"campaign/workers/isolated_runs.hpp IsolatedRuns", "the workers of one plan, and whose turn it is"},
    {"campaign/explain/explanation.hpp Explanation", "plain data: all that is found out about one failing run"},
    {"campaign/findings/findings_file.hpp KnownIssue", "plain data: all that a findings file says of one"},
    {"campaign/plan/plan.hpp CampaignPlan", "plain data: everything that a campaign file says"},
    {"campaign/batch/task_pool.cpp AnyTaskPool::Impl", "two threads' sides of one pool, under one mutex"},
    {"generators/worlds/fault_rates.hpp FaultRates", "plain data: one number for each kind of fault"},
    {"laws/progress_law.cpp ProgressLaw", "one number for each end point that the law judges"},
    {"reports/evidence/tally.hpp Tally", "plain figures: one number for each kind of run that is counted"},
    {"reports/evidence/evidence.hpp Evidence", "plain figures of one campaign, counted in one pass"},
    {"reports/replay_page/film.hpp Film", "plain data: everything that a replay page shows"},
    {"tests/support/callback_carrier.cpp CallbackCarrier", "a state machine: what straight-line code is spared"},
    {"tests/agents/fake_warehouse.hpp FakeWarehouse", "stands in for the whole C table of a controller"},
    {"tests/agents/fake_agv.hpp FakeAgv", "plain data: all that the fake says of one AGV"},
};

// Files with longer lines, each with the reason.
const std::map<std::string, std::string> kWideFiles = {
    {"storage/schema.cpp", "one line of the SQL that archives contain to the byte"},
    {"tests/fuzz/seeds.cpp", "sample files, as programs write them"},
    {"tests/generators/lif_test.cpp", "a sample file whose line numbers errors name"},
    {"tests/generators/opentcs_test.cpp", "a sample file whose line numbers errors name"},
    {"core/bridges/vda5050/shall_table.md", "a table whose rows end with the name of a test"},
    {"campaign/fields.md", "tables that a test writes from the lists of fields"},
    {"tests/contract/hostile/hostile_names_test.cpp", "a sample file"},
};

// Folders of sources without a README.md of their own, each with the reason.
const std::map<std::string, std::string> kFoldersWithoutPage = {
    {"core/sdk/fleetproof", "core/sdk/README.md describes the headers in it"},
    {"core/sdk/starting", "core/sdk/README.md says what is in it"},
    {"core/bridges/lockstep", "core/bridges/README.md describes it: one way in"},
    {"core/bridges/mqtt", "core/bridges/README.md describes it: a broker and its clients"},
    {"core/bridges/stream", "core/bridges/README.md describes it: a small TCP"},
    {"core/bridges/wrapped", "core/bridges/README.md describes it: the faults around a program"},
    {"tests/agents", "mirrors core/agents: tests/README.md"},
    {"tests/bridges", "mirrors core/bridges: tests/README.md"},
    {"tests/contract/agents", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/audits", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/campaigns", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/failures", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/hostile", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/reports", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/same_bits", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/watch", "a group of tests/contract: its README.md has a section for each"},
    {"tests/contract/worlds", "a group of tests/contract: its README.md has a section for each"},
    {"tests/campaign", "mirrors campaign: tests/README.md"},
    {"tests/core", "mirrors core: tests/README.md"},
    {"tests/generators", "mirrors generators: tests/README.md"},
    {"tests/laws", "mirrors laws: tests/README.md"},
    {"tests/reports", "mirrors reports: tests/README.md"},
    {"tests/storage", "mirrors storage: tests/README.md"},
};

// In characters, not in bytes.
std::size_t columns(const std::string& line) {
  return static_cast<std::size_t>(
      std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

Findings wide_lines(const Source& source) {
  Findings found;
  if (kWideFiles.contains(source.path)) return found;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const auto width = columns(source.lines[i]);
    if (width > kMostColumns)
      found.push_back(source.path + ":" + std::to_string(i + 1) + " has " + std::to_string(width) + " columns");
  }
  return found;
}

Findings too_long(const Source& source) {
  Findings found;
  const bool is_short = source.is_header() && !source.path.starts_with("tests/") && source.path != kContract;
  const std::size_t most = is_short ? kMostLinesOfAHeader : kMostLines;
  if (source.lines.size() > most)
    found.push_back(source.path + " has " + std::to_string(source.lines.size()) + " lines");
  for (const auto& function : outline_of(source.lines).functions) {
    if (function.lines <= kMostLinesOfAFunction) continue;
    found.push_back(source.path + ":" + std::to_string(function.first_line) + " is a function of " +
                    std::to_string(function.lines) + " lines");
  }
  return found;
}

bool is_large(const OutlinedClass& type) {
  return type.functions > kMostMemberFunctions || type.data > kMostDataMembers;
}

Findings large_classes(const Source& source) {
  Findings found;
  for (const auto& type : outline_of(source.lines).classes) {
    if (!is_large(type) || kLargeClasses.contains(source.path + " " + type.name)) continue;
    found.push_back(source.path + ":" + std::to_string(type.first_line) + " " + type.name + " has " +
                    std::to_string(type.functions) + " member functions and " + std::to_string(type.data) +
                    " data members; split it, or list it with a reason in style_test.cpp");
  }
  return found;
}

// What clang-format 14 says about files, first lines only; empty if it would change nothing.
std::string formatting_of(const std::string& files) {
  const std::string command = "clang-format-14 --dry-run --Werror --style=file " + files + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot run " + command;
  std::string text;
  std::array<char, 4096> part{};
  for (std::size_t n; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    if (text.size() < 4000) text.append(part.data(), n);
  const int status = pclose(pipe);
  return status == 0 ? text : text + "\nclang-format-14 ended with status " + std::to_string(status);
}

TEST(Style, LinesFitTheScreen) {
  expect_none(sources(), wide_lines);
  expect_none(other_texts(), wide_lines);
}

TEST(Style, FilesAndFunctionsFitAReader) { expect_none(sources(), too_long); }

TEST(Style, LargeClassesAreListed) { expect_none(sources(), large_classes); }

TEST(Style, ListedExceptionsAreStillNeeded) {
  std::set<std::string> large;
  for (const Source& source : sources()) {
    for (const auto& type : outline_of(source.lines).classes) {
      if (is_large(type)) large.insert(source.path + " " + type.name);
    }
  }
  for (const auto& [name, reason] : kLargeClasses)
    EXPECT_TRUE(large.contains(name)) << name << " is not large any more: take it out of kLargeClasses";
}

// What clang 14 cannot compile with the standard library of GCC 12: algorithms that return a subrange.
const std::array<std::string, 6> kSubranges = {"unique(",           "remove(",    "remove_if(",
                                               "stable_partition(", "partition(", "rotate("};

Findings calls_for_subranges(const Source& source) {
  Findings found;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    for (const std::string& name : kSubranges) {
      if (source.lines[i].find("std::ranges::" + name) != std::string::npos)
        found.push_back(source.path + ":" + std::to_string(i + 1) + " calls std::ranges::" + name +
                        "), which clang 14 does not compile; call the function of <algorithm>");
    }
  }
  return found;
}

TEST(Style, SourcesCompileWithClang14) { expect_none(sources(), calls_for_subranges); }

TEST(StyleFinds, ACallForASubrange) {
  const std::string call = "  keys.erase(std::ranges::" + std::string("unique(keys).begin(), keys.end());");
  EXPECT_EQ(calls_for_subranges({"core/a.cpp", {call}}).size(), 1U);
  EXPECT_TRUE(calls_for_subranges({"core/a.cpp", {"std::unique(a, b)"}}).empty());
}

TEST(Style, EveryFolderOfSourcesHasAPage) {
  std::set<std::string> folders;
  for (const Source& source : sources()) folders.insert(fs::path(source.path).parent_path().generic_string());
  for (const std::string& folder : folders) {
    const bool has_page = fs::exists(fs::path(FLEETPROOF_SOURCE_DIR) / folder / "README.md");
    EXPECT_NE(has_page, kFoldersWithoutPage.contains(folder)) << folder << " has no README.md, or is listed in vain";
  }
}

bool has_formatter() { return std::system("command -v clang-format-14 >/dev/null") == 0; }

TEST(Style, SourcesAreFormatted) {
  if (!has_formatter())
    GTEST_SKIP() << "this system has no clang-format-14 (Debian 12, Ubuntu 24.04: package clang-format-14)";
  std::string files;
  for (const Source& source : sources()) files += " '" + std::string(FLEETPROOF_SOURCE_DIR) + "/" + source.path + "'";
  EXPECT_EQ(formatting_of(files), "") << "run clang-format-14 -i on these files (Debian: package clang-format-14)";
}

// ---------------------------------------------------------------------------------- each check finds what is planted

TEST(StyleFinds, AWideLine) {
  EXPECT_EQ(wide_lines({"README.md", {std::string(120, 'x')}}).size(), 0U);
  EXPECT_EQ(wide_lines({"README.md", {std::string(121, 'x')}}).size(), 1U);
  std::string umlauts;
  for (int i = 0; i < 120; ++i) umlauts += "\u00fc";
  EXPECT_EQ(wide_lines({"README.md", {umlauts}}).size(), 0U) << "characters count, not bytes";
}

std::vector<std::string> function_of(std::size_t lines, const std::string& opening, const std::string& indent) {
  std::vector<std::string> text = {indent + opening};
  text.resize(lines - 1, indent + "  if (a) { g(\"}\"); }  // }");
  text.push_back(indent + "}");
  return text;
}

TEST(StyleFinds, ALongFunction) {
  EXPECT_EQ(too_long({"core/base/a.cpp", function_of(70, "void f() {", "")}).size(), 0U);
  EXPECT_EQ(too_long({"core/base/a.cpp", function_of(71, "void f() {", "")}).size(), 1U);
}

TEST(StyleFinds, ALongFile) {
  const auto find = [](const std::string& path, std::size_t lines) {
    return too_long({path, std::vector<std::string>(lines, "int a;")}).size();
  };
  EXPECT_EQ(find("core/base/a.cpp", 700), 0U);
  EXPECT_EQ(find("core/base/a.cpp", 701), 1U);
  EXPECT_EQ(find("core/base/a.hpp", 400), 0U);
  EXPECT_EQ(find("core/base/a.hpp", 401), 1U);
  EXPECT_EQ(find("tests/core/a.hpp", 700), 0U);
}

TEST(StyleFinds, ALongMemberFunction) {
  for (const std::string opening : {"void f() const {", "explicit A(int a) : a_(a), b_{1} {", "bool operator<(A b) {",
                                    "std::map<int, std::pair<int, int>> f(std::function<void(int)> g = {}) {"}) {
    std::vector<std::string> text = {"namespace a {", "class A : public B {", " public:"};
    const auto body = function_of(71, opening, "  ");
    text.insert(text.end(), body.begin(), body.end());
    text.insert(text.end(), {"  int a_ = 0, b_;", "};", "}  // namespace a"});
    EXPECT_EQ(too_long({"core/base/a.hpp", text}).size(), 1U) << opening;
  }
}

TEST(StyleFinds, ALargeClass) {
  std::vector<std::string> functions = {"class A {", " public:"}, data = {"struct B {"};
  for (int i = 0; i < 25; ++i) functions.push_back("  std::map<int, int> f(int a, int b = 2) const;");
  for (int i = 0; i < 5; ++i) data.push_back("  std::map<int, int> a, b = {}, c{1};");
  EXPECT_EQ(large_classes({"core/a.hpp", functions}).size(), 0U);
  functions.insert(functions.end(), {"  A() = default;", "  explicit A(int a) : b_(a) {}", "  ~A();"});
  EXPECT_EQ(large_classes({"core/a.hpp", functions}).size(), 0U);
  functions.push_back("  void g() { h(); }");
  functions.push_back("};");
  EXPECT_EQ(large_classes({"core/a.hpp", functions}).size(), 1U);
  data.insert(data.end(), {"  using C = int;", "  static constexpr int kD = 4;", "  enum class E { F, G };", "};"});
  EXPECT_EQ(large_classes({"core/a.hpp", data}).size(), 0U);
  data.insert(data.end() - 1, "  std::vector<int> sixteenth = f(1, 2);");
  EXPECT_EQ(large_classes({"core/a.hpp", data}).size(), 1U);
}

TEST(StyleFinds, AnUnformattedFile) {
  if (!has_formatter()) GTEST_SKIP() << "this system has no clang-format-14";
  // A folder of its own: a .clang-format holds for everything below it.
  std::string folder = (fs::path(testing::TempDir()) / "unformatted-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr) << folder;
  fs::copy_file(fs::path(FLEETPROOF_SOURCE_DIR) / ".clang-format", fs::path(folder) / ".clang-format");
  const fs::path file = fs::path(folder) / "unformatted.cpp";
  std::ofstream(file) << "int  f( ){ return 1 ; }\n";
  EXPECT_NE(formatting_of("'" + file.string() + "'"), "");
  std::ofstream(file) << "int f() { return 1; }\n";
  EXPECT_EQ(formatting_of("'" + file.string() + "'"), "");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace fleetproof::architecture::style_test
