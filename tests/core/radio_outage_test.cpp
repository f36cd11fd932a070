// Outages as processes in time: lengths, independence of traffic and of earlier questions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "core/radio/outage_process.hpp"
#include "core/radio/radio.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/exact_binomial.hpp"

namespace fleetproof::radio_outage_test {
namespace {

using Model = OutageSetup::Model;
using Sojourn = OutageLaw::Sojourn;
using test::expect_quantiles;

struct Sojourns {
  std::vector<double> bad_s, good_s;
};

// The lengths of successive outages and of the times between them, complete ones only: independent of each other in a
// process of two states.
Sojourns sojourns(const OutageLaw& law, std::size_t count) {
  OutageProcess process(law, {.key = 42, .kind = 7, .a = 1, .b = 2});
  Sojourns found;
  SimTime t = process.next_change(kStart);
  bool bad = process.bad_at(t);
  while (found.bad_s.size() < count || found.good_s.size() < count) {
    const SimTime next = process.next_change(t);
    (bad ? found.bad_s : found.good_s).push_back(to_seconds(next - t));
    t = next;
    bad = !bad;
  }
  return found;
}

constexpr std::size_t kCount = 1'000'000;

TEST(OutageLengths, GilbertElliottIsExponentialInBothStates) {
  const auto [bad_s, good_s] = sojourns({.bad_share = 0.35 / 0.9, .mean_bad_s = 0.5}, kCount);
  expect_quantiles(bad_s, [](double p) { return -0.5 * std::log1p(-p); });
  expect_quantiles(good_s, [](double p) { return -0.5 * (0.55 / 0.35) * std::log1p(-p); });
}

TEST(OutageLengths, HeavyTailIsLomax) {
  for (const double shape : {1.2, 1.5, 3.0}) {
    const auto [bad_s, good_s] =
        sojourns({.sojourn = Sojourn::Lomax, .bad_share = 0.5, .mean_bad_s = 2.0, .shape = shape}, kCount / 2);
    expect_quantiles(bad_s, [&](double p) { return 2.0 * (shape - 1.0) * (std::pow(1.0 - p, -1.0 / shape) - 1.0); });
    expect_quantiles(good_s, [](double p) { return -2.0 * std::log1p(-p); });
  }
}

TEST(OutageLengths, HandoverWindowsAreUniform) {
  const auto [bad_s, good_s] =
      sojourns({.sojourn = Sojourn::Uniform, .bad_share = 2.95 / 7.95, .min_s = 1.2, .max_s = 4.7}, kCount);
  expect_quantiles(bad_s, [](double p) { return 1.2 + 3.5 * p; });
  expect_quantiles(good_s, [](double p) { return -5.0 * std::log1p(-p); });
}

// What is left of the outage at time zero: its density is P(an outage is longer) / mean.
TEST(OutageLengths, TheFirstOutageIsStationary) {
  std::vector<double> exponential_s, lomax_s, uniform_s;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const ProcessKey key{.key = 9, .kind = 7, .a = i, .b = 0};
    OutageProcess a({.bad_share = 0.5, .mean_bad_s = 0.5}, key),
        b({.sojourn = Sojourn::Lomax, .bad_share = 0.5, .mean_bad_s = 2.0, .shape = 2.5}, key),
        c({.sojourn = Sojourn::Uniform, .bad_share = 0.5, .min_s = 1.0, .max_s = 3.0}, key);
    if (a.bad_at(kStart)) exponential_s.push_back(to_seconds(a.next_change(kStart)));
    if (b.bad_at(kStart)) lomax_s.push_back(to_seconds(b.next_change(kStart)));
    if (c.bad_at(kStart)) uniform_s.push_back(to_seconds(c.next_change(kStart)));
  }
  for (const auto& samples : {exponential_s, lomax_s, uniform_s})
    EXPECT_TRUE(test::is_binomial(samples.size(), kCount, 0.5));
  expect_quantiles(exponential_s, [](double p) { return -0.5 * std::log1p(-p); });
  expect_quantiles(lomax_s, [](double p) { return 3.0 * (std::pow(1.0 - p, -1.0 / 1.5) - 1.0); });
  // Of a uniform length on 1 .. 3: density 1/2 below 1, then falling to 0 at 3 as (3 - x) / 4.
  expect_quantiles(uniform_s, [](double p) { return p <= 0.5 ? 2.0 * p : 3.0 - std::sqrt(8.0 * (1.0 - p)); });
}

TEST(OutageProcess, StateIsAFunctionOfTimeWhoeverAskedBefore) {
  for (const Sojourn sojourn : {Sojourn::Exponential, Sojourn::Lomax, Sojourn::Uniform}) {
    const OutageLaw law{.sojourn = sojourn, .bad_share = 0.4, .mean_bad_s = 0.5, .min_s = 0.2, .max_s = 0.8};
    const ProcessKey key{.key = 3, .kind = 7, .a = 4, .b = 5};
    OutageProcess forward(law, key), jumping(law, key);
    std::vector<bool> states;
    for (int i = 0; i < 2000; ++i) states.push_back(forward.bad_at(at_ns(i * 50'000'000LL)));
    EXPECT_NE(std::ranges::count(states, true), 0);
    EXPECT_NE(std::ranges::count(states, false), 0);
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
      const auto k = random() % 2000;
      ASSERT_EQ(jumping.bad_at(at_ns(static_cast<std::int64_t>(k) * 50'000'000)), states[k]) << k;
    }
  }
}

