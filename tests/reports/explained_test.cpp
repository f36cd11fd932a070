// What `explain` found of a run, as a file beside its results file and as a part of its page.
#include "reports/replay_page/explained.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "reports/replay_page/differences.hpp"
#include "reports/replay_page/replay_page.hpp"

namespace fleetproof::web::explained_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ExplainedRun found() {
  ExplainedRun run;
  run.of = "0123 7 4567";
  run.failure = "contact, two AGVs";
  run.lead = "It needs the loss of <message> 5.";
  run.lines = {{"The smallest case fails at 4.000 s: contact of A and B.", 4'000'000, false, {}},
               {"It needs the loss of <message> 5.", 2'000'000, false, {1, 2}},
               {"It is certain from 19.000 s on.", 19'000'000, true, {}}};
  run.curve = {{10'000'000, 30}, {20'000'000, 59}};
  run.branches = 59;
  return run;
}

Film film_of(const char* second) {
  Film film;
  film.title = "A and B";
  film.failed = true;
  film.story = {"They touch."};
  film.end_us = 40'000'000;
  film.focus_us = 20'000'000;
  film.involved = {0, 1};
  film.bodies = {{"A", BodyKind::Agv}, {second, BodyKind::Agv}};
  film.activities = {{0, 15'000'000, 20'000'000, "drive", "p to q"}};
  return film;
}

pugi::xml_document page_of(const ExplainedPart& part) {
  pugi::xml_document document;
  const std::string page = replay_page(film_of("B"), part);
  EXPECT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  return document;
}
std::vector<std::string> attributes(const pugi::xml_document& document, const char* query, const char* name) {
  std::vector<std::string> found;
  for (const auto& node : document.select_nodes(query)) found.emplace_back(node.node().attribute(name).value());
  return found;
}

TEST(Explained, IsReadAsItWasWritten) {
  EXPECT_EQ(parse_explained(explained_text(found())), found());
  for (const char* other : {"", "{}", "[1]", R"({"schema_version": 1})", R"({"schema_version": 99, "of": ""})"})
    EXPECT_FALSE(parse_explained(other)) << other;
}

