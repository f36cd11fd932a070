#include "core/agents/message_text.hpp"

#include <gmock/gmock.h>

#include <string>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::message_text_test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// Four stations in a row, with lanes 0, 2, 4 from each to the next one.
struct Row {
  explicit Row(const char* a = "C2", const char* b = "C4", const char* c = "C12", const char* d = "C14") {
    std::uint32_t before = 0;
    double x_m = 0.0;
    for (const char* name : {a, b, c, d}) {
      const std::uint32_t station = drawn.station(x_m, 0.0, FP_ROUTING, name);
      if (station > 0) drawn.segment(before, station);
      before = station;
      x_m += 5.0;
    }
    view.emplace(drawn.map());
  }
  Path path(std::uint32_t from, std::uint32_t to) const {
    Path path;
    path.station = from;
    for (std::uint32_t s = from; s < to; ++s) path.append(drawn.lane_between(s, s + 1));
    return path;
  }
  std::string text(const Message& message) const { return MessageText(message, *view).c_str(); }

  testing::DrawnMap drawn;
  std::optional<MapView> view;
};

Message request(const Row& row, std::uint32_t held_from = 1) {
  Message message;
  message.kind = MessageKind::Request;
  message.status.epoch = 3 * kAttempts;
  message.status.held = row.path(held_from, 1);
  message.request = row.path(1, 3);
  message.asked.add({7, 0});
  return message;
}

TEST(RequestNames, NameTheAgvThatAsks) {
  const Row row;
  const RequestNames asked(request(row), 2, FP_NONE);
  EXPECT_STREQ(asked.asks(), "2/3") << "all attempts are one request";
  EXPECT_STREQ(asked.answers(), "");
  Message grant;
  grant.kind = MessageKind::Grant;
  grant.echo = first_epoch(1) + 4 * kAttempts + 2;
  EXPECT_STREQ(RequestNames(grant, 5, 2).answers(), "2/4 of boot 1");
  EXPECT_STREQ(RequestNames(grant, 5, 2).asks(), "");
  Message state;
  state.kind = MessageKind::State;
  state.answers.count = 0;
  state.status.requesting = false;
  for (std::uint32_t agv = 0; agv < Answers::kMax; ++agv) state.answers.add({agv, 7 * kAttempts, true});
  EXPECT_THAT(std::string(RequestNames(state, 5, FP_NONE).answers()), StartsWith("0/7,1/7,2/7,3/7,"));
  EXPECT_LT(std::string(RequestNames(state, 5, FP_NONE).answers()).size(), 128U);
}

TEST(MessageText, SaysWhatIsAskedFor) {
  const Row row;
  EXPECT_EQ(row.text(request(row)), "REQUEST: asks with 3.0 for C4 to C14");
  EXPECT_EQ(row.text(request(row, 0)), "REQUEST: asks with 3.0 for C4 to C14, holds from C2");
  Message again = request(row);
  again.asked.add({8, 0});
  again.asked.add({9, 1});
  EXPECT_EQ(row.text(again), "REQUEST: asks with 3.0, 3.1 for C4 to C14") << "each attempt once";
  again.status.epoch += first_epoch(1);
  EXPECT_EQ(row.text(again), "REQUEST: asks with 3.0 of boot 1, 3.1 of boot 1 for C4 to C14");
}

TEST(MessageText, SaysWhatIsHeld) {
  const Row row;
  Message message;
  message.status.held = row.path(1, 3);
  EXPECT_EQ(row.text(message), "STATE: holds C4 to C14");
  message.kind = MessageKind::Grant;
  message.echo = 7 * kAttempts + 12;
  EXPECT_EQ(row.text(message), "GRANT: answers 7.12, holds C4 to C14");
  message.kind = MessageKind::Defer;
  message.status.held = row.path(2, 2);
  EXPECT_EQ(row.text(message), "DEFER: answers 7.12, holds C12");
}

// A STATE asks and answers as well. What it answers stands there even if not all of it has room.
TEST(MessageText, AStateNamesItsAnswers) {
  const Row row;
  Message message = request(row);
  message.kind = MessageKind::State;
  message.status.requesting = true;
  message.answers.add({1, 3 * kAttempts, true});
  EXPECT_EQ(row.text(message), "STATE: answers 3.0, asks with 3.0 for C4 to C14");
  message.answers.add({2, 4 * kAttempts, true});
  message.answers.add({3, 5 * kAttempts, true});
  EXPECT_EQ(row.text(message), "STATE: answers 3.0, 4.0, ..., asks with 3.0 for C4 to C14");
  message.asked = {};
  EXPECT_THAT(row.text(message), HasSubstr(", asks nobody with 3.0 for C4"));
  message.answers = {};
  message.answers.add({1, first_epoch(4'000'000'000) + 16'000'000 * kAttempts, true});
  EXPECT_THAT(row.text(message), StartsWith("STATE: answers ..., asks nobody with 3.0")) << "no number is cut";
}

// The end of a name remains, in whole characters.
TEST(MessageText, LongNamesAreCutBetweenCharacters) {
  const char* const names[] = {"a", "the-northern-aisle-of-the-second-hall-12", "ß",
                               "倉庫倉庫倉庫倉庫倉庫倉庫倉庫倉庫倉庫倉庫三号棚"};
  const Row row(names[0], names[1], names[2], names[3]);
  const std::string text = row.text(request(row));
  EXPECT_LE(text.size(), MessageText::kBytes);
  EXPECT_GE(text.size(), MessageText::kBytes - 4) << "it uses its room";
  EXPECT_THAT(text, StartsWith("REQUEST: asks with 3.0 for \u2026"));
  EXPECT_THAT(text, HasSubstr("hall-12 to \u2026"));
  EXPECT_THAT(text, EndsWith("三号棚"));
  const std::string cut = text.substr(text.rfind("\u2026") + 3);
  EXPECT_EQ(cut.size() % 3, 0U) << "each of these characters has three bytes: " << cut;
}

TEST(MessageText, WithoutRoomPlacesAreLeftOut) {
  const std::string name(100, 'x');
  const Row row(name.c_str(), name.c_str(), name.c_str(), name.c_str());
  Message message = request(row, 0);
  for (std::uint32_t i = 1; i < 20; ++i) message.asked.add({7 + i, i});
  const std::string text = row.text(message);
  EXPECT_LE(text.size(), MessageText::kBytes);
  EXPECT_THAT(text, StartsWith("REQUEST: asks with 3.0, 3.1, 3.2,"));
  EXPECT_THAT(text, EndsWith(", ..."));
  EXPECT_THAT(text, Not(HasSubstr("x")));
}

}  // namespace
}  // namespace fleetproof::agents::message_text_test
