#include "core/engine/messenger.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::messenger_test {
namespace {

using test::kFirst;
using test::kSecond;
using test::SmallWorld;
using test::started;

Scenario two_with_delay(double delay_s) {
  Scenario scenario = test::row_of_tens({0, 2});
  scenario.radio.delay_s = delay_s;
  return scenario;
}

void send(SmallWorld& world, std::string_view bytes, std::uint32_t receiver = FP_NONE) {
  const auto slot = world.parts.messenger.accept(kFirst, bytes, receiver);
  ASSERT_TRUE(slot);
  world.parts.messenger.transmit(kFirst, *slot, receiver);
}

void let_arrive(SmallWorld& world) {
  const Event event = world.next(Event::Kind::MessageArrives);
  world.parts.messenger.arrives(event.entity, event.payload);
}

std::string read(SmallWorld& world, AgvId agv) {
  fp_message message{};
  if (!world.parts.messenger.read(agv, message)) return "";
  return {static_cast<const char*>(message.bytes), message.size};
}

TEST(MessengerPart, TakesOnlyWhatCanBeSent) {
  SmallWorld world(two_with_delay(1.0));
  const std::string longest(FP_MESSAGE_BYTES_MAX, 'x');
  EXPECT_TRUE(world.parts.messenger.accept(kFirst, longest, FP_NONE));
  EXPECT_FALSE(world.parts.messenger.accept(kFirst, longest + "x", FP_NONE));
  EXPECT_FALSE(world.parts.messenger.accept(kFirst, "to itself", kFirst.value));
  EXPECT_FALSE(world.parts.messenger.accept(kFirst, "to nobody", 2));
}

TEST(MessengerPart, AMessageArrivesAfterItsDelayAndWakesTheAgent) {
  SmallWorld world(two_with_delay(1.5));
  started(world).heard.clear();
  send(world, "hello");
  EXPECT_EQ(read(world, kSecond), "") << "still under way";
  let_arrive(world);
  EXPECT_DOUBLE_EQ(to_seconds(world.run.now), 1.5);
  ASSERT_EQ(world.heard.size(), 1U);
  EXPECT_EQ(world.heard[0].kind, FP_EVENT_MESSAGE);
  EXPECT_EQ(read(world, kSecond), "hello");
  EXPECT_EQ(read(world, kSecond), "");
  EXPECT_EQ(world.run.counters.received, 1U);
}

TEST(MessengerPart, TheInboxKeepsTheOrderAndIsLostWithTheComputer) {
  SmallWorld world(two_with_delay(1.0));
  started(world);
  for (const char* text : {"one", "two", "three"}) {
    send(world, text);
    let_arrive(world);
  }
  EXPECT_EQ(read(world, kSecond), "one");
  EXPECT_EQ(read(world, kSecond), "two");
  world.parts.messenger.forget_inbox(kSecond);
  EXPECT_EQ(read(world, kSecond), "");
}

TEST(MessengerPart, ASecondCopyIsTracedAsOne) {
  Scenario scenario = two_with_delay(1.0);
  scenario.radio.duplicates = 1.0;
  SmallWorld world(scenario);
  started(world);
  send(world, "hello");
  let_arrive(world);
  let_arrive(world);
  ASSERT_EQ(world.trace.of(TraceKind::Received).size(), 2U);
  const TracePart part = world.run.writer.digest().take_newest();
  int receptions = 0, copies = 0;
  for (std::uint32_t place = part.begin; place < part.end; ++place) {
    receptions += part.block->kind(place) == TraceKind::Received ? 1 : 0;
    copies += part.block->is_copy(place) ? 1 : 0;
  }
  EXPECT_EQ(receptions, 2);
  EXPECT_EQ(copies, 1);
}

// agent.h promises it: an agent may send on the bytes that it has just read.
TEST(MessengerPart, TheBytesInHandStayWhileTheAgentSends) {
  SmallWorld world(two_with_delay(1.0));
  started(world);
  send(world, "short");
  let_arrive(world);
  fp_message message{};
  ASSERT_TRUE(world.parts.messenger.read(kSecond, message));
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(world.parts.messenger.accept(kSecond, "another one", FP_NONE));
  EXPECT_EQ(std::string_view(static_cast<const char*>(message.bytes), message.size), "short");
}

TEST(MessengerPart, WhatReachesAComputerThatIsDownIsGone) {
  SmallWorld world(two_with_delay(1.0));
  started(world);
  send(world, "hello");
  world.parts.agents.goes_away(kSecond);
  let_arrive(world);
  world.parts.agents.comes_back(kSecond);
  EXPECT_EQ(read(world, kSecond), "");
}

TEST(MessengerPart, LossesAreTracedWithTheirCauseAndEveryCopyIsAccountedFor) {
  Scenario scenario = two_with_delay(0.1);
  scenario.radio.loss = 1.0;
  SmallWorld world(scenario);
  started(world);
  send(world, "hello", kSecond.value);
  EXPECT_EQ(world.trace.of(TraceKind::Lost).size(), 1U);
  EXPECT_FALSE(world.has(Event::Kind::MessageArrives));
  EXPECT_EQ(world.run.counters.receptions_lost, 1U);
  EXPECT_EQ(*world.parts.messenger.accept(kFirst, "next", FP_NONE), 0U) << "the slot is free again";
}

}  // namespace
}  // namespace fleetproof::messenger_test
