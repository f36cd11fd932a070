// `report --cases N`: the pages of failing runs, and the page of the campaign that leads to them.
#include <gmock/gmock.h>

#include <filesystem>
#include <pugixml.hpp>
#include <set>

#include "tests/support/program.hpp"

namespace fleetproof::case_pages_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class CasePages : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("c.toml",
          "replicates = 3\nhorizon_s = 60\n[factors]\nagents = [\"timeout-grant\", \"reckless\"]\n"
          "layouts = [\"corridor-sidings\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n");
    ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db")));
  }
  pugi::xml_document page(const std::string& file) const {
    pugi::xml_document document;
    const std::string text = read(path(file));
    EXPECT_TRUE(document.load_buffer(text.data(), text.size(), pugi::parse_full)) << file;
    return document;
  }
  // Of the list at the top of the page.
  static std::set<std::string> links(const pugi::xml_document& page) {
    std::set<std::string> found;
    for (const auto& link : page.select_nodes("//div[@class='failing']//a/@href"))
      found.insert(link.attribute().value());
    return found;
  }
  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> found;
    for (const auto& file : std::filesystem::directory_iterator(path(folder)))
      found.insert(file.path().filename().string());
    return found;
  }
};

TEST_F(CasePages, StandInAFolderWithTheReportThatLinksToThem) {
  ASSERT_TRUE(test::has_verdict(run("report c.db --html pages --cases 4")));
  std::set<std::string> found = files("pages");
  EXPECT_EQ(found.size(), 5U);
  EXPECT_EQ(found.erase("report.html"), 1U);
  const auto report = page("pages/report.html");
  EXPECT_EQ(links(report), found);
  for (const std::string& name : found) {
    const std::string number = name.substr(5, name.size() - 10);
    ASSERT_TRUE(test::has_verdict(run("replay c.db " + number + " --html one.html")));
    EXPECT_EQ(read(path("pages/" + name)), read(path("one.html"))) << "what replay writes";
    EXPECT_THAT(read(path("one.html")), testing::HasSubstr("Why it failed</h3>")) << "it was found out for the page";
  }
  ASSERT_TRUE(test::has_verdict(run("report c.db --html pages --cases 1"))) << "the pages may be replaced";
}

TEST_F(CasePages, WithoutThemAListLeadsToTheGroupsOfTheSamePage) {
  ASSERT_TRUE(test::has_verdict(run("report c.db --html page.html")));
  const auto report = page("page.html");
  const std::set<std::string> found = links(report);
  ASSERT_FALSE(found.empty());
  for (const std::string& link : found)
    EXPECT_FALSE(report.select_nodes(("//*[@id='" + link.substr(1) + "']").c_str()).empty()) << link;
}

TEST_F(CasePages, ComeOneOfEachGroupBeforeASecondOfAny) {
  ASSERT_TRUE(test::has_verdict(run("report c.db --html pages --cases 2")));
  std::set<std::string> agents;
  for (const auto& item : page("pages/report.html").select_nodes("//div[@class='failing']//li")) {
    const std::string text = item.node().child("a").next_sibling().value();
    if (std::string(item.node().child("a").attribute("href").value()).starts_with('#')) continue;
    agents.insert(text.substr(2, text.find(',') - 2));
  }
  EXPECT_THAT(agents, ElementsAre("reckless", "timeout-grant"));
}

TEST_F(CasePages, AreRefusedWhereTheyCannotBe) {
  EXPECT_THAT(run("report c.db --cases 2").err, HasSubstr("--cases: stand beside a page"));
  write("file", "text\n");
  EXPECT_THAT(run("report c.db --html file --cases 2").err, HasSubstr("file is no folder"));
  EXPECT_EQ(run("report c.db --html pages --cases 0").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("pages")));
}

}  // namespace
}  // namespace fleetproof::case_pages_test
