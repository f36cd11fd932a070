// Streams over a channel that loses, delays, reorders and doubles. The channel draws by itself.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "core/bridges/stream/connection.hpp"
#include "core/bridges/stream/segment.hpp"

namespace fleetproof::stream_test {
namespace {

using stream::Connection;
using stream::ConnectionId;
using stream::decode;
using stream::kHeadBytes;
using stream::kMillisecond_ns;
using stream::kMostBytes;
using stream::kSecond_ns;
using stream::RetransmissionTimeout;
using stream::Segment;
using stream::Settings;
using stream::StreamEvent;

using testing::ElementsAre;
using Kind = StreamEvent::Kind;

constexpr ConnectionId kId{3, 1, 7, 1883};

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}
Segment of(Segment::Kind kind, std::uint32_t number, std::uint32_t expected, std::string_view text = {}) {
  Segment segment;
  segment.id = kId;
  segment.kind = kind;
  segment.number = number;
  segment.expected = expected;
  segment.bytes = bytes_of(text);
  return segment;
}
std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Uniform on [0, 1), by splitmix64.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed) {}
  double next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

struct Channel {
  double loss = 0.0, doubles = 0.0;
  std::int64_t least_ns = 100 * kMillisecond_ns, most_ns = 100 * kMillisecond_ns;
};

// Two ends and the channel between them. End 0 opens.
class Pair {
 public:
  Pair(const Settings& settings, const Channel& as_channel, std::uint64_t seed)
      : channel(as_channel),
        settings_(settings),
        draws_(seed),
        ends{Connection(kId, settings_), Connection(kId, settings_)} {}

  // What an end has learned.
  struct Learned {
    std::vector<Kind> events;
    std::string bytes, reason;
    std::int64_t first_bytes_ns = -1, end_ns = -1;
  };

  bool is_loud = true;  // false: nothing arrives
  std::array<Learned, 2> learned;

  void run_until(std::int64_t end_ns) {
    for (std::int64_t next = now_ns; next < end_ns; next = next_ns(end_ns)) {
      now_ns = next;
      while (!under_way_.empty() && under_way_.begin()->first <= now_ns) {
        const auto [to, datagram] = under_way_.extract(under_way_.begin()).mapped();
        if (!is_loud) continue;
        ends[to].hear(decode(datagram).value(), now_ns);
        has_heard_[to] = true;
      }
      for (const std::size_t which : {0U, 1U}) flush(which);
    }
    now_ns = end_ns;
  }
  void say(std::size_t which, std::string_view text) { EXPECT_TRUE(ends[which].send(bytes_of(text), "text")); }

  Channel channel;

 private:
  std::int64_t next_ns(std::int64_t end_ns) const {
    std::int64_t next = under_way_.empty() ? end_ns : under_way_.begin()->first;
    for (const Connection& end : ends) next = std::min(next, end.deadline_ns().value_or(end_ns));
    return std::max(next, now_ns + 1);
  }
  void flush(std::size_t which) {
    learn(which);
    if (!has_heard_[which]) return;
    ends[which].flush(now_ns, [&](const Segment& segment, std::string_view, std::uint32_t) {
      for (int copies = draws_.next() < channel.doubles ? 2 : 1; copies > 0; --copies) {
        const bool is_lost = draws_.next() < channel.loss;
        const double span_ns = draws_.next() * static_cast<double>(channel.most_ns - channel.least_ns);
        if (!is_lost)
          under_way_.emplace(now_ns + channel.least_ns + static_cast<std::int64_t>(span_ns),
                             std::pair(1 - which, encode(segment)));
      }
      sent.push_back({now_ns, which, segment.kind});
    });
    learn(which);
  }
  void learn(std::size_t which) {
    Learned& to = learned[which];
    for (const StreamEvent& event : ends[which].take_events()) {
      to.events.push_back(event.kind);
      to.bytes += text_of(event.bytes);
      if (event.kind == Kind::Received && to.first_bytes_ns < 0) to.first_bytes_ns = now_ns;
      if (event.kind == Kind::Broken || event.kind == Kind::Closed) to.end_ns = now_ns;
      to.reason += event.reason;
    }
  }