TEST(OutageProcess, LinksAndKindsHaveProcessesOfTheirOwn) {
  const OutageLaw law{.bad_share = 0.5, .mean_bad_s = 1.0};
  std::set<SimTime> changes;
  for (std::uint32_t kind = 1; kind < 4; ++kind) {
    for (std::uint32_t a = 0; a < 10; ++a) {
      for (std::uint32_t b = 0; b < 10; ++b)
        changes.insert(OutageProcess(law, {.key = 3, .kind = kind, .a = a, .b = b}).next_change(kStart));
    }
  }
  EXPECT_EQ(changes.size(), 300U);
}

TEST(OutageProcess, WithoutAndWithNothingButOutages) {
  OutageProcess never({.bad_share = 0.0}, {}), always({.bad_share = 1.0}, {});
  for (const SimTime t : {kStart, at_seconds(3.0), at_seconds(1e9)}) {
    EXPECT_FALSE(never.bad_at(t));
    EXPECT_TRUE(always.bad_at(t));
    EXPECT_EQ(never.next_change(t), kForever);
    EXPECT_EQ(always.next_change(t), kForever);
  }
}

// The outages that a sender meets, by first and last instant, when it sends every `step`.
std::set<std::pair<SimTime, SimTime>> outages_met(const RadioSetup& setup, Duration step, SimTime end) {
  Radio radio(setup, 5);
  std::set<std::pair<SimTime, SimTime>> met;
  for (SimTime t = kStart; t < end; t += step) {
    if (!radio.delivery(AgvId{0U}, AgvId{1U}, t, 0).in_outage) continue;
    OutageProcess probe = radio.process_of(AgvId{0U}, AgvId{1U});
    SimTime begin = kStart;  // from a copy, change by change: the radio itself is not touched
    for (SimTime change = kStart; change <= t; change = probe.next_change(change)) begin = change;
    met.emplace(begin, probe.next_change(t));
  }
  return met;
}

TEST(OutageProcess, SendingTenTimesAsOftenLeavesOutagesAsTheyWere) {
  for (const Model model : {Model::GilbertElliott, Model::HeavyTail}) {
    const RadioSetup setup{.loss = 0.4, .outages = {.mean_outage_s = 2.0, .model = model}};
    const auto seldom = outages_met(setup, std::chrono::milliseconds(200), at_seconds(100.0));
    const auto often = outages_met(setup, std::chrono::milliseconds(20), at_seconds(100.0));
    EXPECT_GT(seldom.size(), 5U);
    EXPECT_GE(often.size(), seldom.size());
    for (const auto& outage : seldom) EXPECT_TRUE(often.contains(outage));
    for (const auto& [begin, end] : often) {  // those that only the frequent sender met were too short for the other
      EXPECT_TRUE(seldom.contains({begin, end}) || end - begin < std::chrono::milliseconds(200));
    }
  }
}

TEST(OutageProcess, OneProcessForBothDirectionsUnlessAskedOtherwise) {
  const auto states = [](OutageSetup::Scope scope, std::uint32_t a, std::uint32_t b) {
    Radio radio({.loss = 0.5, .outages = {.mean_outage_s = 1.0, .scope = scope}}, 5);
    std::vector<bool> list;
    for (int i = 0; i < 500; ++i)
      list.push_back(radio.delivery(AgvId{a}, AgvId{b}, at_ns(i * 100'000'000LL), 0).in_outage);
    return list;
  };
  EXPECT_EQ(states(OutageSetup::Scope::Link, 2, 7), states(OutageSetup::Scope::Link, 7, 2));
  EXPECT_NE(states(OutageSetup::Scope::Direction, 2, 7), states(OutageSetup::Scope::Direction, 7, 2));
  EXPECT_NE(states(OutageSetup::Scope::Link, 2, 7), states(OutageSetup::Scope::Link, 2, 8));
}

}  // namespace
}  // namespace fleetproof::radio_outage_test
