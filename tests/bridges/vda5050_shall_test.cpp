// The table of what VDA 5050 says that a vehicle shall do: its tests exist, and what is left out has a reason.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace fleetproof::vda5050_shall_test {
namespace {

const std::string kSource = FLEETPROOF_SOURCE_DIR;

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

struct Row {
  std::string section, rule, state, last;
};

std::vector<Row> rows() {
  static const std::regex cells(R"(\| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|)");
  std::istringstream lines(text_of(kSource + "/core/bridges/vda5050/shall_table.md"));
  std::vector<Row> found;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, cells)) found.push_back({match[1], match[2], match[3], match[4]});
  }
  if (!found.empty()) found.erase(found.begin());  // the head
  return found;
}

// "Vda5050Orders.AnOrderIsDrivenNodeByNode", of all tests of VDA 5050.
std::set<std::string> names_of_tests() {
  static const std::regex test(R"(TEST(?:_F)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kSource + "/tests/bridges")) {
    if (!entry.path().filename().string().starts_with("vda5050_")) continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), test), end; match != end; ++match)
      names.insert((*match)[1].str() + "." + (*match)[2].str());
  }
  return names;
}

TEST(Vda5050ShallTable, EachRowHasATestThatExistsOrAReason) {
  const std::set<std::string> tests = names_of_tests();
  ASSERT_GE(rows().size(), 60u);
  for (const Row& row : rows()) {
    if (row.state == "done") {
      EXPECT_TRUE(tests.contains(row.last.substr(1, row.last.size() - 2))) << row.rule << ": " << row.last;
    } else {
      EXPECT_EQ(row.state, "left out") << row.rule;
      EXPECT_TRUE(row.last.size() > 20 && row.last.ends_with('.')) << row.rule << ": " << row.last;
    }
  }
}

TEST(Vda5050ShallTable, ItsHeadCountsItsRows) {
  const std::vector<Row> all = rows();
  const auto done = std::ranges::count(all, std::string("done"), &Row::state);
  const std::string head = "Of " + std::to_string(all.size()) + " rows, " + std::to_string(done) + " are done and " +
                           std::to_string(static_cast<std::ptrdiff_t>(all.size()) - done) + " are left out.";
  EXPECT_THAT(text_of(kSource + "/core/bridges/vda5050/shall_table.md"), testing::HasSubstr(head));
}

}  // namespace
}  // namespace fleetproof::vda5050_shall_test
