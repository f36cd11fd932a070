// What became of messages, as the event log of the replay page says it. The agent plays a list of calls and the
// scenario decides the delivery of single messages, so the truth is known before the run.
#include <gmock/gmock.h>

#include <pugixml.hpp>
#include <regex>

#include "tests/support/program.hpp"

namespace fleetproof::replay_event_log_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// M drives towards P and touches it. T grants, far away; Q says nothing.
constexpr const char* kWorld = R"({"version": 1, "name": "talk", "horizon_s": 20,
    "vehicle_types": [{"name": "cart", "length_m": 1.6, "width_m": 1}],
    "agvs": [{"name": "M", "start": "a", "heading": [1, 0]}, {"name": "P", "start": "p", "heading": [1, 0]},
             {"name": "T", "start": "t", "heading": [1, 0]}, {"name": "Q", "start": "q", "heading": [1, 0]}],
    "fates": [{"sender": "T", "receiver": "M", "sent_ns": 1500000000, "delay_ns": 100000000, "copied": true,
               "copy_delay_ns": 400000000},
              {"sender": "P", "receiver": "M", "sent_ns": 1600000000, "lost": true},
              {"sender": "P", "receiver": "M", "sent_ns": 4900000000, "delay_ns": 600000000}],
    "layout": {"name": "talk", "floor_low_m": [-3, -3], "floor_high_m": [20, 30],
      "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [8, 0]},
                   {"name": "p", "position_m": [9, 0]}, {"name": "t", "position_m": [0, 10]},
                   {"name": "q", "position_m": [0, 20]}],
      "segments": [{"name": "ab", "from": "a", "to": "b"}, {"name": "bp", "from": "b", "to": "p"},
                   {"name": "pt", "from": "p", "to": "t"}, {"name": "tq", "from": "t", "to": "q"},
                   {"name": "qa", "from": "q", "to": "a"}]}})";
constexpr const char* kCalls =
    "0 1000 say asking;0 1000 all REQUEST;2 1500 to0 GRANT;1 1600 to0 DEFER;0 2000 all REQUEST;0 3000 all REQUEST;"
    "1 4900 to0 DEFER;0 5000 say driving;0 5000 move 0;2 6000 to0 GRANT";

class ReplayEventLog : public test::ProgramTest {
 protected:
  // The page of the world, with other calls.
  pugi::xml_document page(const std::string& calls = kCalls) const {
    write("talk.json", kWorld);
    const auto done = run("simulate talk.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
                          "' --agent-config '" + calls + "' --html p.html");
    EXPECT_TRUE(test::has_verdict(done)) << done.err;
    pugi::xml_document document;
    const std::string text = read(path("p.html"));
    EXPECT_TRUE(document.load_buffer(text.data(), text.size(), pugi::parse_full));
    return document;
  }
  // The texts of the elements, one after the other. A line of the event_log: its cells.
  static std::vector<std::string> texts(const pugi::xml_document& document, const std::string& query) {
    std::vector<std::string> all;
    for (const auto& found : document.select_nodes(query.c_str())) {
      std::string text;
      for (const pugi::xml_node child : found.node().children())
        text += (text.empty() ? "" : "|") + std::string(child.text().get());
      all.push_back(text);
    }
    return all;
  }
};

TEST_F(ReplayEventLog, TheEventLogHasThirdAgvsInCausalOrder) {
  const auto document = page();
  const auto lines = texts(document, "//div[@id='log-lines']//*[contains(@class, 'line')]");
  const auto place = [&](const std::string& line) {
    const auto found = std::ranges::find(lines, line);
    EXPECT_NE(found, lines.end()) << line;
    return found - lines.begin();
  };
  place("1.500|T \u2192 M|GRANT #2|received 1.600 s and again 1.900 s: delivered twice");
  place("1.900|M \u2190 T|GRANT #2|received again, 0.400 s old");
  place("1.600|P \u2192 M|DEFER #3|lost on purpose by the scenario");
  EXPECT_LT(place("5.000|M|its agent says|\"driving\""), place("5.000|M|begins drive|a to b"));
  EXPECT_LT(place("5.000|M|begins drive|a to b"), place("5.500|M \u2190 P|DEFER #6|received, 0.600 s old"));
  // Three requests with no event between them are one line; opened, they stand below it.
  const auto fold = place("1.000|M \u2192 all|REQUEST \u00d7 3|until 3.000 s");
  EXPECT_LT(place("1.000|M|its agent says|\"asking\""), fold);
  EXPECT_EQ(place("1.000|M \u2192 all|REQUEST #1|received 1.001 s"), fold + 1);
  EXPECT_EQ(place("3.000|M \u2192 all|REQUEST #5|received 3.001 s"), fold + 3);
}

// A flood of refused calls is one line, until the AGV does something else.
TEST_F(ReplayEventLog, CallsThatAreRefusedAgainAndAgainAreOneLine) {
  const auto document = page("0 1000 move 3;0 1100 move 3;0 1200 move 3;0 2000 say asking;0 2100 move 3;0 5000 move 0");
  const auto lines = texts(document, "//div[@id='log-lines']//summary[contains(@class, 'event')]");
  EXPECT_THAT(lines, ElementsAre("1.000|M|refused move tq \u00d7 3|until 1.200 s"));
}

TEST_F(ReplayEventLog, SaysHowManyMessagesHaveAGivenDelivery) {
  (void)page();
  const std::string text = read(path("p.html"));
  EXPECT_THAT(text,
              HasSubstr("<dt>given deliveries</dt><dd>3 messages (1 lost, 1 delivered twice, 1 with a given delay)"));
  EXPECT_THAT(text, HasSubstr("0 %, but of messages with a given delivery"));
}

// A message that is under way when the run ends is not forgotten.
TEST_F(ReplayEventLog, SaysWhatWasStillUnderWayAtTheEnd) {
  std::string world(kWorld);
  world.replace(world.find("600000000}"), 10, "60000000000}");
  write("late.json", world);
  ASSERT_LE(run("simulate late.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
                "' --agent-config '" + kCalls + "' --html l.html")
                .exit_code,
            1);
  EXPECT_THAT(
      read(path("l.html")),
      HasSubstr("<span class=\"what\">DEFER #6</span><span class=\"more\">under way at the end of the run</span>"));
}

// Keys keep the instant of the address, to the microsecond; j goes to the next line of the event_log.
TEST_F(ReplayEventLog, TheAddressStaysExactInABrowser) {
  if (shell("command -v chromium").exit_code != 0) GTEST_SKIP() << "there is no chromium";
  (void)page();
  std::string text = read(path("p.html"));
  const auto with_key = [&](const std::string& key) {
    write("k.html", std::regex_replace(text, std::regex("</body>"),
                                       "<script>dispatchEvent(new KeyboardEvent('keydown', {key: '" + key +
                                           "'})); document.title = location.hash;</script></body>"));
    const auto shown = shell(
        "timeout 120 chromium --headless=new --no-sandbox --disable-gpu --user-data-dir=\"$PWD/profile\" "
        "--enable-logging=stderr --dump-dom \"file://$PWD/k.html#t=1.4021\"");
    EXPECT_THAT(shown.err, Not(HasSubstr("Uncaught")));
    std::smatch title;
    return std::regex_search(shown.out, title, std::regex("<title>([^<]*)")) ? title[1].str() : "none";
  };
  EXPECT_EQ(with_key("f"), "#t=1.4021");
  EXPECT_EQ(with_key("1"), "#t=1.4021&amp;agv=0");
  EXPECT_EQ(with_key("j"), "#t=1.5");
}

}  // namespace
}  // namespace fleetproof::replay_event_log_test
