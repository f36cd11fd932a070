// Long-run losses against their closed forms, on a million messages each, and the promise that a higher loss rate only
// adds losses.
#include <gtest/gtest.h>

#include <functional>

#include "core/radio/radio.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/exact_binomial.hpp"

namespace fleetproof::radio_loss_test {
namespace {

using Model = OutageSetup::Model;
using Scope = OutageSetup::Scope;
using test::is_binomial;

constexpr std::uint32_t kWorlds = 1000, kReceivers = 1000;
constexpr std::uint64_t kMessages = std::uint64_t{kWorlds} * kReceivers;

struct Tally {
  std::uint64_t lost = 0, in_outage = 0, lost_in_outage = 0;
};

// One message on each of a million links that have nothing in common, so that the trials are independent: AGV 0 to 1000
// receivers in 1000 worlds. The receivers stand in cells of their own.
Tally a_million_messages(const RadioSetup& setup, SimTime at, std::uint32_t sender = 0) {
  Tally tally;
  for (std::uint32_t world = 0; world < kWorlds; ++world) {
    Radio radio(setup, 77'000 + world);
    for (std::uint32_t r = 0; r < kReceivers; ++r) {
      const Delivery delivery =
          radio.delivery(AgvId{sender}, AgvId{r + 2000}, at, 0, {Vec2::Zero(), Vec2(100.0 * r + 1.0, 1.0)});
      tally.lost += delivery.lost ? 1 : 0;
      tally.in_outage += delivery.in_outage ? 1 : 0;
      tally.lost_in_outage += delivery.lost && delivery.in_outage ? 1 : 0;
    }
  }
  return tally;
}

TEST(RadioLoss, IndependentLossesHaveTheNominalShare) {
  for (const double loss : {0.0, 0.001, 0.2, 0.4, 0.95, 1.0}) {
    const Tally tally = a_million_messages({.loss = loss}, at_seconds(12.3));
    EXPECT_TRUE(is_binomial(tally.lost, kMessages, loss)) << loss;
    EXPECT_EQ(tally.in_outage, 0U);
  }
}

struct OutageCase {
  Model model;
  Scope scope;
  double loss;
  SimTime at;
};

class OutageLoss : public testing::TestWithParam<OutageCase> {};

TEST_P(OutageLoss, HasTheNominalShareAtEveryInstant) {
  const auto& [model, scope, loss, at] = GetParam();
  const Tally tally =
      a_million_messages({.loss = loss, .outages = {.mean_outage_s = 0.5, .model = model, .scope = scope}}, at);
  const double share = (loss - 0.05) / 0.9;
  EXPECT_TRUE(is_binomial(tally.lost, kMessages, loss));
  EXPECT_TRUE(is_binomial(tally.in_outage, kMessages, share));
  EXPECT_TRUE(is_binomial(tally.lost_in_outage, tally.in_outage, 0.95));
  EXPECT_TRUE(is_binomial(tally.lost - tally.lost_in_outage, kMessages - tally.in_outage, 0.05));
}

// Time zero is the stationary start, the others what the process makes of it after a few outages.
INSTANTIATE_TEST_SUITE_P(Cases, OutageLoss,
                         testing::Values(OutageCase{Model::GilbertElliott, Scope::Link, 0.4, kStart},
                                         OutageCase{Model::GilbertElliott, Scope::Link, 0.1, at_seconds(0.3)},
                                         OutageCase{Model::GilbertElliott, Scope::Direction, 0.7, at_seconds(2.1)},
                                         OutageCase{Model::GilbertElliott, Scope::Place, 0.4, at_seconds(0.7)},
                                         OutageCase{Model::HeavyTail, Scope::Link, 0.4, kStart},
                                         OutageCase{Model::HeavyTail, Scope::Link, 0.4, at_seconds(0.2)},
                                         OutageCase{Model::HeavyTail, Scope::Link, 0.2, at_seconds(1.7)},
                                         OutageCase{Model::HeavyTail, Scope::Place, 0.6, at_seconds(0.9)}),
                         [](const auto& param) {
                           const auto& c = param.param;
                           return std::string(c.model == Model::HeavyTail ? "HeavyTail" : "GilbertElliott") +
                                  (c.scope == Scope::Link    ? "Link"
                                   : c.scope == Scope::Place ? "Place"
                                                             : "Direction") +
                                  std::to_string(static_cast<int>(100 * c.loss)) + "At" +
                                  std::to_string(to_ns(c.at) / 1'000'000);
                         });

TEST(RadioLoss, OtherLossesOfTheTwoStatesKeepTheNominalShare) {
  for (const Model model : {Model::GilbertElliott, Model::HeavyTail}) {
    const RadioSetup setup{.loss = 0.3,
                           .outages = {.mean_outage_s = 0.5, .model = model, .loss_good = 0.1, .loss_bad = 0.6}};
    const Tally tally = a_million_messages(setup, at_seconds(0.8));
    EXPECT_TRUE(is_binomial(tally.lost, kMessages, 0.3));
    EXPECT_TRUE(is_binomial(tally.in_outage, kMessages, 0.4));
    EXPECT_TRUE(is_binomial(tally.lost_in_outage, tally.in_outage, 0.6));
  }
}

TEST(RadioLoss, OutsideTheLossesOfTheTwoStatesOneStateIsLeft) {
  const RadioSetup base{.outages = {.mean_outage_s = 0.5}};
  for (const double loss : {0.0, 0.03, 0.05}) {
    RadioSetup setup = base;
    setup.loss = loss;
    const Tally tally = a_million_messages(setup, at_seconds(0.3));
    EXPECT_TRUE(is_binomial(tally.lost, kMessages, loss)) << loss;
    EXPECT_EQ(tally.in_outage, 0U);
  }
  for (const double loss : {0.95, 0.97, 1.0}) {
    RadioSetup setup = base;
    setup.loss = loss;
    const Tally tally = a_million_messages(setup, at_seconds(0.3));
    EXPECT_TRUE(is_binomial(tally.lost, kMessages, loss)) << loss;
    EXPECT_EQ(tally.in_outage, kMessages);
  }
}

TEST(RadioLoss, AsymmetryKeepsTheMeanAndPartsTheDirections) {
  for (const double outage_s : {0.0, 0.5}) {
    const RadioSetup setup{.loss = 0.4, .outages = {.mean_outage_s = outage_s}, .asymmetry = 0.8};
    EXPECT_TRUE(is_binomial(a_million_messages(setup, at_seconds(0.3)).lost, kMessages,
                            0.4));  // the shift is independent from link to link
  }
  // One pair, many instants far apart: there and back differ, and their mean is the nominal loss. The test knows the
  // sum only, not the shift.
  Radio radio({.loss = 0.4, .asymmetry = 1.0}, 5);
  std::uint64_t there = 0, back = 0;
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    const SimTime at = at_ns(static_cast<std::int64_t>(i) * 10'000'019);
    there += radio.delivery(AgvId{3U}, AgvId{9U}, at, 0).lost ? 1 : 0;
    back += radio.delivery(AgvId{9U}, AgvId{3U}, at, 0).lost ? 1 : 0;
  }
  EXPECT_GT(there > back ? there - back : back - there, kMessages / 100);
  // A sum of two binomials of unlike p varies less than one of their mean, so the bound is a little wide.
  EXPECT_TRUE(is_binomial(there + back, 2 * kMessages, 0.4));
}

// ---- a higher loss rate only adds losses

struct Kind {
  const char* name;
  RadioSetup setup;
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

const Kind kKinds[] = {
    {"Independent", {}},
    {"GilbertElliott", {.outages = {.mean_outage_s = 0.5}}},
    {"HeavyTail", {.outages = {.mean_outage_s = 0.5, .model = Model::HeavyTail, .shape = 1.2}}},
    {"HeavyTailOfFiniteVariance", {.outages = {.mean_outage_s = 0.5, .model = Model::HeavyTail, .shape = 3.0}}},
    {"Direction", {.outages = {.mean_outage_s = 0.1, .scope = Scope::Direction}}},
    {"Place", {.outages = {.mean_outage_s = 2.0, .scope = Scope::Place}}},
    {"HeavyTailPlace", {.outages = {.mean_outage_s = 2.0, .model = Model::HeavyTail, .scope = Scope::Place}}},
    {"Asymmetric", {.asymmetry = 1.0}},
    {"AsymmetricOutages", {.outages = {.mean_outage_s = 0.5, .model = Model::HeavyTail}, .asymmetry = 1.0}},
    {"Duplicates", {.outages = {.mean_outage_s = 0.5}, .duplicates = 0.3}},
    {"Roaming", {.outages = {.mean_outage_s = 0.5}, .places = {.roaming_border_m = 3.0}}},
};

class LossLevels : public testing::TestWithParam<Kind> {};

TEST_P(LossLevels, AHigherLossRateOnlyAddsLosses) {
  std::vector<Radio> radios;
  for (const double loss : {0.0, 0.05, 0.1, 0.2, 0.4, 0.6, 0.94, 0.97, 1.0}) {
    RadioSetup setup = GetParam().setup;
    setup.loss = loss;
    setup.delay_s = 2.0;
    setup.delay_model = RadioSetup::DelayModel::Uniform;
    radios.emplace_back(setup, 11);
  }
  std::vector<std::uint64_t> losses(radios.size());
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const SimTime at = at_ns(std::int64_t{i} * 10'000'019);
    const AgvId sender{i % 5}, receiver{(i + 1 + i / 5 % 4) % 5};
    const LinkPlaces places{Vec2(i % 300, 5.0), Vec2(5.0, i % 170)};
    std::optional<Delivery> milder;
    for (std::size_t k = 0; k < radios.size(); ++k) {
      const Delivery delivery = radios[k].delivery(sender, receiver, at, 0, places);
      losses[k] += delivery.lost ? 1 : 0;
      if (milder) {
        ASSERT_TRUE(delivery.lost || !milder->lost) << "message " << i << " is lost at level " << k - 1 << " alone";
        ASSERT_TRUE(delivery.in_outage || !milder->in_outage)
            << "message " << i << " meets an outage at level " << k - 1 << " alone";
        ASSERT_EQ(delivery.delay, milder->delay);
        ASSERT_EQ(delivery.copy_delay, milder->copy_delay);
      }
      milder = delivery;
    }
  }
  for (std::size_t k = 1; k < losses.size(); ++k) EXPECT_GT(losses[k], losses[k - 1]) << k;  // and it does add some
}

INSTANTIATE_TEST_SUITE_P(Kinds, LossLevels, testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace fleetproof::radio_loss_test
