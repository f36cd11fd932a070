// The film strips of `report --html`: which runs have one, what it shows, and what it says if there is none.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <regex>

#include "core/base/shown_time.hpp"
#include "storage/archive_reader.hpp"
#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::film_strip_page_test {
namespace {

using testing::HasSubstr;

class FilmStripPage : public test::AuditedCampaign {
 protected:
  // Each strip, by its place on the page.
  std::vector<std::string> strips(const std::string& archive) const {
    const auto finished = run("report " + archive + " --html page.html --exit-zero");
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const std::string page = read(path("page.html"));
    std::vector<std::string> found;
    for (std::size_t at = page.find("<div class=\"film\">"); at != std::string::npos;) {
      const std::size_t next = page.find("<div class=\"film\">", at + 1);
      const std::size_t end = std::min({next, page.find("<h3>", at), page.find("</section>", at)});
      found.push_back(page.substr(at, end - at));
      at = next;
    }
    return found;
  }
  static std::size_t frames_in(const std::string& strip) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = strip.find("class=\"frame\"", at)) != std::string::npos; ++at) ++count;
    return count;
  }
};

constexpr const char* kReckless =
    "name = \"c\"\nreplicates = 6\nhorizon_s = 120\n[factors]\nagents = [{}]\nlayouts = [\"aisle-grid\"]\n"
    "fleet_sizes = [5]\n[audit]\nshare = 0\n";

TEST_F(FilmStripPage, ShowsTheWorstInstantOfEachGroup) {
  write("c.toml", fmt::format(kReckless, "\"reckless\""));
  run("run c.toml --db c.db");
  const auto all = strips("c.db");
  ASSERT_FALSE(all.empty());
  const std::string page = read(path("page.html"));
  const ArchiveReader archive(path("c.db"));
  std::smatch match;
  ASSERT_TRUE(
      std::regex_search(page, match, std::regex("fleetproof replay c.db ([0-9]+)</code></pre><div class=.film")));
  const auto worst = archive.run(std::stoull(match[1]));
  const auto& violations = worst->outcome.violations;
  // The fastest contact.
  const auto closest = std::ranges::max_element(
      violations, {}, [](const Violation& v) { return v.contact ? v.relative_speed_um_s : -1; });
  EXPECT_EQ(frames_in(all[0]), 6u);
  EXPECT_THAT(all[0], HasSubstr(fmt::format(">{:.3f} s</text>", shown_seconds(closest->closest_at))));
  EXPECT_TRUE(strips("c.db --no-film").empty());
  ASSERT_TRUE(closest->contact);
  EXPECT_THAT(all[0], HasSubstr("they touch"));
  EXPECT_THAT(all[0], HasSubstr(fmt::format(">AGV {}</text>", closest->a.value)));
  EXPECT_THAT(all[0], HasSubstr(fmt::format(">AGV {}</text>", closest->b.value)));
}

// The same file, and yet another behaviour: as if it had been built again from another source.
TEST_F(FilmStripPage, ARunThatComesOutDifferentlyIsNotShown) {
  write("c.toml", fmt::format(kReckless, test::failing("segfault 1000000")));
  const auto ran = run("run c.toml --db c.db");
  const auto as_it_was = strips("c.db");
  ASSERT_FALSE(as_it_was.empty()) << ran.out;
  EXPECT_EQ(frames_in(as_it_was[0]), 6u) << as_it_was[0];
  ::setenv("FLEETPROOF_TEST_REBUILT", "1", 1);
  const auto rebuilt = strips("c.db");
  ::unsetenv("FLEETPROOF_TEST_REBUILT");
  ASSERT_EQ(rebuilt.size(), as_it_was.size());
  for (const std::string& strip : rebuilt) {
    EXPECT_EQ(frames_in(strip), 0u);
    EXPECT_THAT(strip, HasSubstr("simulated again for this page, the run came out differently (trace digest"));
  }
}

