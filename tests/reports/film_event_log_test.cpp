// What the event log has of the notes of agents.
#include "reports/replay_page/film_event_log.hpp"

#include <gmock/gmock.h>

namespace fleetproof::web::film_event_log_test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

Happening note(std::size_t body, std::int64_t at_us, const char* word) {
  Happening noted{body, at_us, "probe", word};
  noted.is_note = true;
  return noted;
}

// A and B failed; C is another AGV.
Film film_with(std::vector<Happening> happenings) {
  Film film;
  film.end_us = film.focus_us = 20'000'000;
  film.bodies = {{"A", BodyKind::Agv}, {"B", BodyKind::Agv}, {"C", BodyKind::Agv}};
  film.involved = {0, 1};
  film.happenings = std::move(happenings);
  return film;
}

std::vector<std::string> texts(const EventLog& event_log) {
  std::vector<std::string> all;
  for (const LogLine& line : event_log.lines) all.push_back(line.who + "|" + line.what + "|" + line.details);
  return all;
}

TEST(FilmEventLog, NotesStandInTheirPlaceAndThoseThatAreAlikeFold) {
  Film film = film_with({note(0, 11'000'000, "again"), note(1, 12'000'000, "unasked"), note(2, 12'500'000, "other"),
                         note(0, 13'000'000, "again"), note(0, 15'000'000, "again")});
  film.activities = {{1, 14'000'000, 21'000'000, "drive", "s to t"}};
  const EventLog event_log = event_log_of(film);
  EXPECT_THAT(texts(event_log), ElementsAre("A|its agent notes again|", "B|its agent notes unasked|",
                                            "B|begins drive|s to t", "A|its agent notes again|"));
  EXPECT_THAT(event_log.lines.front().folded, SizeIs(2));
}

// A flood of notes pushes nothing else out.
TEST(FilmEventLog, NotesHaveTheirOwnRoom) {
  std::vector<Happening> flood;
  for (int i = 0; i < 500; ++i) flood.push_back(note(0, 10'000'000 + i, i % 2 == 0 ? "tick" : "tock"));
  flood.push_back({1, 9'000'000, "order", "1: s to t"});
  const EventLog event_log = event_log_of(film_with(flood));
  EXPECT_EQ(event_log.left_out, 400U);
  EXPECT_THAT(texts(event_log), ElementsAre("B|order|1: s to t", "A|its agent notes tick|", "A|its agent notes tock|"));
}

}  // namespace
}  // namespace fleetproof::web::film_event_log_test
