// Agents that speak over streams, in simulated runs.
#include <gmock/gmock.h>

#include <string>

#include "core/agents/agent_type.hpp"
#include "core/bridges/stream/stream_ends.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::streams_in_a_run_test {
namespace {

using stream::StreamEvent;

constexpr std::uint32_t kTick = 1, kStream = 2;
constexpr std::uint16_t kPort = 1883;
constexpr std::size_t kDocument = 10'000;  // bytes

// AGV 1 sends a document to AGV 0 every 5 s. Each connects anew when the stream is broken, and logs what it learns.
class Talker {
 public:
  Talker(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : host_(host),
        handle_(handle),
        controller_(host, handle, briefing.boot),
        streams_(controller_, briefing.self, briefing.boot),
        is_sender_(briefing.self == 1) {
    if (!is_sender_) streams_.listen(kPort);
  }

  void on_event(const fp_event& event) {
    controller_.set_clock(event.now_ns);
    controller_.drain_inbox(
        [&](std::uint32_t sender, std::span<const std::byte> bytes) { streams_.hear(sender, bytes); });
    if (is_sender_ && (event.kind == FP_EVENT_START || (event.kind == FP_EVENT_TIMER && event.timer == kTick))) tick();
    for (auto news = streams_.take_news(); !news.empty(); news = streams_.take_news()) {
      for (const stream::StreamNews& one : news) learn(one);
      streams_.flush();
    }
    streams_.flush();
    if (const auto deadline = streams_.deadline_ns()) controller_.set_timer(kStream, *deadline);
  }

 private:
  void tick() {
    controller_.set_timer(kTick, controller_.now_ns() + 5 * stream::kSecond_ns);
    if (stream_ == 0) stream_ = streams_.connect(0, kPort);
    const std::vector<std::byte> document(kDocument, static_cast<std::byte>('a' + documents_++ % 26));
    log(streams_.send(stream_, document, "DOCUMENT: " + std::to_string(documents_)) ? "sent" : "not sent");
  }
  void learn(const stream::StreamNews& news) {
    switch (news.event.kind) {
      case StreamEvent::Kind::Opened:
        return log("opened");
      case StreamEvent::Kind::Received:
        for (const std::byte one : news.event.bytes) {
          if (one != std::exchange(letter_, one)) log(std::string("begins ") + static_cast<char>(one));
        }
        return;
      case StreamEvent::Kind::Broken:
        stream_ = 0;
        return log(news.event.reason);
      case StreamEvent::Kind::Closed:
        return log("closed");
    }
  }
  void log(const std::string& text) { host_.log(handle_, text.c_str()); }

  const fp_host& host_;
  fp_controller* handle_;
  agents::Controller controller_;
  stream::Streams streams_;
  const bool is_sender_;
  stream::StreamNumber stream_ = 0;
  int documents_ = 0;
  std::byte letter_{};
};

const fp_agent_type kTalker = agents::agent_type<Talker>(
    "talker", "", [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
      return new Talker(*host, controller, *briefing);
    });

Scenario world(double loss, double delay_s, double horizon_s = 300.0) {
  Scenario scenario = test::row_of_tens({0, 3}, horizon_s);
  scenario.radio.loss = loss;
  scenario.radio.delay_s = delay_s;
  return scenario;
}

std::vector<std::string> logged(const test::ToldRun& run, std::uint32_t agv) {
  std::vector<std::string> lines;
  for (const auto& line : run.trace) {
    if (std::get<2>(line) == TraceKind::Log && std::get<1>(line) == EntityId{agv}) lines.push_back(std::get<7>(line));
  }
  return lines;
}

TEST(StreamsInARun, CarryDocumentsOfTenThousandBytesWholeAndInOrder) {
  const auto run = test::watched(world(0.1, 0.2), kTalker, {});
  EXPECT_EQ(run.outcome.message, "");
  std::string letters;
  for (const std::string& line : logged(run, 0)) {
    if (line.starts_with("begins ")) letters += line.back();
  }
  EXPECT_GT(letters.size(), 50U);
  std::string expected;
  for (std::size_t i = 0; i < letters.size(); ++i) expected += static_cast<char>('a' + i % 26);
  EXPECT_EQ(letters, expected);
}

TEST(StreamsInARun, RepeatToTheBit) {
  const Scenario scenario = world(0.4, 2.0);
  test::expect_same(test::watched(scenario, kTalker, {}), test::watched(scenario, kTalker, {}));
}

// The other end does not know the stream any more, says so at the next segment, and is connected to anew.
TEST(StreamsInARun, ARestartBreaksThem) {
  Scenario scenario = world(0.0, 0.1, 60.0);
  scenario.faults = {test::fault(Fault::Kind::Restart, 12.0, 1.0)};
  const auto run = test::watched(scenario, kTalker, {});
  EXPECT_THAT(logged(run, 1), testing::IsSupersetOf({"opened", "reset by the other end", "opened"}));
  EXPECT_THAT(logged(run, 0), testing::Contains("opened").Times(2));
}

TEST(StreamsInARun, EachSegmentSaysWhatItCarries) {
  const auto run = test::watched(world(0.3, 0.1, 30.0), kTalker, {});
  std::vector<std::string> described;
  for (const auto& line : run.trace) {
    if (std::get<2>(line) == TraceKind::Described) described.push_back(std::get<7>(line));
  }
  const auto begins = [](const std::string& text) { return testing::Contains(testing::StartsWith(text)); };
  EXPECT_THAT(described, begins("OPEN: connection 1.0.1"));
  EXPECT_THAT(described, begins("OPENED: connection 1.0.1"));
  EXPECT_THAT(described, begins("DOCUMENT: 1, 11 of 11"));
  EXPECT_THAT(described, begins("ACK: up to "));
  EXPECT_THAT(described, testing::Contains(testing::HasSubstr(", sent again")));
}

}  // namespace
}  // namespace fleetproof::streams_in_a_run_test