TEST_F(FilmStripPage, APlugInThatIsAtHandIsFilmed) {
  std::filesystem::copy_file(FLEETPROOF_EXAMPLE, path("plugin.so"));
  write("c.toml", fmt::format(kReckless, "{ file = \"plugin.so\" }"));
  const auto ran = run("run c.toml --db c.db");
  const auto all = strips("c.db");
  if (all.empty()) GTEST_FAIL() << "the plug-in fails in no run: " << ran.out;
  EXPECT_EQ(frames_in(all[0]), 6u) << all[0];
  std::filesystem::remove(path("plugin.so"));
  for (const std::string& strip : strips("c.db")) {
    EXPECT_EQ(frames_in(strip), 0u);
    EXPECT_THAT(strip, HasSubstr("No film strip: "));
    EXPECT_THAT(strip, HasSubstr("plugin.so"));
  }
  std::filesystem::remove(path("c.sessions.jsonl"));
  for (const std::string& strip : strips("c.db"))
    EXPECT_THAT(strip, HasSubstr("is not built in, and no session log beside c.db"));
}

// A campaign keeps no recording of such a run. It is recorded for the page.
TEST_F(FilmStripPage, APlugInThatOnlyStallsIsShownToo) {
  std::filesystem::copy_file(FLEETPROOF_FAULTY_AGENT, path("faulty.so"));
  write("c.toml",
        "replicates = 2\nhorizon_s = 600\n[factors]\nagents = [{ file = \"faulty.so\", config = \"stop\" }]\n"
        "layouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0]\ndelay_s = [1]\n");
  const auto ran = run("run c.toml --db c.db");
  const auto all = strips("c.db");
  ASSERT_FALSE(all.empty()) << ran.out;
  for (const std::string& strip : all) {
    EXPECT_GT(frames_in(strip), 0u) << strip;
    EXPECT_THAT(strip, testing::Not(HasSubstr("No film strip")));
  }
}

// Twelve agents under test, so at least twelve groups.
TEST_F(FilmStripPage, AGroupBeyondTheFirstTenSaysWhyItHasNoFrames) {
  std::string agents;
  for (int i = 0; i < 12; ++i)
    agents += fmt::format("{}{{ name = \"a{}\", agent = \"reckless\" }}", i == 0 ? "" : ", ", i);
  write("c.toml", fmt::format(kReckless, agents));
  const auto ran = run("run c.toml --db c.db");
  const auto all = strips("c.db");
  ASSERT_GE(all.size(), 12u) << ran.out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(frames_in(all[i]) > 0, i < 10) << i;
    EXPECT_EQ(all[i].find("No film strip: this page shows only the first 10 groups as strips.") == std::string::npos,
              i < 10);
  }
}

// The name of the load fits the frame, and each frame has a distance or says that the load still rides.
TEST_F(FilmStripPage, AFallenLoadIsNamedAndEachFrameSaysHowFarItIs) {
  write("c.toml", fmt::format(kReckless, "\"hull-lock\"") + "[faults]\nload_drops_per_transport = 1\n");
  const auto ran = run("run c.toml --db c.db");
  const auto all = strips("c.db");
  ASSERT_FALSE(all.empty()) << ran.out;
  std::string joined;
  for (const std::string& strip : all) joined += strip;
  EXPECT_THAT(joined, testing::ContainsRegex(">load of AGV [0-9]+</text>"));
  static const std::regex frame("aria-label=\"at ([^\"]*)\"");
  for (std::sregex_iterator at(joined.begin(), joined.end(), frame), end; at != end; ++at)
    EXPECT_THAT((*at)[1].str(),
                testing::AnyOf(HasSubstr(" m apart"), HasSubstr("they touch"), HasSubstr(", load not on the floor")));
}

// The agent ends its process. It does so in a worker; the program that writes the page lives on.
TEST_F(FilmStripPage, ACrashOfAPlugInCostsThePageNothing) {
  write_campaign(test::failing("segfault 1"), 3, 0.0);
  const auto ran = run("run c.toml --db c.db");
  EXPECT_TRUE(test::has_verdict(ran));
  const auto all = strips("c.db");
  ASSERT_EQ(all.size(), 1u) << ran.out;
  EXPECT_THAT(read(path("page.html")), HasSubstr("</html>"));
}

}  // namespace
}  // namespace fleetproof::film_strip_page_test
