// Two types of one name in one namespace are one type to the linker, wherever they are defined: it keeps one of the
// functions that the compiler made for each, and says nothing.
#include <gtest/gtest.h>

#include <map>

#include "tests/architecture/source_outline.hpp"
#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture::one_definition_test {
namespace {

std::vector<std::string> defined_twice(const std::vector<Source>& files) {
  std::map<std::string, std::string> first;
  std::vector<std::string> found;
  for (const Source& source : files) {
    for (const NamedType& type : outline_of(source.lines).types) {
      if (type.local) continue;
      const auto [at, fresh] = first.emplace(type.name, source.path);
      if (!fresh) found.push_back(type.name + " in " + at->second + " and in " + source.path);
    }
  }
  return found;
}

TEST(OneDefinition, TypesOfANamespaceHaveNamesOfTheirOwn) {
  EXPECT_EQ(defined_twice(sources()), std::vector<std::string>{});
}

TEST(OneDefinition, ReadsTheTypesOfTheWholeTree) {
  std::size_t types = 0;
  for (const Source& source : sources()) types += outline_of(source.lines).types.size();
  EXPECT_GT(types, 1000U);
}

TEST(OneDefinitionFinds, ATypeThatIsDefinedTwice) {
  const auto find = [](const std::string& line) {
    const std::string header = "namespace a { struct A { struct B { int b = 0; }; }; enum class E : int { One }; }";
    return defined_twice({{"core/a.hpp", {header}}, {"laws/a.cpp", {line}}}).size();
  };
  EXPECT_EQ(find("namespace a { struct A { int c = 0; }; }"), 1U);
  EXPECT_EQ(find("namespace a { class A final : public C { int c = 0; }; }"), 1U);
  EXPECT_EQ(find("namespace a { template <class C> class A { C c; }; }"), 1U);
  EXPECT_EQ(find("namespace a { enum E { One }; }"), 1U);
  EXPECT_EQ(find("namespace a { enum class A : int { One }; union E { int c; }; }"), 2U);
  EXPECT_EQ(find("namespace b { struct A { int c = 0; }; }"), 0U);
  EXPECT_EQ(find("namespace a { namespace { struct A { int c = 0; }; } }"), 0U);
  EXPECT_EQ(find("namespace a { struct A::B { int c = 0; }; struct B { int c = 0; }; }"), 0U);
  EXPECT_EQ(find("namespace a { struct A f() { return {}; } A A_of(A a) { return a; } struct A; }"), 0U);
  EXPECT_EQ(find("namespace a { void f() { struct A { int c = 0; }; } }"), 0U);
}

}  // namespace
}  // namespace fleetproof::architecture::one_definition_test
