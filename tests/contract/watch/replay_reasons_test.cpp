// Why an agent believed that a drive was allowed, as the replay page says it. The agent plays a list of calls and the
// scenario decides the delivery of single messages, so the truth is known before the run.
#include <gmock/gmock.h>

#include <pugixml.hpp>
#include <regex>

#include "tests/support/program.hpp"

namespace fleetproof::replay_reasons_test {
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

class ReplayReasons : public test::ProgramTest {
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
  static std::string of_m(const std::string& rest) {
    return "//div[@class='reason'][h3[starts-with(text(), 'M began')]]" + rest;
  }
};

TEST_F(ReplayReasons, SaysWhatWasDoubledLostLateAndMissing) {
  const auto document = page();
  EXPECT_THAT(texts(document, of_m("/h3")), ElementsAre("M began to drive a to b at 5.000 s"));
  EXPECT_THAT(
      texts(document, of_m("/p")),
      ElementsAre(
          "From 0.000 s until then, M had sent REQUEST 3 times (1.000 s to 3.000 s).",
          "Its agent said \"asking\" (1.000 s), \"driving\" (5.000 s).",
          "Since 0.000 s, M had sent REQUEST to all. Answers in time: GRANT from T. Lost or late: P. No answer sent to "
          "it alone: Q.",
          "P to M:",
          "DEFER #3, sent 1.600 s: lost on purpose by the scenario; the newest REQUEST of M that P had received by "
          "then was #1 (sent 1.000 s); 2 were sent later.",
          "DEFER #6, sent 4.900 s: received 5.500 s, 0.500 s too late; the newest REQUEST of M that P had received by "
          "then was #5 (sent 3.000 s).",
          "P itself at 5.000 s: idle; it stood where M then met it, since 0.000 s.", "T to M:",
          "GRANT #2, sent 1.500 s, received 1.600 s and again 1.900 s: one message, delivered twice; 3.500 s old then; "
          "the newest REQUEST of M that T had received by then was #1 (sent 1.000 s); 2 were sent later.",
          "After that #2, it received 2 REQUEST and answered none of them until then.",
          "After that it received GRANT from T (6.001 s)."));
  // What a protocol must survive is marked, nothing else.
  EXPECT_EQ(texts(document, of_m("/p[contains(@class, 'marked')]")).size(), 5U);
  EXPECT_THAT(texts(document, "//div[@class='reason']/h3"),
              ElementsAre("M began to drive a to b at 5.000 s", "P had begun nothing before the failure"));
}

// The same run without the deliveries: nothing is doubled, lost or late.
TEST_F(ReplayReasons, SaysNothingOfTheKindIfAllArrived) {
  (void)page();
  const std::string whole(kWorld);
  const auto from = whole.find("\"fates\""), to = whole.find("\"layout\"");
  write("talk.json", whole.substr(0, from) + whole.substr(to));
  ASSERT_LE(run("simulate talk.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
                "' --agent-config '" + kCalls + "' --html q.html")
                .exit_code,
            1);
  const std::string text = read(path("q.html"));
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(text.data(), text.size(), pugi::parse_full));
  EXPECT_TRUE(texts(document, "//dt[text() = 'given deliveries']").empty());
  EXPECT_THAT(
      texts(document, of_m("/p")),
      ElementsAre(
          "From 0.000 s until then, M had sent REQUEST 3 times (1.000 s to 3.000 s).",
          "Its agent said \"asking\" (1.000 s), \"driving\" (5.000 s).",
          "Since 0.000 s, M had sent REQUEST to all. Answers in time: DEFER from P; GRANT from T. No answer "
          "sent to it alone: Q.",
          "P to M:",
          "DEFER #6, sent 4.900 s, received 4.901 s; 0.100 s old then; the newest REQUEST of M that P had "
          "received by then was #5 (sent 3.000 s); 1 more before it.",
          "P sent DEFER #6 from the place where M then met it: idle; it stood where M then met it, since 0.000 s.",
          "P itself at 5.000 s: idle; it stood where M then met it, since 0.000 s.",
          "T: GRANT #2, sent 1.500 s, received 1.501 s; 3.500 s old then; the newest REQUEST of M that T had "
          "received by then was #1 (sent 1.000 s); 2 were sent later.",
          "After that it received GRANT from T (6.001 s)."));
}

