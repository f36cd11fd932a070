// What a source defines, the header of its pair declares; and what a header declares, the product uses.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/architecture/source_outline.hpp"
#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture::pairs_test {
namespace {

using Findings = std::vector<std::string>;

// Functions that another header declares, each with the reason.
const std::map<std::string, std::string> kDeclaredElsewhere = {
    {"campaign/cli/main.cpp main", "the program"},
    {"core/agents/agents.cpp fp_reference_agent", "a C header, agents.h, declares it"},
    {"core/agents/agents.cpp fp_faulty_agent", "a C header, agents.h, declares it"},
    {"core/agents/central/central_plugin.cpp fp_agent_query",
     "the entry point that core/sdk/fleetproof/agent.h declares"},
    {"core/sdk/starting/callbacks.cpp fp_agent_query", "the entry point that core/sdk/fleetproof/agent.h declares"},
    {"core/sdk/starting/straight.cpp fp_agent_query", "the entry point that core/sdk/fleetproof/agent.h declares"},
    {"core/agents/plugin.cpp fp_agent_query", "the entry point that core/sdk/fleetproof/agent.h declares"},
};

// Files that have one header together: the catalogue declares one function of each.
struct Catalogue {
  std::string folder, ending, header;
};
const std::vector<Catalogue> kCatalogues = {
    {"campaign/cli/", "_verb.cpp", "campaign/cli/verbs.hpp"},
    {"campaign/cli/", "_methods.cpp", "campaign/cli/evidence/evidence_methods.hpp"},
    {"core/agents/central/", ".cpp", "core/agents/central/programs.hpp"},
    {"core/bridges/vda5050/", ".cpp", "core/bridges/vda5050/documents.hpp"},
    {"core/bridges/wrapped/", "_faults.cpp", "core/bridges/wrapped/fault_agents.hpp"},
    {"generators/families/", ".cpp", "generators/families/families.hpp"}};

// Its own, if it has one.
std::string header_of(const std::string& path, const std::map<std::string, const Source*>& headers) {
  const std::string stem = path.substr(0, path.size() - 4),
                    own = stem + (headers.contains(stem + ".h") ? ".h" : ".hpp");
  for (const Catalogue& catalogue : kCatalogues) {
    const bool belongs = path.starts_with(catalogue.folder) && path.ends_with(catalogue.ending);
    if (belongs && !headers.contains(own)) return catalogue.header;
  }
  return own;
}

// Functions that only tests call, each with the reason why the product has them.
const std::map<std::string, std::string> kForTests = {
    {"OutageProcess::next_change", "the exact instants of change; asking `bad_at` would miss short outages"},
    {"RadioSources::on_process", "the process of one source, for the same reason"},
    {"VehicleProtocol::farewell", "no vehicle of a simulation leaves in order"},
    {"find_version", "campaigns name no version yet"},
    {"is_topic_level", "the built-in vehicle makes its own names"},
    {"parse_campaign_file", "fuzzers and tests give bytes instead of a file"},
};

bool is_product(const Source& source) { return !source.path.starts_with("tests/"); }

std::string first_part(const std::string& name) { return name.substr(0, name.find("::")); }

// The free functions and classes that a file declares or defines.
std::set<std::string> declared_in(const Source& source) {
  const Outline outline = outline_of(source.lines);
  std::set<std::string> found;
  for (const NamedFunction& function : outline.names) found.insert(function.name);
  for (const OutlinedClass& type : outline.classes) found.insert(type.name);
  return found;
}

Findings undeclared(const Source& source, const Source* header) {
  const std::set<std::string> here = declared_in(source);
  const std::set<std::string> there = header == nullptr ? std::set<std::string>{} : declared_in(*header);
  Findings found;
  for (const NamedFunction& function : outline_of(source.lines).names) {
    if (!function.defined || function.local || kDeclaredElsewhere.contains(source.path + " " + function.name)) continue;
    const std::string type = first_part(function.name);
    const bool member = type != function.name;
    if (there.contains(type) || (member && here.contains(type))) continue;
    found.push_back(source.path + " defines " + function.name + ", which the header of its pair does not declare");
  }
  return found;
}

// How often the product says each word beyond declaring and defining functions of this name.
std::map<std::string, int> uses_in(const std::vector<Source>& product) {
  std::map<std::string, int> uses;
  for (const Source& source : product) {
    for (const auto& [word, count] : words_of(source.lines)) uses[word] += count;
    for (const NamedFunction& function : outline_of(source.lines).names) --uses[function.last_word()];
  }
  return uses;
}

// A header that stands first in its source compiles without any include before it.
Findings not_first(const Source& source, const std::set<std::string>& headers) {
  const std::string own = source.path.substr(0, source.path.size() - 4) + ".hpp";
  if (!source.path.ends_with(".cpp") || !headers.contains(own)) return {};
  const auto first = std::ranges::find_if(source.lines, [](const auto& line) { return line.starts_with("#include"); });
  if (first != source.lines.end() && *first == "#include \"" + own + "\"") return {};
  return {source.path + " does not include " + own + " first"};
}

// A name that occurs twice, for two functions, is taken as used as soon as one of them is: this finds no false ones,
// but not all.
Findings unused(const std::vector<Source>& product) {
  const std::map<std::string, int> uses = uses_in(product);
  Findings found;
  for (const Source& source : product) {
    if (!source.is_header() || source.path.starts_with("core/sdk/fleetproof/")) continue;  // those are for agents
    for (const NamedFunction& function : outline_of(source.lines).names) {
      if (uses.at(function.last_word()) <= 0 && !kForTests.contains(function.name))
        found.push_back(source.path + " declares " + function.name + ", which only tests use: move it to them");
    }
  }
  return found;
}

std::vector<Source> product() {
  std::vector<Source> found;
  std::ranges::copy_if(sources(), std::back_inserter(found), is_product);
  return found;
}

TEST(Pairs, ASourceDefinesWhatItsHeaderDeclares) {
  std::map<std::string, const Source*> headers;
  for (const Source& source : sources()) headers[source.path] = &source;
  expect_none(product(), [&](const Source& source) {
    if (!source.path.ends_with(".cpp")) return Findings{};
    const auto header = headers.find(header_of(source.path, headers));
    return undeclared(source, header == headers.end() ? nullptr : header->second);
  });
}

TEST(Pairs, ASourceIncludesItsHeaderFirst) {
  std::set<std::string> headers;
  for (const Source& source : sources()) headers.insert(source.path);
  expect_none(sources(), [&](const Source& source) { return not_first(source, headers); });
}

TEST(Pairs, TheProductUsesWhatItsHeadersDeclare) { EXPECT_EQ(unused(product()), Findings{}); }

TEST(Pairs, ListedExceptionsAreStillNeeded) {
  const std::map<std::string, int> uses = uses_in(product());
  for (const auto& [name, reason] : kForTests) {
    const auto found = uses.find(NamedFunction{name}.last_word());
    ASSERT_TRUE(found != uses.end()) << name << " is gone: take it out of kForTests";
    EXPECT_LE(found->second, 0) << name << " is used: take it out of kForTests";
  }
}

// ---------------------------------------------------------------------------------- each check finds what is planted

TEST(PairsFind, AFunctionOfAnotherPair) {
  const Source header{"core/a.hpp", {"int f(int a);", "class A {", "  void g() const;", "};"}};
  const auto find = [&](const std::string& line) { return undeclared({"core/a.cpp", {line}}, &header).size(); };
  EXPECT_EQ(find("int f(int a) { return a; }"), 0U);
  EXPECT_EQ(find("void A::g() const {}"), 0U);
  EXPECT_EQ(find("static int h() { return f(1); }"), 0U);
  EXPECT_EQ(find("namespace { int h() { return f(1); } }"), 0U);
  EXPECT_EQ(find("struct B { int h(); }; int B::h() { return f(1); }"), 0U);
  EXPECT_EQ(find("namespace a { std::map<int, int> h(int b) { return {}; } }"), 1U);
  EXPECT_EQ(find("void B::h() {}"), 1U);
  EXPECT_EQ(undeclared({"core/b.cpp", {"int f() { return 1; }"}}, nullptr).size(), 1U);
}

TEST(PairsFind, AHeaderBehindAnother) {
  const std::string own = "#include \"core/a.hpp\"";
  EXPECT_TRUE(not_first({"core/a.cpp", {"// A comment.", own, "#include <map>"}}, {"core/a.hpp"}).empty());
  EXPECT_EQ(not_first({"core/a.cpp", {"#include <map>", own}}, {"core/a.hpp"}).size(), 1U);
  EXPECT_EQ(not_first({"core/a.cpp", {}}, {"core/a.hpp"}).size(), 1U);
  EXPECT_TRUE(not_first({"core/a.cpp", {"#include <map>"}}, {}).empty());
}

TEST(PairsFind, AFunctionThatNobodyCalls) {
  const Source header{"core/a.hpp",
                      {"int f(int a);", "class A {", "  void g() const;", "  int h() { return 1; }", "};"}};
  const auto find = [&](const std::string& line) {
    return unused({header, {"core/a.cpp", {"int f(int a) { return a; }", "void A::g() const {}", line}}});
  };
  EXPECT_EQ(find("").size(), 3U);
  EXPECT_EQ(find("// f g h \"f\"").size(), 3U);
  EXPECT_EQ(find("int b = f(1); int c = A().h();").size(), 1U);
  EXPECT_EQ(find("auto all = {&A::g, &A::h, &f};").size(), 0U);
}

}  // namespace
}  // namespace fleetproof::architecture::pairs_test
