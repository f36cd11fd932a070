#include "core/agents/protocol_messages.hpp"

#include <gtest/gtest.h>

#include <random>

namespace fleetproof::agents::protocol_messages_test {
namespace {

Message sample(MessageKind kind) {
  Message m;
  m.kind = kind;
  m.status.stamp_ms = 123'456;
  m.status.position_m = {-12.345, 67.891};
  m.status.epoch = 77;
  m.status.requesting = true;
  m.status.idle = true;
  m.status.held.station = 300;
  m.status.held.heading = {0.6, -0.8};
  for (std::uint32_t lane : {5U, 600U, 65'000U}) m.status.held.append(lane);
  m.heard.first = 2;
  m.heard.count = 3;
  m.heard.stamps_ms = {1, 0, 4'000'000'000U};
  m.demand_ns = 98'765'432'101'234;
  m.request.station = 301;
  m.request.heading = {0.0, 1.0};
  m.request.append(8);
  m.asked.add({7, 0});
  m.asked.add({65'000, 255}, true);
  m.answers.add({9, first_epoch(3) + 2 * kAttempts + 1, true});
  m.answers.add({10, 5, false});
  m.echo = 41;
  return m;
}

constexpr MessageKind kKinds[] = {MessageKind::State, MessageKind::Request, MessageKind::Grant, MessageKind::Defer};

Message sample_with_zones(MessageKind kind) {
  Message m = sample(kind);
  m.tells_zones = m.wants_answer = m.status.place_unknown = m.status.held_up = true;
  for (const unsigned zone : {40'000U, 7U, 71U}) m.zones.add(static_cast<std::uint16_t>(zone));
  m.about.add(7);
  m.roll.stamp_ms = 4'000'000'001U;
  m.roll.from = 12;
  m.roll.next = FP_NONE;
  m.roll.count = 2;
  m.roll.list[0] = {12, 3, 99};
  m.roll.list[1] = {500, 0, 4'000'000'002U};
  return m;
}

TEST(ProtocolMessages, ZonesAndRollsComeBackAsTheyWere) {
  for (const MessageKind kind : {MessageKind::State, MessageKind::Grant, MessageKind::Join, MessageKind::Roll}) {
    const Message sent = sample_with_zones(kind);
    const std::optional<Message> m = decode(WireMessage(sent).bytes());
    ASSERT_TRUE(m) << name_of(kind);
    EXPECT_EQ(m->kind, kind);
    EXPECT_TRUE(m->tells_zones && m->wants_answer && m->status.place_unknown && m->status.held_up);
    EXPECT_EQ(m->zones, sent.zones);
    if (kind != MessageKind::Join && kind != MessageKind::Roll) continue;
    EXPECT_EQ(m->about, sent.about);
    EXPECT_EQ(m->roll.from, 12U);
    if (kind == MessageKind::Join) continue;
    EXPECT_EQ(m->roll.stamp_ms, sent.roll.stamp_ms);
    EXPECT_EQ(m->roll.next, FP_NONE);
    ASSERT_EQ(m->roll.count, 2U);
    EXPECT_EQ(m->roll.list[0], sent.roll.list[0]);
    EXPECT_EQ(m->roll.list[1], sent.roll.list[1]);
  }
}

TEST(ProtocolMessages, TheLongestRollFitsIntoAMessage) {
  Message m = sample_with_zones(MessageKind::Roll);
  while (m.status.held.count < kPathLanesMax) m.status.held.append(9);
  for (std::uint16_t zone = 0; zone < 1000; ++zone) m.zones.add(zone), m.about.add(zone);
  m.heard.count = 1;
  m.roll.count = Roll::kMax;
  for (RollEntry& entry : m.roll.list) entry = {1, 2, 3};
  EXPECT_LE(WireMessage(m).bytes().size(), 1000U);
  ASSERT_TRUE(decode(WireMessage(m).bytes()));
}

TEST(ProtocolMessages, ComeBackAsTheyWere) {
  for (const MessageKind kind : kKinds) {
    const Message sent = sample(kind);
    const std::optional<Message> m = decode(WireMessage(sent).bytes());
    ASSERT_TRUE(m);
    EXPECT_EQ(m->kind, kind);
    EXPECT_EQ(m->status.stamp_ms, sent.status.stamp_ms);
    EXPECT_NEAR(m->status.position_m.x, -12.345, 5e-4);
    EXPECT_NEAR(m->status.position_m.y, 67.891, 5e-4);
    EXPECT_EQ(m->status.epoch, 77U);
    EXPECT_TRUE(m->status.requesting && m->status.idle);
    EXPECT_FALSE(m->status.waiting || m->status.out_of_order || m->status.blocked || m->status.held_up);
    EXPECT_TRUE(m->status.held == sent.status.held);
    EXPECT_NEAR(m->status.held.heading.x, 0.6, 1e-4);
    EXPECT_NEAR(m->status.held.heading.y, -0.8, 1e-4);
    if (kind == MessageKind::State || kind == MessageKind::Request) {
      EXPECT_EQ(m->demand_ns, sent.demand_ns);
      EXPECT_TRUE(m->request == sent.request);
      ASSERT_EQ(m->asked.count, 2U);
      ASSERT_NE(m->asked.of(65'000), nullptr);
      EXPECT_EQ(m->asked.of(65'000)->attempt, 255U);
      EXPECT_TRUE(m->asked.has_deferred(*m->asked.of(65'000)));
      EXPECT_FALSE(m->asked.has_deferred(*m->asked.of(7)));
      EXPECT_EQ(m->asked.of(9), nullptr);
    }
    if (kind == MessageKind::State) {
      ASSERT_EQ(m->answers.count, 2U);
      EXPECT_EQ(m->answers.list[0].agv, 9U);
      EXPECT_EQ(m->answers.list[0].echo, sent.answers.list[0].echo);
      EXPECT_TRUE(m->answers.list[0].granted);
      EXPECT_FALSE(m->answers.list[1].granted);
      EXPECT_EQ(m->heard.first, 2U);
      ASSERT_EQ(m->heard.count, 3U);
      EXPECT_EQ(m->heard.stamps_ms[2], 4'000'000'000U);
    } else if (kind != MessageKind::Request) {
      EXPECT_EQ(m->echo, 41U);
    }
  }
}

TEST(ProtocolMessages, AWayThatIsKnownIsNotReadAgain) {
  for (const MessageKind kind : {MessageKind::State, MessageKind::Grant, MessageKind::Roll}) {
    Message sent = sample_with_zones(kind);
    sent.status.ahead.append(9);
    const WireMessage wire(sent);
    const std::optional<Message> first = decode(wire.bytes());
    ASSERT_TRUE(first && !first->repeats_way);
    WayBytes known;
    known.keep(first->way_bytes, first->tells_zones);
    sent.status.stamp_ms += 5;
    const std::optional<Message> again = decode(WireMessage(sent).bytes(), known);
    ASSERT_TRUE(again && again->repeats_way);
    EXPECT_EQ(again->status.stamp_ms, sent.status.stamp_ms);
    EXPECT_EQ(again->heard.stamps_ms[2], 4'000'000'000U);
    for (int change = 0; change < 5; ++change) {
      Message other = sent;
      if (change == 0) other.status.held.lane_ids[2] = 3;
      if (change == 1) other.status.held.heading = {-0.6, 0.8};
      if (change == 2) other.status.ahead.append(10);
      if (change == 3) other.zones.add(8);
      if (change == 4) other.tells_zones = false;
      const std::optional<Message> m = decode(WireMessage(other).bytes(), known);
      ASSERT_TRUE(m && !m->repeats_way) << change;
      EXPECT_TRUE(m->status.held == other.status.held && m->status.ahead.count == other.status.ahead.count) << change;
    }
    for (std::size_t size = 0; size < wire.bytes().size(); ++size)
      EXPECT_FALSE(decode(wire.bytes().first(size), known)) << size;
  }
}

TEST(ProtocolMessages, EpochsOfLaterBootsComeBackAsTheyWere) {
  for (const MessageKind kind : {MessageKind::Grant, MessageKind::Defer}) {
    for (const Epoch mine : {Epoch{7}, first_epoch(1), first_epoch(0xffffffff) + 9}) {
      for (const Epoch theirs : {Epoch{7}, first_epoch(2) + 0xffffffff}) {
        Message sent = sample(kind);
        sent.status.epoch = mine;
        sent.echo = theirs;
        const std::optional<Message> m = decode(WireMessage(sent).bytes());
        ASSERT_TRUE(m);
        EXPECT_EQ(m->status.epoch, mine);
        EXPECT_EQ(m->echo, theirs);
      }
    }
  }
  EXPECT_LT(first_epoch(1) + 0xffffffff, first_epoch(2));
}

TEST(ProtocolMessages, LargestFitsTheRadio) {
  Message m = sample(MessageKind::Request);
  m.status.epoch = first_epoch(1) + 1;
  while (m.status.held.append(1)) {
  }
  while (m.request.append(1)) {
  }
  EXPECT_LE(WireMessage(m).bytes().size(), 1024U);
  while (m.asked.add({1, 1})) {
  }
  while (m.answers.add({1, first_epoch(1) + 1, true})) {
  }
  m.kind = MessageKind::State;
  m.heard.count = HeardFrom::kMax;
  EXPECT_LE(WireMessage(m).bytes().size(), 1024U);
}

TEST(ProtocolMessages, LargestOfADividedFleetFitsTheRadioWithoutAnswers) {
  Message m = sample_with_zones(MessageKind::State);
  m.status.epoch = first_epoch(1) + 1;
  m.answers = {};
  for (std::uint16_t zone = 0; zone < 1000; ++zone) m.zones.add(zone);
  while (m.status.held.append(1)) {
  }
  while (m.request.append(1)) {
  }
  while (m.asked.add({1, 1})) {
  }
  m.heard.count = HeardFrom::kMax;
  EXPECT_LE(WireMessage(m).bytes().size(), 1024U);
}

TEST(ProtocolMessages, AnyOtherLengthIsRefused) {
  for (const MessageKind kind : kKinds) {
    const WireMessage wire(sample(kind));
    std::vector<std::byte> bytes(wire.bytes().begin(), wire.bytes().end());
    for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(decode(std::span(bytes).first(size))) << size;
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(decode(bytes));
  }
}

TEST(ProtocolMessages, GarbageIsRefusedOrWithinBounds) {
  std::mt19937_64 draws(3);
  int accepted = 0;
  for (int i = 0; i < 200'000; ++i) {
    Message sent = sample(kKinds[i % 4]);
    if (i % 3 == 0) sent.status.epoch = first_epoch(3) + 1, sent.echo = first_epoch(5);
    const WireMessage wire(sent);
    std::vector<std::byte> bytes(wire.bytes().begin(), wire.bytes().end());
    for (int flips = 0; flips <= i % 7; ++flips) bytes[draws() % bytes.size()] = static_cast<std::byte>(draws());
    if (i % 5 == 0) bytes.resize(draws() % 300);
    const std::optional<Message> m = decode(bytes);
    if (!m) continue;
    ++accepted;
    ASSERT_LE(m->status.held.count, kPathLanesMax);
    ASSERT_LE(m->request.count, kPathLanesMax);
    ASSERT_LE(m->heard.count, HeardFrom::kMax);
    ASSERT_LE(m->asked.count, Asked::kMax);
    ASSERT_LE(m->asked.unanswered, m->asked.count);
    ASSERT_LE(m->answers.count, Answers::kMax);
    ASSERT_NEAR(length(m->status.held.heading), 1.0, 1e-9);
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace fleetproof::agents::protocol_messages_test