  const Settings settings_;
  Draws draws_;
  std::multimap<std::int64_t, std::pair<std::size_t, std::vector<std::byte>>> under_way_;
  std::array<bool, 2> has_heard_{true, false};

 public:
  struct Sent {
    std::int64_t at_ns;
    std::size_t by;
    Segment::Kind kind;
  };
  std::vector<Sent> sent;
  std::array<Connection, 2> ends;
  std::int64_t now_ns = 0;
};

constexpr Channel kPerfect{.loss = 0.0, .doubles = 0.0, .least_ns = kSecond_ns / 10, .most_ns = kSecond_ns / 10};

TEST(Segments, AreReadAsTheyWereWritten) {
  for (const Segment& segment :
       {of(Segment::Kind::Open, 0, 0), of(Segment::Kind::Open, 0, 1),
        of(Segment::Kind::Data, 9, 4, std::string(kMostBytes, 'x')), of(Segment::Kind::Close, 10, 4),
        of(Segment::Kind::Ack, 0, 4), of(Segment::Kind::Reset, 0, 0)}) {
    const auto datagram = encode(segment);
    EXPECT_LE(datagram.size(), 1000U);
    const auto read = decode(datagram);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->id, segment.id);
    EXPECT_EQ(std::pair(read->is_repeat, read->measures), std::pair(segment.is_repeat, segment.measures));
    EXPECT_EQ(std::tuple(read->kind, read->number, read->expected, read->bytes),
              std::tuple(segment.kind, segment.number, segment.expected, segment.bytes));
  }
}

TEST(Segments, WhatNoEndSendsIsNone) {
  const auto is_read = [](const Segment& segment) { return decode(encode(segment)).has_value(); };
  EXPECT_FALSE(is_read(of(Segment::Kind::Ack, 0, 0))) << "of nothing";
  EXPECT_FALSE(is_read(of(Segment::Kind::Ack, 3, 1)));
  EXPECT_FALSE(is_read(of(Segment::Kind::Data, 0, 1, "x"))) << "the number of the opening";
  EXPECT_FALSE(is_read(of(Segment::Kind::Data, 2, 0, "x")));
  EXPECT_FALSE(is_read(of(Segment::Kind::Open, 2, 0)));
  EXPECT_FALSE(is_read(of(Segment::Kind::Close, 2, 1, "x")));
  EXPECT_FALSE(is_read(of(Segment::Kind::Data, 2, 1, std::string(kMostBytes + 1, 'x'))));
  auto datagram = encode(of(Segment::Kind::Data, 2, 1, "x"));
  datagram[0] = std::byte{0};
  EXPECT_FALSE(decode(datagram).has_value());
  for (std::size_t size = 0; size < kHeadBytes; ++size) EXPECT_FALSE(decode(std::span(datagram).first(size)));
}

