// What an AGV was asking when it went, and whether that had been answered.
#include "reports/replay_page/own_request.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include "reports/replay_page/drive_reasons.hpp"
#include "reports/replay_page/replay_page.hpp"

namespace fleetproof::web::own_request_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

Message message(std::uint32_t number, std::size_t sender, const char* kind, std::string content, std::int64_t sent_us,
                Receipt receipt = Receipt::Received) {
  Message sent;
  sent.number = number;
  sent.sender = sender;
  sent.kind = kind;
  sent.content = std::move(content);
  sent.sent_us = sent_us;
  sent.order = number;
  sent.receiver = 1 - sender;
  sent.arrivals = {
      {1 - sender, receipt, receipt == Receipt::Received ? 1'000 : 0, number, receipt == Receipt::LostAsGiven}};
  return sent;
}

// A drove s to t with its request 2.0, asks with 3.0 for t to u on its way, and goes on to u. Its REQUEST is lost.
Film film_of(const char* last_answer) {
  Film film;
  film.end_us = 30'000'000;
  film.focus_us = 22'000'000;
  film.open_us = 19'000'000;
  film.failed = true;
  film.story = {"They touch.", "The scenario decides the delivery of 1 message (1 lost)."};
  film.involved = {0, 1};
  film.bodies = {{"A", BodyKind::Agv}, {"B", BodyKind::Agv}};
  film.outlines = {{1'600'000, 1'000'000, 0}};
  film.activities = {{0, 12'000'000, 20'000'000, "drive", "s to t", 100, 101},
                     {0, 20'000'000, 24'000'000, "drive", "t to u", 102, 103, 18'100'000, 50}};
  MotionPiece moves;  // B is no obstacle that stands there
  moves.body = 1;
  moves.moving = Moving::Drives;
  moves.end_us = 25'000'000;
  film.pieces = {moves};
  TooClose close;
  close.b = 1;
  close.first_us = close.closest_us = close.last_us = 22'000'000;
  film.violations = {close};
  film.messages = {message(1, 0, "REQUEST", "asks with 2.0 for s to t", 9'000'000),
                   message(2, 1, "GRANT", "answers 2.0, holds u", 9'100'000),
                   message(3, 0, "REQUEST", "asks with 3.0 for t to u", 17'000'000, Receipt::LostAsGiven),
                   message(4, 1, "GRANT", last_answer, 18'000'000)};
  return film;
}

Reason reason_for(const Film& film) { return drive_reasons(film).front(); }

TEST(OwnRequest, AnAnswerToAnOlderRequestIsNone) {
  const Reason reason = reason_for(film_of("answers 2.0, holds u"));
  EXPECT_EQ(reason.title, "A began to drive t to u at 20.000 s, commanded at 18.100 s");
  ASSERT_NE(reason.decisive(), nullptr);
  EXPECT_EQ(reason.decisive(), &reason.lines.front()) << "it stands first";
  EXPECT_EQ(reason.decisive()->text,
            "A had asked for this with REQUEST #3 (asks with 3.0 for t to u), sent 17.000 s: lost on purpose by the "
            "scenario. By 18.100 s, no answer to 3.0 from B had reached it; the last that had, GRANT #4, answers 2.0.");
}

TEST(OwnRequest, AnAnswerInTimeIsSaidWithoutRed) {
  const Reason reason = reason_for(film_of("answers 3.0, holds u"));
  EXPECT_EQ(reason.decisive(), nullptr);
  EXPECT_EQ(reason.lines.front().text,
            "A had asked for this with REQUEST #3 (asks with 3.0 for t to u), sent 17.000 s: lost on purpose by the "
            "scenario. B had answered that with GRANT #4 (answers 3.0, holds u), received 18.001 s.");
}

// An answer that was taken back is not hidden by the last one, nor does it hide it.
TEST(OwnRequest, SaysHowAnswersChanged) {
  Film film = film_of("answers 3.0, holds u");
  film.messages.push_back(message(5, 1, "GRANT", "answers 3.0, holds u", 18'020'000));
  film.messages.push_back(message(6, 1, "DEFER", "answers 3.0, holds t to u", 18'050'000));
  film.messages.push_back(message(7, 1, "STATE", "answers 3.0, holds t to u", 18'060'000));
  film.messages.back().receiver.reset();  // to all
  EXPECT_THAT(reason_for(film).lines.front().text,
              HasSubstr("B had answered that with GRANT #5 (answers 3.0, holds u), received 18.021 s, then with DEFER "
                        "#6 (answers 3.0, holds t to u), received 18.051 s."));
  film.messages.push_back(message(8, 1, "GRANT", "answers 3.0, holds u", 18'070'000));
  film.messages.push_back(message(9, 1, "DEFER", "answers 3.0, holds u", 18'080'000));
  EXPECT_THAT(reason_for(film).lines.front().text, HasSubstr("B had answered that with DEFER #6")) << "the last three";
}

// It asked B again with 3.1, in a message that names no place.
TEST(OwnRequest, AnAnswerToALaterAttemptIsOne) {
  Film film = film_of("answers 3.1, holds u");
  film.messages.push_back(message(5, 0, "STATE", "asks with 3.1", 17'500'000));
  const Reason reason = reason_for(film);
  EXPECT_EQ(reason.decisive(), nullptr);
  EXPECT_THAT(reason.lines.front().text, EndsWith("B had answered that with GRANT #4 (answers 3.1, holds u), received "
                                                  "18.001 s."));
}

// A number that B has from before A began anew.
TEST(OwnRequest, AnAnswerToWhatWasNotAskedYetIsDecisive) {
  Film film = film_of("answers 3.1, holds u");
  film.happenings = {{0, 16'500'000, "fault over", "restart", true, false, 40}};
  film.messages.push_back(message(5, 0, "STATE", "asks with 3.1", 18'050'000));
  const Reason reason = reason_for(film);
  ASSERT_NE(reason.decisive(), nullptr);
  EXPECT_THAT(reason.decisive()->text,
              EndsWith("But GRANT #4 was sent 18.000 s, and from 16.500 s until then A had not asked it with 3.1."));
}

// A STATE to all answers a 3.0; with a third AGV, that may be the request of the third one.
TEST(OwnRequest, WhatAnswersAllMayAnswerAnother) {
  Film film = film_of("answers 2.0, holds u");
  film.messages.push_back(message(5, 1, "STATE", "answers 3.0, holds u", 18'020'000));
  film.messages.back().receiver.reset();
  EXPECT_THAT(reason_for(film).lines.front().text, HasSubstr("B had answered that with STATE #5"));
  film.bodies.push_back({"C", BodyKind::Agv});
  for (const ReasonLine& line : reason_for(film).lines) {
    EXPECT_THAT(line.text, Not(HasSubstr("had answered that")));
    EXPECT_THAT(line.text, Not(HasSubstr("no answer to 3.0"))) << "it may be one";
  }
  film.messages.back().sent_us = 16'000'000;  // before A asked
  EXPECT_THAT(reason_for(film).lines.front().text, HasSubstr("no answer to 3.0 from B had reached it"));
}

// It meets B in the turn with which a way begins: no drive names that way.
TEST(OwnRequest, ATurnBelongsToTheRequestFromItsStation) {
  Film film = film_of("answers 3.0, holds u");
  film.stations = {{"s", 0, 0}, {"t", 9'000'000, 0}};
  film.activities[1].kind = "turn";
  film.activities[1].details = "to 90\u00b0";
  MotionPiece turn;
  turn.moving = Moving::Turns;
  turn.begin_us = 20'000'000, turn.end_us = 24'000'000;
  turn.x_um = 9'000'000;
  film.pieces.push_back(turn);
  EXPECT_THAT(reason_for(film).lines.front().text,
              HasSubstr("A had asked for this with REQUEST #3 (asks with 3.0 for t to u)"));
  film.pieces.back().x_um = 5'000'000;  // at no station: what belongs to it is not known
  EXPECT_THAT(reason_for(film).lines.front().text, Not(HasSubstr("had asked for this with REQUEST #3")));
}

// What is not known is not said.
TEST(OwnRequest, SaysNothingIfAnAnswerMayBeAmongOthers) {
  const Film film = film_of("answers 2.0, 5.0, ...");
  for (const ReasonLine& line : reason_for(film).lines) EXPECT_THAT(line.text, Not(HasSubstr("no answer to")));
  Film plain = film_of("");
  for (Message& m : plain.messages) m.content.clear();
  for (const ReasonLine& line : reason_for(plain).lines) EXPECT_THAT(line.text, Not(HasSubstr("had asked for this")));
}

// It asks on its way for what comes later: that is no fault, and not marked.
TEST(OwnRequest, ARequestForALaterDriveIsNotDecisive) {
  Film film = film_of("answers 2.0, holds u");
  film.messages[0].content = "asks with 2.0 for s to u";
  film.messages[2].content = "asks with 3.0 for u to v";
  const Reason reason = reason_for(film);
  EXPECT_EQ(reason.decisive(), nullptr);
  EXPECT_THAT(reason.lines.front().text, HasSubstr("A had asked for this with REQUEST #1 (asks with 2.0 for s to u)"))
      << "the request of the drive before";
}

// It came to the end of what it had asked for, and drove on.
TEST(OwnRequest, SaysThatItWentOnWithoutAsking) {
  Film film = film_of("answers 2.0, holds u");
  film.messages.erase(film.messages.begin() + 2);
  const Reason reason = reason_for(film);
  EXPECT_EQ(reason.decisive(), nullptr) << "perhaps it need not ask";
  EXPECT_TRUE(std::ranges::any_of(reason.lines, [](const ReasonLine& line) {
    return !line.marked &&
           line.text ==
               "The last that A had asked B was REQUEST #1 (asks with 2.0 for s to t), sent 9.000 s. It reached the "
               "end of that way at 20.000 s and went on without asking B or all for more. It need not ask again where "
               "the rules of its agent say so.";
  }));
}

// All that it has asked for since it knows of anything begins elsewhere.
TEST(OwnRequest, SaysThatItDidNotAskForThis) {
  Film film = film_of("answers 3.0, holds u");
  film.happenings = {{0, 16'500'000, "fault over", "restart", true, false, 40}};
  film.messages[2].content = "asks with 3.0 for x to t";
  const Reason reason = reason_for(film);
  EXPECT_EQ(reason.decisive(), nullptr) << "perhaps it need not ask";
  std::string all;
  for (const ReasonLine& line : reason.lines) all += line.text + "\n";
  EXPECT_THAT(all, HasSubstr("A had not asked B for this: since 16.500 s, none of its requests"));
  film.messages[2].content = "asks with 3.0";
  for (const ReasonLine& line : reason_for(film).lines) EXPECT_THAT(line.text, Not(HasSubstr("had not asked")));
}

// An agent that began anew knows nothing of what it was told before.
TEST(OwnRequest, AnAnswerBeforeARestartIsForgotten) {
  Film film = film_of("answers 2.0, holds u");
  film.happenings = {{0, 18'050'000, "fault over", "restart", true, false, 40}};
  const Reason reason = reason_for(film);
  std::string all;
  for (const ReasonLine& line : reason.lines) all += line.text + "\n";
  EXPECT_THAT(all, HasSubstr("The agent of A began anew at 18.050 s, without what it knew before."));
  EXPECT_THAT(all, Not(HasSubstr("GRANT #4")));
}

TEST(OwnRequest, ThePageLeadsWithItAndOpensAtTheDecision) {
  const std::string page = replay_page(film_of("answers 2.0, holds u"));
  const auto head = page.find("<p class=\"decisive\" data-us=\"18100000\">A had asked for this with REQUEST #3");
  ASSERT_NE(head, page.npos);
  EXPECT_LT(head, page.find("The scenario decides the delivery"));
  EXPECT_THAT(page,
              HasSubstr("<p class=\"given\" data-us=\"17000000\">REQUEST #3 (asks with 3.0 for t to u) from A to B, "
                        "sent 17.000 s: lost on purpose by the scenario.</p>"));
  EXPECT_THAT(page, HasSubstr("\"open_us\":18100000"));
}

}  // namespace
}  // namespace fleetproof::web::own_request_test
