// ARCHITECTURE.md names functions that exist. It stays short, and CHANGELOG.md does. Its picture is read in
// ../architecture_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/architecture/source_outline.hpp"
#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture::map_test {
namespace {

constexpr std::size_t kMostLinesOfTheMap = 250, kMostLinesOfTheChanges = 120;

const Source& text_of(const std::string& path) {
  const auto found = std::ranges::find(other_texts(), path, &Source::path);
  if (found == other_texts().end()) throw std::runtime_error(path + " is missing");
  return *found;
}

// A function as a page names it, `f` or `A::f`, and the file in which it is defined.
struct NamedStep {
  std::string function, file;
};

// The rows of a table that begin with a number, a function and a file.
std::vector<NamedStep> steps_of(const std::vector<std::string>& lines) {
  static const std::regex row(R"(^\| \d+ \| `([^`]+)` \| `([^`]+)` \|.*)");
  std::vector<NamedStep> steps;
  std::smatch match;
  for (const std::string& line : lines) {
    if (std::regex_match(line, match, row)) steps.push_back({match[1], match[2]});
  }
  return steps;
}

// The outline leaves operators out, and names a member of an inner class by that class alone.
bool defines(const Source& source, const std::string& function) {
  if (function.ends_with("()")) {
    return std::ranges::any_of(source.lines, [&](const std::string& line) {
      return line.find(" " + function + "(") != std::string::npos && !line.starts_with(' ') && !line.ends_with(';');
    });
  }
  return std::ranges::any_of(outline_of(source.lines).names, [&](const NamedFunction& known) {
    return known.defined && (known.name == function || function.ends_with("::" + known.name));
  });
}

std::vector<std::string> missing_functions(const std::vector<NamedStep>& steps) {
  std::vector<std::string> found;
  for (const auto& [function, file] : steps) {
    const auto source = std::ranges::find(sources(), file, &Source::path);
    if (source == sources().end() || !defines(*source, function)) found.push_back(file + " defines no " + function);
  }
  return found;
}

TEST(Map, NamesFunctionsThatExist) {
  const std::vector<NamedStep> steps = steps_of(text_of("ARCHITECTURE.md").lines);
  EXPECT_GT(steps.size(), 15U);
  EXPECT_EQ(missing_functions(steps), std::vector<std::string>{});
}

TEST(Map, IsShort) {
  EXPECT_LE(text_of("ARCHITECTURE.md").lines.size(), kMostLinesOfTheMap);
  EXPECT_LE(text_of("CHANGELOG.md").lines.size(), kMostLinesOfTheChanges);
}

TEST(Map, IsLinkedFromTheFirstPage) {
  EXPECT_TRUE(std::ranges::any_of(text_of("README.md").lines, [](const std::string& line) {
    return line.find("](ARCHITECTURE.md)") != std::string::npos;
  }));
}

TEST(MapFinds, AFunctionThatIsNotThere) {
  const std::string here = "tests/architecture/map_test.cpp";
  EXPECT_TRUE(missing_functions({{"steps_of", here}, {"defines", here}}).empty());
  EXPECT_EQ(missing_functions({{"steps_off", here}, {"steps_of", "tests/architecture/none.cpp"}}).size(), 2U);
  EXPECT_EQ(steps_of({"| 7 | `f` | `a.cpp` | what it does |", "| step | `g` | `b.cpp` | head |"}).size(), 1U);
  const Source source{"a.cpp", {"struct A {", "  void f() { g(); }", "};", "int B::operator()(int i) const {", "}"}};
  EXPECT_TRUE(defines(source, "A::f"));
  EXPECT_TRUE(defines(source, "B::operator()"));
  EXPECT_FALSE(defines(source, "g"));
}

}  // namespace
}  // namespace fleetproof::architecture::map_test
