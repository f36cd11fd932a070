// What a reason says of the other of the pair when it sent its answer: it stands in the way, and says yes.
#include "reports/replay_page/body_then.hpp"

#include <gmock/gmock.h>

#include "reports/replay_page/drive_reasons.hpp"

namespace fleetproof::web::body_then_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// B drives until 2.5 s and breaks down at 2 s. A asks at 2.9 s; B says no at 3 s and yes at 4 s, and A sets off at 5 s
// and meets B at 8 s.
class BodyThen : public testing::Test {
 protected:
  BodyThen() {
    film_.end_us = 10'000'000;
    film_.focus_us = 8'000'000;
    film_.involved = {0, 1};
    film_.bodies = {{"A", BodyKind::Agv}, {"B", BodyKind::Agv}};
    film_.activities = {{1, 1'000'000, 9'000'000, "drive", "p to q"}, {0, 5'000'000, 9'000'000, "drive", "s to t"}};
    film_.pieces = {moving(1, 1'000'000, 2'500'000), moving(0, 5'000'000, 9'000'000)};
    film_.states = {{1, 1'000'000, "driving"}, {0, 2'900'000, "asking"}, {1, 4'000'500, "broken"}};
    film_.happenings = {happening(1, 2'000'000, "fault", "breakdown"), happening(0, 4'500'000, "probe", "hurried")};
    film_.happenings[1].is_fault = false;
    film_.happenings[1].is_note = true;
    film_.messages = {message(1, 0, "ASK", 2'900'000), message(2, 1, "NO", 3'000'000), message(3, 1, "YES", 4'000'000)};
    TooClose close;
    close.b = 1;
    close.first_us = close.closest_us = close.last_us = 8'000'000;
    film_.violations = {close};
  }
  static MotionPiece moving(std::size_t body, std::int64_t begin_us, std::int64_t end_us) {
    MotionPiece piece;
    piece.body = body;
    piece.moving = Moving::Drives;
    piece.begin_us = begin_us;
    piece.end_us = end_us;
    return piece;
  }
  static Happening happening(std::size_t body, std::int64_t at_us, const char* what, const char* details) {
    Happening h{body, at_us, what, details};
    h.is_fault = true;
    return h;
  }
  static Message message(std::uint32_t number, std::size_t sender, const char* kind, std::int64_t sent_us) {
    Message sent;
    sent.number = number;
    sent.sender = sender;
    sent.receiver = 1 - sender;
    sent.kind = kind;
    sent.sent_us = sent_us;
    sent.arrivals = {{1 - sender, Receipt::Received, 1'000}};
    return sent;
  }
  std::vector<ReasonLine> lines() const { return drive_reasons(film_).front().lines; }
  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    for (const ReasonLine& line : lines()) texts.push_back(line.text);
    return texts;
  }

  Film film_;
};

TEST_F(BodyThen, SaysYesWhereItIsMet) {
  const std::string text =
      "B sent YES #3 from the place where A then met it: drive p to q, since 1.000 s; its agent said \"driving\"; "
      "breakdown since 2.000 s, not over; "
      "it stood where A then met it, since 2.500 s.";
  const auto said = lines();
  const auto found = std::ranges::find(said, text, &ReasonLine::text);
  ASSERT_TRUE(found != said.end());
  EXPECT_TRUE(found->marked);
  EXPECT_THAT(texts(), Contains("Its answer before that was NO #2, sent 3.000 s. Between the two, it did not move; its "
                                "agent said \"broken\" (4.000 s)."));
}

TEST_F(BodyThen, MovesOnAfterItsAnswer) {
  film_.pieces.push_back(moving(1, 6'000'000, 7'000'000));
  film_.happenings.push_back(happening(1, 3'500'000, "fault over", "breakdown"));
  EXPECT_THAT(texts(), Not(Contains(HasSubstr("it stood where"))));
  EXPECT_THAT(texts(), Contains("B sent YES #3: drive p to q, since 1.000 s; its agent said \"driving\"."));
  EXPECT_THAT(texts(), Contains(HasSubstr("it did not move; its agent said \"broken\" (4.000 s); fault over: breakdown "
                                          "(3.500 s)")));
  EXPECT_EQ(stood_there_since(film_, 1, 7'500'000), 7'000'000);
  EXPECT_EQ(stood_there_since(film_, 1, 7'000'000), std::nullopt) << "it has only just stopped";
  film_.pieces.push_back(moving(1, 3'200'000, 3'300'000));
  EXPECT_THAT(texts(), Contains(HasSubstr("Between the two, it moved;")));
}

TEST_F(BodyThen, OnlyThePairOfAViolationIsMet) {
  film_.bodies.push_back({"C", BodyKind::Agv});
  EXPECT_EQ(stood_there_since(film_, 2, 7'500'000), std::nullopt);
  film_.violations.clear();
  EXPECT_EQ(stood_there_since(film_, 1, 7'500'000), std::nullopt);
}

TEST_F(BodyThen, TheSameAnswerTwiceIsNoChange) {
  film_.messages[1].kind = "YES";
  EXPECT_THAT(texts(), Not(Contains(HasSubstr("Its answer before that"))));
}

TEST_F(BodyThen, TheAgvHasAnsweredToo) {
  EXPECT_THAT(texts(), Not(Contains(HasSubstr("A itself had last answered"))));
  film_.messages.insert(film_.messages.begin() + 2, message(4, 0, "YES", 3'900'000));
  EXPECT_THAT(texts(), Contains("A itself had last answered B with YES #4, sent 3.900 s, received 3.901 s."));
  film_.messages[2].arrivals[0].after_us = 2'000'000;
  EXPECT_THAT(texts(),
              Contains("A itself had last answered B with YES #4, sent 3.900 s, still under way then, received "
                       "5.900 s."));
  film_.messages[2].arrivals[0].after_us = 6'100'001;
  EXPECT_THAT(texts(), Contains("A itself had last answered B with YES #4, sent 3.900 s, still under way at the end of "
                                "the run."));
}

TEST_F(BodyThen, TheAgentNotes) { EXPECT_THAT(texts(), Contains("Its agent noted hurried (4.500 s).")); }

}  // namespace
}  // namespace fleetproof::web::body_then_test