TEST(Explained, AnInstantThatNoRunHasIsRefused) {
  for (const std::int64_t at_us : {std::int64_t{-1}, std::int64_t{1'000'000'000'000'001}, INT64_MAX}) {
    ExplainedRun run = found();
    run.curve.front().at_us = at_us;
    EXPECT_FALSE(parse_explained(explained_text(run)).has_value()) << at_us;
    run = found();
    run.lines.back().at_us = at_us;
    EXPECT_FALSE(parse_explained(explained_text(run)).has_value()) << at_us;
  }
}

TEST(Explained, ThePageOfTheRunGoesToItsOwnInstantsOnly) {
  ExplainedPart part;
  part.run = found();
  const auto alone = page_of(part);
  EXPECT_THAT(attributes(alone, "//div[@id='why']/p[@data-us]", "data-us"), ElementsAre("19000000"))
      << "the others are instants of another case";
  EXPECT_TRUE(alone.select_nodes("//div[@id='why']//a").empty()) << "no other page is there";
  EXPECT_THAT(alone.select_node("//p[@class='decisive']").node().text().get(),
              HasSubstr("In the smallest case that fails in the same way: It needs the loss of <message> 5."));
  EXPECT_EQ(alone.select_nodes("//figure[@class='curve']//circle").size(), 2U);
}

TEST(Explained, LinksLeadToTheCaseAndToTheRunsThatHavePages) {
  ExplainedPart part;
  part.run = found();
  part.run_page = "index.html";
  part.small_page = "smallest.html";
  part.run_pages = 1;
  EXPECT_THAT(attributes(page_of(part), "//div[@id='why']//a", "href"),
              ElementsAre("smallest.html#t=4.000", "smallest.html#t=2.000", "001.html"));
  part.shows = ExplainedPart::Shows::Smallest;
  const auto small = page_of(part);
  EXPECT_THAT(attributes(small, "//div[@id='why']/p[@data-us]", "data-us"), ElementsAre("4000000", "2000000"));
  EXPECT_THAT(attributes(small, "//div[@id='why']//a", "href"), ElementsAre("001.html", "index.html#t=19.000"));
  EXPECT_STREQ(small.select_node("//p[@class='decisive']").node().text().get(), "It needs the loss of <message> 5.");
}

TEST(Explained, WithoutItThePageSaysHowToFindOut) {
  ExplainedPart part;
  EXPECT_TRUE(page_of(part).select_nodes("//div[@id='why']/*").empty()) << "a clean run";
  part.command = "fleetproof explain night.db 7";
  const auto page = page_of(part);
  EXPECT_STREQ(page.select_node("//div[@id='why']//code").node().text().get(), "fleetproof explain night.db 7");
  EXPECT_TRUE(page.select_nodes("//p[@class='decisive']").empty());
}

// The rows: instant, failing, changed.
std::vector<std::string> rows(const Film& failing, const Film& changed) {
  pugi::xml_document document;
  const std::string part = differences_part(failing, changed, "smallest.html").str();
  EXPECT_TRUE(document.load_buffer(part.data(), part.size()));
  std::vector<std::string> rows;
  for (const auto& row : document.select_nodes("//tbody/tr")) {
    std::string text;
    for (const pugi::xml_node cell : row.node().children("td")) {
      const auto link = cell.child("a");
      text += (text.empty() ? "" : "|") + std::string(link ? link.attribute("href").value() : cell.text().get());
    }
    rows.push_back(text);
  }
  return rows;
}

TEST(Differences, WhatBothRunsHaveStandsOnceAndEachDifferenceLeadsToTheNext) {
  Film failing = film_of("B");
  failing.states = {{0, 14'000'000, "asking"}, {1, 16'000'000, "waiting"}, {0, 18'000'000, "driving"}};
  Film changed = film_of("B");
  changed.focus_us = 39'000'000;  // it does not fail
  changed.involved.clear();
  changed.states = {{0, 14'000'000, "asking"}, {1, 16'000'000, "asking"}};
  EXPECT_THAT(rows(failing, changed),
              ElementsAre("2 lines in both",
                          "smallest.html#t=16.000|B: its agent says, \"waiting\"|B: its agent says, "
                          "\"asking\"|#difference-2",
                          "smallest.html#t=18.000|A: its agent says, \"driving\"||", "1 line in both", "The end."));
}

TEST(Differences, BodiesAreTheSameByTheirNames) {
  Film failing = film_of("B"), changed = film_of("B");
  changed.bodies = {{"B", BodyKind::Agv}};  // A is left out
  changed.activities = {{0, 15'000'000, 20'000'000, "drive", "p to q"}};
  const auto told = rows(failing, changed);
  EXPECT_THAT(told, testing::Contains(HasSubstr("A: begins drive, p to q")));
  EXPECT_THAT(told, testing::Contains(HasSubstr("|B: begins drive, p to q|")));
}

// Of several lines of one event, those that both runs have stand once, whatever stands before them.
TEST(Differences, OfOneEventWhatBothHaveIsNoDifference) {
  const auto with = [](std::vector<std::string> details) {
    Film film = film_of("B");
    for (const std::string& one : details) film.activities.push_back({0, 15'000'000, 20'000'000, "drive", one});
    return film;
  };
  EXPECT_THAT(rows(with({"a", "b"}), with({"b"})),
              testing::Contains("smallest.html#t=15.000|A: begins drive, a||#difference-2"));
  EXPECT_THAT(rows(with({"b"}), with({"a", "b"})),
              testing::Contains("smallest.html#t=15.000||A: begins drive, a|#difference-2"));
  EXPECT_THAT(rows(with({"a", "b"}), with({"b", "c"})),
              testing::Contains("smallest.html#t=15.000|A: begins drive, a|A: begins drive, c|#difference-2"));
}

TEST(Differences, TheNumberOfAMessageIsNone) {
  const auto saying = [](std::uint32_t number) {
    Film film = film_of("B");
    Message sent;
    sent.number = number;
    sent.receiver = 1;
    sent.kind = "ASK";
    sent.content = "for q";
    sent.sent_us = 14'000'000;
    sent.arrivals = {{1, Receipt::Received, 1'000}};
    film.messages = {sent};
    return film;
  };
  EXPECT_THAT(rows(saying(7), saying(12)),
              ElementsAre("3 lines in both", "No difference in the time around the failure."));
}

}  // namespace
}  // namespace fleetproof::web::explained_test
