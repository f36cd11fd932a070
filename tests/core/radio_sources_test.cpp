// External sources: when they are on, which receivers they hit, and that they only ever add losses.
#include "core/radio/radio.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "tests/support/at_seconds.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::radio_sources_test {
namespace {

const AgvId kA{0U}, kB{1U};
constexpr RadioSource kOven{.x_m = 3.0, .y_m = -4.0, .range_m = 5.0, .mean_on_s = 3.0, .mean_off_s = 7.0};

TEST(RadioSources, AreOnForTheirShareOfTheTime) {  // over independent worlds, at one instant
  std::uint64_t on = 0, destroyed = 0;
  RadioSource weak = kOven;
  weak.loss = 0.4;
  for (std::uint64_t world = 0; world < 200'000; ++world) {
    RadioSources sources({kOven}, world), half({weak}, world);
    on += sources.destroy({kA, kB, at_seconds(12.3), 0}, {0.0, 0.0}) ? 1 : 0;
    destroyed += half.destroy({kA, kB, at_seconds(12.3), 0}, {0.0, 0.0}) ? 1 : 0;
  }
  EXPECT_TRUE(test::is_binomial(on, 200'000, 0.3));
  EXPECT_TRUE(test::is_binomial(destroyed, 200'000, 0.3 * 0.4));
}

TEST(RadioSources, SojournsAreExponential) {
  RadioSources sources({kOven}, 5);
  OutageProcess& process = sources.on_process(0);
  std::vector<double> on_s, off_s;
  SimTime t = process.next_change(kStart);
  while (off_s.size() < 300'000) {
    const bool on = process.bad_at(t);
    const SimTime next = process.next_change(t);
    (on ? on_s : off_s).push_back(to_seconds(next - t));
    t = next;
  }
  test::expect_quantiles(on_s, [](double p) { return -3.0 * std::log1p(-p); });
  test::expect_quantiles(off_s, [](double p) { return -7.0 * std::log1p(-p); });
}

TEST(RadioSources, ThatAreNeverOffDestroyTheirShare) {
  RadioSources sources({{.range_m = 1.0, .mean_on_s = 2.0, .mean_off_s = 0.0, .loss = 0.25}}, 5);
  std::uint64_t destroyed = 0;
  for (int i = 0; i < 200'000; ++i)
    destroyed += sources.destroy({kA, kB, at_ns(i * 1'000'003LL), 0}, {0.5, 0.5}) ? 1 : 0;
  EXPECT_TRUE(test::is_binomial(destroyed, 200'000, 0.25));
}

TEST(RadioSources, ReachReceiversWithinTheirRange) {
  RadioSource always = kOven;
  always.mean_off_s = 0.0;
  RadioSources sources({always}, 5);
  const MessageKey message{kA, kB, at_seconds(1.0), 0};
  EXPECT_TRUE(sources.destroy(message, {3.0, -4.0}));
  EXPECT_TRUE(sources.destroy(message, {0.0, 0.0}));  // 5 m away, exactly
  EXPECT_TRUE(sources.destroy(message, {3.0, 1.0}));
  EXPECT_FALSE(sources.destroy(message, {3.0, 1.000001}));
  EXPECT_FALSE(sources.destroy(message, {-0.001, 0.0}));
}

TEST(RadioSources, HaveRandomnessOfTheirOwn) {
  std::set<SimTime> changes;
  RadioSources sources(std::vector<RadioSource>(50, kOven), 5);
  for (std::size_t i = 0; i < 50; ++i) changes.insert(sources.on_process(i).next_change(kStart));
  EXPECT_EQ(changes.size(), 50U);
  // Two alike that are always on and destroy half each: a message survives both with 1/4.
  const RadioSource half{.mean_off_s = 0.0, .loss = 0.5};
  RadioSources two({half, half}, 5);
  std::uint64_t destroyed = 0;
  for (int i = 0; i < 100'000; ++i) destroyed += two.destroy({kA, kB, at_ns(i * 999'983LL), 0}, {0.0, 0.0}) ? 1 : 0;
  EXPECT_TRUE(test::is_binomial(destroyed, 100'000, 0.75));
}

// A list of messages among four AGVs over 200 s, here and there.
struct Sent {
  AgvId sender, receiver;
  SimTime at;
  LinkPlaces places;
};

std::vector<Sent> messages() {
  std::mt19937 random(7);
  const auto below = [&](unsigned bound) { return static_cast<std::uint32_t>(random() % bound); };
  const auto place = [&] { return Vec2(0.1 * below(400) - 20.0, 0.1 * below(400) - 20.0); };
  std::vector<Sent> list;
  for (int i = 0; i < 20'000; ++i) {
    const std::uint32_t sender = below(4);
    list.push_back({AgvId{sender}, AgvId{(sender + 1 + below(3)) % 4}, at_ns(i * 10'000'019LL), {place(), place()}});
  }
  return list;
}

std::vector<Delivery> deliveries(const RadioSetup& setup) {
  Radio radio(setup, 11);
  std::vector<Delivery> found;
  for (const Sent& m : messages()) found.push_back(radio.delivery(m.sender, m.receiver, m.at, 0, m.places));
  return found;
}

// Whether `more` has lost what `fewer` has, for the same causes, and some beyond; delays and copies are the same.
void expect_adds_losses(const RadioSetup& fewer_setup, const RadioSetup& more_setup) {
  const auto fewer = deliveries(fewer_setup), more = deliveries(more_setup);
  int added = 0;
  for (std::size_t i = 0; i < fewer.size(); ++i) {
    ASSERT_TRUE(!fewer[i].lost || more[i].lost) << i;
    ASSERT_EQ(fewer[i].delay, more[i].delay);
    ASSERT_EQ(fewer[i].copy_delay, more[i].copy_delay);
    ASSERT_EQ(fewer[i].in_outage, more[i].in_outage);
    ASSERT_TRUE(!fewer[i].lost || fewer[i].to_source == more[i].to_source) << "a loss has changed its cause";
    ASSERT_TRUE(!more[i].to_source || more[i].lost);
    added += !fewer[i].lost && more[i].lost ? 1 : 0;
  }
  EXPECT_GT(added, 100);
}

TEST(RadioSources, OneMoreOrAWorseOneOnlyAddsLosses) {
  RadioSetup none{.loss = 0.3,
                  .delay_s = 1.0,
                  .delay_model = RadioSetup::DelayModel::Uniform,
                  .outages = {.mean_outage_s = 0.5},
                  .duplicates = 0.1,
                  .places = {.ap_spacing_m = 10.0, .roaming_border_m = 1.0}};
  none.trace = std::make_shared<const RadioTrace>(
      RadioTrace{{kA, kB, Duration{0}, Duration{1'000'000}}, {kA, kB, Duration{50'000'000}, std::nullopt}});
  RadioSetup one = none, two = none, wide = none, strong = none;
  one.sources = {{.x_m = 5.0, .y_m = 5.0, .range_m = 12.0, .mean_on_s = 2.0, .mean_off_s = 2.0, .loss = 0.5}};
  expect_adds_losses(none, one);
  two.sources = {one.sources[0],
                 {.x_m = -8.0, .y_m = 0.0, .range_m = 9.0, .mean_on_s = 1.0, .mean_off_s = 3.0, .loss = 1.0}};
  expect_adds_losses(one, two);
  wide.sources = strong.sources = one.sources;
  wide.sources[0].range_m = 20.0;
  expect_adds_losses(one, wide);
  strong.sources[0].loss = 0.9;
  expect_adds_losses(one, strong);
}

// ---- whole runs

// Each of the AGVs in the row sends a broadcast every 100 ms; the result lists sender, receiver and instant of each
// reception.
using Reception = std::tuple<std::uint32_t, std::uint32_t, SimTime>;

std::set<Reception> talk(const RadioSetup& radio, std::vector<std::uint32_t> starts, Outcome& outcome,
                         test::Recorder& recorder) {
  Scenario scenario = test::row_scenario(8, std::move(starts), 30.0);
  scenario.radio = radio;
  outcome = test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind == FP_EVENT_MESSAGE) return;
        host.send_broadcast(c, "here", 4);
        host.set_timer(c, 1, event.now_ns + 100'000'000);
      },
      &recorder);
  std::set<Reception> received;
  for (const TraceRecord& r : recorder.of(TraceKind::Received))
    received.emplace(static_cast<std::uint32_t>(r.a), r.entity.value, r.at);
  return received;
}

TEST(WholeRun, WhoStandsByASourceHearsNobodyAndIsHeardByAll) {
  RadioSetup radio;
  radio.sources = {
      {.x_m = 16.5, .y_m = 0.0, .range_m = 1.0, .mean_on_s = 1.0, .mean_off_s = 0.0}};  // station 4 stands at 16 m
  Outcome outcome;
  test::Recorder recorder;
  const auto received = talk(radio, {4, 0, 3}, outcome, recorder);
  std::array<std::array<int, 3>, 3> count{};
  for (const auto& [from, to, at] : received) ++count[from][to];
  const int sent = static_cast<int>(outcome.counters.messages_sent / 3) - 1;  // the last ones are under way at the end
  EXPECT_EQ(count, (std::array<std::array<int, 3>, 3>{{{0, sent, sent}, {0, 0, sent}, {0, sent, 0}}}));
  const auto lost = recorder.of(TraceKind::LostToSource);
  EXPECT_EQ(lost.size(), 2U * static_cast<unsigned>(sent + 1));
  for (const TraceRecord& r : lost) EXPECT_EQ(r.entity, kA);
  EXPECT_EQ(outcome.counters.lost_to_sources, lost.size());
  EXPECT_EQ(outcome.counters.receptions_lost, lost.size());
  EXPECT_EQ(outcome.counters.lost_in_outage + outcome.counters.lost_by_interference, 0U);
}

TEST(WholeRun, AnAgvLessLeavesWhatSourcesDoToTheOthers) {
  RadioSetup radio{.loss = 0.2};
  radio.sources = {{.x_m = 10.0, .y_m = 3.0, .range_m = 12.0, .mean_on_s = 1.0, .mean_off_s = 1.0, .loss = 0.7}};
  Outcome outcome;
  test::Recorder with_three, with_two;
  const auto three = talk(radio, {4, 0, 3}, outcome, with_three), two = talk(radio, {4, 0}, outcome, with_two);
  EXPECT_GT(outcome.counters.lost_to_sources, 50U);
  EXPECT_GT(two.size(), 100U);
  std::set<Reception> of_two;
  for (const auto& r : three) {
    if (std::get<0>(r) < 2 && std::get<1>(r) < 2) of_two.insert(r);
  }
  EXPECT_EQ(of_two, two);
}

}  // namespace
}  // namespace fleetproof::radio_sources_test
