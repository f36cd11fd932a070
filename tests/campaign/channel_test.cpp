#include "campaign/workers/channel.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <thread>

#include "campaign/workers/run_order.hpp"
#include "core/base/error.hpp"

namespace fleetproof::channel_test {
namespace {

using Wait = Channel::Wait;
constexpr std::chrono::milliseconds kNow{0}, kSoon{2000};

TEST(Channel, CarriesFramesOfAnySizeInOrder) {
  auto [here, there] = Channel::make_pair();
  const std::string large(3'000'000, 'x');
  std::thread sender([&there = there, &large] {
    EXPECT_TRUE(there.send(""));
    EXPECT_TRUE(there.send(large));
    EXPECT_TRUE(there.send(std::string_view("a\0b", 3)));
  });
  for (const std::string& expected : {std::string(), large, std::string("a\0b", 3)}) {
    ASSERT_EQ(here.wait(kSoon), Wait::Arrived);
    EXPECT_EQ(here.received(), expected);
  }
  sender.join();
  EXPECT_EQ(here.wait(kNow), Wait::NotYet);
}

// A worker may be stopped, or never read. The sender does not block, so that it can watch the worker.
TEST(Channel, PostsToAnEndThatDoesNotRead) {
  auto [here, there] = Channel::make_pair();
  const std::string large(3'000'000, 'x');
  here.post(large);
  here.post("after it");
  EXPECT_EQ(here.wait(std::chrono::milliseconds(20)), Wait::NotYet);
  std::thread reader([&there = there, &large] {
    for (const std::string& expected : {large, std::string("after it")}) {
      ASSERT_EQ(there.wait(kSoon), Wait::Arrived);
      EXPECT_EQ(there.received(), expected);
    }
    EXPECT_TRUE(there.send("read"));
  });
  EXPECT_EQ(here.wait(kSoon), Wait::Arrived);
  EXPECT_EQ(here.received(), "read");
  reader.join();
}

TEST(Channel, WhatAnEndSaidBeforeItWentIsReadAlthoughItTookNothing) {
  auto [here, there] = Channel::make_pair();
  here.post(std::string(3'000'000, 'x'));
  ASSERT_TRUE(there.send("I cannot"));
  there.close();
  EXPECT_EQ(here.wait(kSoon), Wait::Arrived);
  EXPECT_EQ(here.received(), "I cannot");
  EXPECT_EQ(here.wait(kSoon), Wait::Gone);
}

TEST(Channel, TellsThatTheOtherEndIsGone) {
  auto [here, there] = Channel::make_pair();
  ASSERT_TRUE(there.send("last words"));
  there.close();
  EXPECT_EQ(here.wait(kSoon), Wait::Arrived);
  EXPECT_EQ(here.received(), "last words");
  EXPECT_EQ(here.wait(kSoon), Wait::Gone);
  EXPECT_FALSE(here.send("anybody?"));
}

// An agent may write to any descriptor of its process.
TEST(Channel, RefusesWhatIsNoFrame) {
  for (const std::string& noise : {std::string(16, '\xff'), std::string("\5\0\0\0\0\0\0\0wronghashhello", 22)}) {
    auto [here, there] = Channel::make_pair();
    ASSERT_EQ(::send(there.fd(), noise.data(), noise.size(), 0), static_cast<ssize_t>(noise.size()));
    EXPECT_EQ(here.wait(kSoon), Wait::Gone);
  }
}

TEST(RunOrder, IsWhatWasEncoded) {
  const RunOrder order{4711, {{17, false, "stack overflow"}, {18, true, ""}}, true, {5, "a plant", "{}"}, true, true,
                       {77}};
  const RunOrder decoded = decode_order(encode(order));
  EXPECT_EQ(decoded.choice, order.choice);
  EXPECT_TRUE(decoded.is_audit);
  EXPECT_EQ(decoded.run_index, order.run_index);
  EXPECT_EQ(decoded.known_ends, order.known_ends);
  EXPECT_TRUE(decoded.record && decoded.deliveries);
  EXPECT_EQ(decoded.scenario.layout_digest, 5U);
  EXPECT_EQ(decoded.scenario.layout, "a plant");
  EXPECT_EQ(decoded.scenario.scenario, "{}");
}

TEST(RunAnswer, IsWhatWasEncodedAndNothingShorter) {
  RunAnswer answer;
  answer.message = "why";
  answer.failed = answer.machine = true;
  answer.cpu_ns = 5;
  answer.scenario_digest = 6;
  answer.run.outcome.digest = 7;
  answer.run.outcome.running_digests = {1, 2};
  answer.run.states = {"driving"};
  answer.run.words = {"driving", "late"};
  answer.run.all_words = {"late"};
  answer.run.first_said = {{AgvId{3U}, "late", at_ns(9)}};
  MessageDelivery& message = answer.run.deliveries.emplace_back();
  message.delivery = {AgvId{1U}, AgvId{2U}, Duration{3}, 4, true, Duration{5}, true, Duration{6}};
  message.kind = "GRANT";
  message.number = 7;
  message.content = "answers 1";
  message.on_its_way = Duration{8};
  const Departure departure{AgvId{1U}, at_ns(8), at_ns(9), StationId{2U}, StationId{3U}, {0.6, 0.8}, {-1.0, 0.0}};
  answer.run.itinerary.departures = {departure};
  answer.run.itinerary.done = {{AgvId{2U}, TransportId{4U}, at_ns(10)}};
  const std::string bytes = encode(answer);
  const RunAnswer decoded = decode_answer(bytes);
  EXPECT_TRUE(decoded.failed && decoded.machine);
  EXPECT_EQ(decoded.message, "why");
  EXPECT_EQ(decoded.cpu_ns, 5U);
  EXPECT_EQ(decoded.scenario_digest, 6U);
  EXPECT_EQ(decoded.run.outcome, answer.run.outcome);
  EXPECT_EQ(decoded.run.states, answer.run.states);
  EXPECT_EQ(decoded.run.words, answer.run.words);
  EXPECT_EQ(decoded.run.all_words, answer.run.all_words);
  ASSERT_EQ(decoded.run.first_said.size(), 1U);
  EXPECT_EQ(std::tuple(decoded.run.first_said[0].agv, decoded.run.first_said[0].word, decoded.run.first_said[0].at),
            std::tuple(EntityId{AgvId{3U}}, "late", at_ns(9)));
  ASSERT_EQ(decoded.run.deliveries.size(), 1U);
  EXPECT_EQ(decoded.run.deliveries[0].delivery, message.delivery);
  EXPECT_EQ(std::tuple(decoded.run.deliveries[0].kind, decoded.run.deliveries[0].number),
            std::tuple(message.kind, message.number));
  EXPECT_EQ(decoded.run.deliveries[0].content, message.content);
  EXPECT_EQ(decoded.run.deliveries[0].arrives(), kStart + message.delivery.sent + Duration{8});
  ASSERT_EQ(decoded.run.itinerary.departures.size(), 1U);
  const Departure& there = decoded.run.itinerary.departures[0];
  EXPECT_EQ(std::tuple(there.agv, there.at, there.arrives, there.from, there.to),
            std::tuple(departure.agv, departure.at, departure.arrives, departure.from, departure.to));
  EXPECT_EQ(there.heading, departure.heading);
  EXPECT_EQ(there.heading_there, departure.heading_there);
  ASSERT_EQ(decoded.run.itinerary.done.size(), 1U);
  const auto& [agv, transport, at] = decoded.run.itinerary.done[0];
  EXPECT_EQ(std::tuple(agv, transport, at), std::tuple(AgvId{2U}, TransportId{4U}, at_ns(10)));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(decode_answer(std::string_view(bytes).substr(0, length)), EngineError) << length;
  EXPECT_THROW(decode_answer(bytes + "x"), EngineError);
}

}  // namespace
}  // namespace fleetproof::channel_test