TEST_F(ReplayReasons, TheEventLogHasThirdAgvsInCausalOrder) {
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
TEST_F(ReplayReasons, CallsThatAreRefusedAgainAndAgainAreOneLine) {
  const auto document = page("0 1000 move 3;0 1100 move 3;0 1200 move 3;0 2000 say asking;0 2100 move 3;0 5000 move 0");
  const auto lines = texts(document, "//div[@id='log-lines']//summary[contains(@class, 'event')]");
  EXPECT_THAT(lines, ElementsAre("1.000|M|refused move tq \u00d7 3|until 1.200 s"));
}

// The AGV turns before it drives.
TEST_F(ReplayReasons, SaysWhenADriveWasCommandedBeforeItBegan) {
  (void)page("0 100 move 0;3 1000 move 4");
  const std::string text = read(path("p.html"));
  EXPECT_THAT(text, testing::ContainsRegex("Q began to drive q to a at 3.5[0-9]* s, commanded at 1.000 s\""));
  EXPECT_THAT(text, HasSubstr("M began to drive a to b at 0.100 s<")) << "at once";
}

TEST_F(ReplayReasons, SaysHowManyMessagesHaveAGivenDelivery) {
  (void)page();
  const std::string text = read(path("p.html"));
  EXPECT_THAT(text,
              HasSubstr("<dt>given deliveries</dt><dd>3 messages (1 lost, 1 delivered twice, 1 with a given delay)"));
  EXPECT_THAT(text, HasSubstr("0 %, but of messages with a given delivery"));
}

// A message that is under way when the run ends is not forgotten.
TEST_F(ReplayReasons, SaysWhatWasStillUnderWayAtTheEnd) {
  std::string world(kWorld);
  world.replace(world.find("600000000}"), 10, "60000000000}");
  write("late.json", world);
  ASSERT_LE(run("simulate late.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
                "' --agent-config '" + kCalls + "' --html l.html")
                .exit_code,
            1);
  EXPECT_THAT(read(path("l.html")), HasSubstr("DEFER #6, sent 4.900 s: still under way at the end of the run"));
}

// M sets off at the nanosecond at which a message arrives. The trace says what came first.
TEST_F(ReplayReasons, AtOneInstantTheOrderOfTheTraceDecides) {
  std::string world(kWorld);
  world.replace(world.find("600000000}"), 9, "100000000");
  write("same.json", world);
  ASSERT_LE(run("simulate same.json --agent talker --plugin '" + std::string(FLEETPROOF_TALKING_AGENT) +
                "' --agent-config '" + kCalls + "' --html s.html --trace-output t.txt")
                .exit_code,
            1);
  const std::string trace = read(path("t.txt")), page = read(path("s.html"));
  std::smatch begins, received;
  ASSERT_TRUE(std::regex_search(trace, begins, std::regex(" 5\\.000000000 +M +begins")));
  ASSERT_TRUE(std::regex_search(trace, received, std::regex(" 5\\.000000000 +M +received +#6")));
  EXPECT_THAT(page, HasSubstr(begins.position() < received.position()
                                  ? "DEFER #6, sent 4.900 s: received 5.000 s, right after that"
                                  : "DEFER #6, sent 4.900 s, received 5.000 s; 0.100 s old then"));
}

// Keys keep the instant of the address, to the microsecond; j goes to the next line of the event_log.
TEST_F(ReplayReasons, TheAddressStaysExactInABrowser) {
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
}  // namespace fleetproof::replay_reasons_test