// The numbers of RFC 6298, section 2, by hand: SRTT and RTTVAR after samples of 1 s, 2 s and 2 s.
TEST(RetransmissionTimeout, IsThatOfTheStandard) {
  RetransmissionTimeout timeout{{}};
  EXPECT_EQ(timeout.ns(), kSecond_ns);
  timeout.expired();
  timeout.answered();
  EXPECT_EQ(timeout.ns(), 2 * kSecond_ns) << "nothing was measured";
  timeout.measured(kSecond_ns);
  EXPECT_EQ(timeout.ns(), 3 * kSecond_ns);
  timeout.measured(2 * kSecond_ns);  // RTTVAR 0.625 s, SRTT 1.125 s
  EXPECT_EQ(timeout.ns(), 3'625'000'000);
  timeout.measured(2 * kSecond_ns);  // RTTVAR 0.6875 s, SRTT 1.234375 s
  EXPECT_EQ(timeout.ns(), 3'984'375'000);
  timeout.expired();
  EXPECT_EQ(timeout.ns(), 2 * 3'984'375'000);
  timeout.answered();
  EXPECT_EQ(timeout.ns(), 3'984'375'000);
  for (int i = 0; i < 10; ++i) timeout.expired();
  EXPECT_EQ(timeout.ns(), 60 * kSecond_ns);
  for (int i = 0; i < 200; ++i) timeout.measured(kMillisecond_ns);
  EXPECT_EQ(timeout.ns(), kSecond_ns / 5) << "at least";
}

TEST(Streams, OpenCarryBytesBothWaysAndClose) {
  Pair pair({}, kPerfect, 1);
  pair.say(0, "hello");
  pair.say(1, "welcome");
  pair.run_until(kSecond_ns);
  EXPECT_EQ(pair.learned[1].bytes, "hello");
  EXPECT_EQ(pair.learned[0].bytes, "welcome");
  EXPECT_EQ(pair.learned[1].first_bytes_ns, 3 * kPerfect.least_ns) << "the handshake, and then the bytes";
  pair.ends[0].close();
  pair.run_until(2 * kSecond_ns);
  EXPECT_THAT(pair.learned[0].events, ElementsAre(Kind::Opened, Kind::Received, Kind::Closed));
  EXPECT_THAT(pair.learned[1].events, ElementsAre(Kind::Opened, Kind::Received, Kind::Closed));
  EXPECT_FALSE(pair.ends[0].send(bytes_of("x"), ""));
}

TEST(Streams, WhatIsLostHoldsBackAllBehindIt) {
  Pair pair({}, kPerfect, 1);
  pair.run_until(kSecond_ns);
  pair.channel.loss = 1.0;
  pair.say(0, "first ");
  pair.run_until(kSecond_ns + 1);
  pair.channel.loss = 0.0;
  pair.say(0, "second");
  pair.run_until(kSecond_ns + kSecond_ns / 10 + 3);
  EXPECT_EQ(pair.learned[1].bytes, "");
  pair.run_until(5 * kSecond_ns);
  EXPECT_EQ(pair.learned[1].bytes, "first second");
}

// When an end sent segments of a kind: seconds, rounded down.
std::vector<std::int64_t> sent_s(const Pair& pair, Segment::Kind kind) {
  std::vector<std::int64_t> times;
  for (const auto& sent : pair.sent) {
    if (sent.by == 0 && sent.kind == kind) times.push_back(sent.at_ns / kSecond_ns);
  }
  return times;
}

// Which sending was answered, the other end says: the first one took 4 s here, although it was repeated meanwhile.
TEST(Streams, MeasureTheRoundTripOfFirstSendings) {
  Pair pair({}, {0.0, 0.0, 2 * kSecond_ns, 2 * kSecond_ns}, 1);
  pair.run_until(60 * kSecond_ns);
  EXPECT_THAT(sent_s(pair, Segment::Kind::Open), ElementsAre(0, 1, 3)) << "1 s, then twice as long";
  pair.is_loud = false;
  pair.say(0, "x");
  pair.run_until(75 * kSecond_ns);
  EXPECT_THAT(sent_s(pair, Segment::Kind::Data), ElementsAre(60, 72)) << "4 s and four times their half";
}

// Of a repeat, nobody knows when it was sent (Karn's algorithm): the timeout stays doubled.
TEST(Streams, DoNotMeasureRepeats) {
  Pair pair({}, kPerfect, 1);
  pair.channel.loss = 1.0;
  pair.run_until(kSecond_ns / 2);
  pair.channel.loss = 0.0;
  pair.run_until(20 * kSecond_ns);
  EXPECT_THAT(sent_s(pair, Segment::Kind::Open), ElementsAre(0, 1));
  pair.is_loud = false;
  pair.say(0, "x");
  pair.run_until(27 * kSecond_ns);
  EXPECT_THAT(sent_s(pair, Segment::Kind::Data), ElementsAre(20, 22, 26));
}

// All that was lost together comes again one after the other, as soon as what was before it has arrived.
TEST(Streams, AfterATimeoutTheNextGapIsFilledAtOnce) {
  Pair pair({}, kPerfect, 1);
  pair.run_until(10 * kSecond_ns);
  pair.channel.loss = 1.0;
  pair.say(0, std::string(5 * kMostBytes, 'x'));
  pair.run_until(10 * kSecond_ns + 1);
  pair.channel.loss = 0.0;
  pair.run_until(12 * kSecond_ns);
  EXPECT_EQ(pair.learned[1].bytes.size(), 5 * kMostBytes) << "one timeout of 0.6 s, and then five round trips";
}

// Whatever the channel does: what has arrived is a beginning of what was sent, and all of it, if the stream lives.
TEST(Streams, LoseAndReorderNothing) {
  int broken = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Draws draws(seed);
    const Channel channel{.loss = 0.5 * draws.next(),
                          .doubles = 0.3 * draws.next(),
                          .least_ns = 10 * kMillisecond_ns,
                          .most_ns = static_cast<std::int64_t>(draws.next() * 3e9) + 10 * kMillisecond_ns};
    Pair pair({}, channel, seed + 1'000'000);
    std::array<std::string, 2> said;
    for (int i = 0; i < 12; ++i) {
      const auto which = static_cast<std::size_t>(draws.next() * 2.0);
      const std::string text(static_cast<std::size_t>(std::pow(10.0, 4.0 * draws.next())), static_cast<char>('a' + i));
      if (pair.ends[which].send(bytes_of(text), "")) said[which] += text;
      pair.run_until(pair.now_ns + static_cast<std::int64_t>(draws.next() * 4e9));
    }
    pair.run_until(pair.now_ns + 3600 * kSecond_ns);
    for (const std::size_t to : {0U, 1U}) {
      const std::string& from = said[1 - to];
      const std::string& got = pair.learned[to].bytes;
      EXPECT_EQ(got, from.substr(0, got.size())) << seed;
      const bool lives = pair.learned[0].end_ns < 0 && pair.learned[1].end_ns < 0;
      if (lives) {
        EXPECT_EQ(got.size(), from.size()) << seed;
      }
    }
    broken += pair.learned[0].end_ns >= 0 || pair.learned[1].end_ns >= 0 ? 1 : 0;
  }
  EXPECT_GT(broken, 0);
  EXPECT_LT(broken, 600) << "of streams over the worst channels, too";
}

TEST(Streams, EachEndNoticesByItselfThatTheOtherIsGone) {
  Settings settings;
  settings.timeout.fixed_ns = kSecond_ns;
  settings.most_repeats = 3;
  Pair pair(settings, kPerfect, 1);
  pair.run_until(kSecond_ns);
  pair.is_loud = false;
  pair.say(0, "x");
  pair.run_until(3 * kSecond_ns);
  pair.say(1, "y");
  pair.run_until(100 * kSecond_ns);
  EXPECT_EQ(pair.learned[0].end_ns, 5 * kSecond_ns) << "sent once, repeated three times";
  EXPECT_EQ(pair.learned[1].end_ns, 7 * kSecond_ns);
  EXPECT_EQ(pair.learned[0].reason, "no answer to 3 repeats");
  settings.most_silence_ns = 2 * kSecond_ns;
  Pair impatient(settings, kPerfect, 1);
  impatient.run_until(kSecond_ns);
  impatient.is_loud = false;
  impatient.say(0, "x");
  impatient.run_until(100 * kSecond_ns);
  EXPECT_EQ(impatient.learned[0].reason, "silent for 2 s");
  EXPECT_EQ(impatient.learned[1].end_ns, -1) << "it has nothing to say, so it waits for nothing";
}

TEST(Streams, WhoDoesNotKnowTheConnectionBreaksIt) {
  Pair pair({}, kPerfect, 1);
  pair.run_until(kSecond_ns);
  pair.ends[0].hear(of(Segment::Kind::Reset, 0, 0), pair.now_ns);
  pair.run_until(2 * kSecond_ns);
  EXPECT_EQ(pair.learned[0].reason, "reset by the other end");
}

TEST(Streams, TakeNoMoreThanTheyCanKeep) {
  Settings settings;
  settings.most_waiting = 5000;
  Pair pair(settings, kPerfect, 1);
  pair.say(0, std::string(5000, 'x'));
  EXPECT_FALSE(pair.ends[0].send(bytes_of("y"), ""));
  pair.run_until(kSecond_ns);
  EXPECT_EQ(pair.learned[1].bytes.size(), 5000U);
  pair.say(0, "y");
}

// ---- closed forms: constant delay d, fixed timeout T above the round trip, loss p of each datagram

struct Trial {
  double loss = 0.0;
  std::uint32_t repeats = 0;
  std::int64_t delay_ns = kSecond_ns / 10, timeout_ns = kSecond_ns;
};

// A lone segment on an open connection.
Pair lone_segment(const Trial& trial, std::uint64_t seed) {
  Settings settings;
  settings.timeout.fixed_ns = trial.timeout_ns;
  settings.most_repeats = trial.repeats;
  settings.most_silence_ns = 1'000'000 * kSecond_ns;
  Channel channel{0.0, 0.0, trial.delay_ns, trial.delay_ns};
  Pair pair(settings, channel, seed);
  pair.run_until(10 * kSecond_ns);
  pair.channel.loss = trial.loss;
  pair.say(0, "x");
  return pair;
}

TEST(ClosedForms, TheMeanDelayOfALoneSegment) {
  constexpr int kTrials = 4000;
  for (const double loss : {0.1, 0.4}) {
    const Trial trial{loss, 1000};
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kTrials; ++i) {
      Pair pair = lone_segment(trial, static_cast<std::uint64_t>(i) + 1);
      pair.run_until(10'000 * kSecond_ns);
      const double delay_s = static_cast<double>(pair.learned[1].first_bytes_ns - 10 * kSecond_ns) * 1e-9;
      sum += delay_s;
      squares += delay_s * delay_s;
    }
    // Each sending is lost with p, and the next one comes T later.
    const double mean_s = sum / kTrials, expected_s = 0.1 + 1.0 * loss / (1.0 - loss);
    const double error_s = std::sqrt((squares / kTrials - mean_s * mean_s) / kTrials);
    EXPECT_NEAR(mean_s, expected_s, 4.0 * error_s) << loss;
    EXPECT_NEAR(error_s * std::sqrt(kTrials), std::sqrt(loss) / (1.0 - loss), 0.1) << "as of geometric waits";
  }
}

TEST(ClosedForms, TheShareOfBrokenConnections) {
  constexpr int kTrials = 4000;
  for (const auto& [loss, repeats] : {std::pair(0.4, 2U), {0.4, 5U}, {0.2, 1U}}) {
    int broken = 0;
    for (int i = 0; i < kTrials; ++i) {
      Pair pair = lone_segment({loss, repeats}, static_cast<std::uint64_t>(i) + 1);
      pair.run_until(1000 * kSecond_ns);
      broken += pair.learned[0].end_ns >= 0 ? 1 : 0;
    }
    // A sending is of no use if it is lost, or its answer; all of them have to be.
    const double unanswered = 1.0 - (1.0 - loss) * (1.0 - loss), share = std::pow(unanswered, repeats + 1.0);
    EXPECT_NEAR(broken / static_cast<double>(kTrials), share, 4.0 * std::sqrt(share * (1.0 - share) / kTrials))
        << loss << " " << repeats;
  }
}

// The opener learns that it is open after a round trip, of which each way can be lost.
TEST(ClosedForms, TheMeanTimeOfAHandshake) {
  constexpr int kTrials = 4000;
  const double loss = 0.4;
  double sum = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    Settings settings;
    settings.timeout.fixed_ns = kSecond_ns;
    settings.most_repeats = 1000;
    Pair pair(settings, {loss, 0.0, kSecond_ns / 10, kSecond_ns / 10}, static_cast<std::uint64_t>(i) + 1);
    std::int64_t opened_ns = 0;
    for (std::int64_t at = kSecond_ns / 10; opened_ns == 0; at += kSecond_ns / 10) {
      pair.run_until(at + 1);
      if (!pair.learned[0].events.empty()) opened_ns = at;
    }
    sum += static_cast<double>(opened_ns) * 1e-9;
  }
  // The opening arrives after a geometric wait of repeats, and so does the opening of the other end, which answers it.
  const double waits_s = loss / (1.0 - loss), variance = 2.0 * loss / ((1.0 - loss) * (1.0 - loss));
  EXPECT_NEAR(sum / kTrials, 0.2 + 2.0 * waits_s, 4.0 * std::sqrt(variance / kTrials));
}

}  // namespace
}  // namespace fleetproof::stream_test
