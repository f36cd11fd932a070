// When an AGV decided on what it does: told by the word of its agent, and by what it asked on its way.
#include "reports/replay_page/setting_off.hpp"

#include <gmock/gmock.h>

#include "reports/replay_page/drive_reasons.hpp"

namespace fleetproof::web::setting_off_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// AGV 0 asks at 1 s, drives from 3 s to 9 s without a rest, and touches AGV 1 at 8 s. AGV 1 answers at once, its answer
// arrives at 4 s.
Film rolling_film() {
  Film film;
  film.end_us = 10'000'000;
  film.focus_us = 8'000'000;
  film.involved = {0, 1};
  film.bodies = {{"A", BodyKind::Agv}, {"B", BodyKind::Agv}};
  film.activities = {{0, 3'000'000, 5'000'000, "drive", "s to t"},
                     {0, 5'000'000, 6'000'000, "turn", "to 90"},
                     {0, 6'000'000, 9'000'000, "drive", "t to u"}};
  film.states = {{0, 1'000'000, "requesting"}, {0, 3'000'500, "driving"}};
  TooClose close;
  close.b = 1;
  close.first_us = close.closest_us = close.last_us = 8'000'000;
  film.violations = {close};
  const auto message = [](std::uint32_t number, std::size_t sender, const char* kind, std::int64_t sent_us,
                          std::int64_t after_us) {
    Message sent;
    sent.number = number;
    sent.sender = sender;
    sent.receiver = 1 - sender;
    sent.kind = kind;
    sent.sent_us = sent_us;
    sent.arrivals = {{1 - sender, Receipt::Received, after_us}};
    return sent;
  };
  film.messages = {message(1, 0, "ASK", 1'000'000, 999'000), message(2, 1, "NO", 2'000'000, 2'000'000)};
  return film;
}

std::vector<std::string> lines_of(const Reason& reason) {
  std::vector<std::string> texts;
  for (const ReasonLine& line : reason.lines) texts.push_back(line.text);
  return texts;
}

TEST(SettingOff, IsWhereTheWordOfTheAgentBegan) {
  const Film film = rolling_film();
  EXPECT_EQ(setting_off(film, 2), 0U);
  EXPECT_EQ(setting_off(film, 1), 0U);
  EXPECT_EQ(setting_off(film, 0), 0U);
}

TEST(SettingOff, IsTheActivityItselfIfTheWordTellsNothing) {
  Film silent = rolling_film();
  silent.states.clear();
  EXPECT_EQ(setting_off(silent, 2), 2U);
  Film always = rolling_film();
  always.states = {{0, 0, "on duty"}};
  EXPECT_EQ(setting_off(always, 2), 2U) << "said long before";
  Film anew = rolling_film();
  anew.states.push_back({0, 5'500'000, "asking"});
  anew.states.push_back({0, 6'000'000, "driving"});
  EXPECT_EQ(setting_off(anew, 2), 2U) << "said again with the last drive";
  Film rested = rolling_film();
  rested.activities[0].end_us = 4'000'000;
  EXPECT_EQ(setting_off(rested, 2), 2U) << "it stood for a second";
  Film loads = rolling_film();
  loads.activities[1].kind = "pick";
  EXPECT_EQ(setting_off(loads, 2), 2U);
}

// At 6 s the answer is there, at 3 s it was not.
TEST(SettingOff, TheReasonSaysWhatWasKnownThen) {
  const Reason reason = drive_reasons(rolling_film()).front();
  EXPECT_EQ(reason.title, "A began to drive t to u at 6.000 s");
  EXPECT_EQ(reason.decided_us, 3'000'000);
  const auto lines = lines_of(reason);
  EXPECT_THAT(lines.front(), StartsWith("It set off at 3.000 s (drive s to t), has moved since"));
  EXPECT_THAT(lines, Contains("NO #2, sent 2.000 s: received 4.000 s, 1.000 s too late; the newest ASK of A that B had "
                              "received by then was #1 (sent "
                              "1.000 s)."));
}

TEST(SettingOff, TheReasonSaysWhatTheMessagesSaid) {
  Film film = rolling_film();
  film.messages[0].content = "for 7";
  film.messages[1].content = "to 7";
  EXPECT_THAT(lines_of(drive_reasons(film).front()),
              Contains("NO #2 (to 7), sent 2.000 s: received 4.000 s, 1.000 s too late; the newest ASK of A that B had "
                       "received by then was #1 (for 7, sent "
                       "1.000 s)."));
}

TEST(SettingOff, AnAgvThatAsksOnItsWayDecidesAnew) {
  Film film = rolling_film();
  Message again = film.messages[0];
  again.number = 3;
  again.sent_us = 5'200'000;
  again.arrivals[0].after_us = 100'000;
  film.messages.push_back(again);
  const Reason reason = drive_reasons(film).front();
  EXPECT_EQ(reason.decided_us, 6'000'000);
  EXPECT_THAT(lines_of(reason), Not(Contains(HasSubstr("set off"))));
}

// A fleet that says a lot: those nearest to the failure stay.
TEST(DriveReasons, AreNotMoreThanAPageCanCarry) {
  Film film = rolling_film();
  film.states.clear();
  for (Message& message : film.messages) message.content = std::string(20'000, 'x');
  film.activities.clear();
  for (std::int64_t i = 0; i < 60; ++i)
    film.activities.push_back({0, 5'000'000 + 20'000 * i, 5'010'000 + 20'000 * i, "drive", "s to t"});
  const auto reasons = drive_reasons(film);
  ASSERT_GE(reasons.size(), 4U);
  std::size_t bytes = 0;
  for (const Reason& reason : reasons) {
    for (const ReasonLine& line : reason.lines) bytes += line.text.size();
  }
  EXPECT_LE(bytes, 400'000U);
  EXPECT_TRUE(reasons[0].is_fatal);
  EXPECT_TRUE(reasons[1].is_fatal) << "B had begun nothing";
  for (std::size_t i = 2; i < reasons.size(); ++i) EXPECT_EQ(reasons[i].activity, 59 - reasons.size() + i);
}

// What an AGV sends all the time is heard before most answers, but is not what they answer.
TEST(SettingOff, AKindSentAllTheTimeIsNotTheOneThatAsks) {
  Film film = rolling_film();
  std::vector<Message> news;
  for (std::uint32_t i = 0; i < 9; ++i) {
    Message m = film.messages[0];
    m.number = 10 + i;
    m.kind = "NEWS";
    m.sent_us = 100'000 + 200'000 * i;
    m.arrivals[0].after_us = 1'000;
    news.push_back(m);
  }
  news.insert(news.begin() + 5, film.messages[0]);
  news.push_back(film.messages[1]);
  // A second answer, right after news.
  Message more = film.messages[1];
  more.number = 30;
  more.sent_us = 2'000'500;
  news.push_back(more);
  film.messages = news;
  EXPECT_THAT(lines_of(drive_reasons(film).front()),
              Contains(HasSubstr("the newest ASK of A that B had received by then was #1")));
}

}  // namespace
}  // namespace fleetproof::web::setting_off_test
