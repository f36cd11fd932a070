// Outages that belong to a place, recordings, and both in whole runs.
#include <gtest/gtest.h>

#include <set>

#include "core/radio/radio.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::radio_place_test {
namespace {

using Scope = OutageSetup::Scope;
const AgvId kA{0U}, kB{1U}, kC{2U};

constexpr PlaceSetup kRoaming{
    .ap_spacing_m = 20.0, .roaming_border_m = 2.0, .roaming_min_s = 1.2, .roaming_max_s = 4.7, .roaming_gap_s = 2.95};

std::vector<bool> roaming_states(RadioPlaces& places, const Vec2& at_m) {
  std::vector<bool> states;
  for (int i = 0; i < 1000; ++i) states.push_back(places.is_roaming(at_m, at_ns(i * 100'000'000LL)));
  return states;
}

TEST(Roaming, BelongsToTheBorderAndEndsBesideIt) {
  RadioPlaces places(kRoaming, {}, 4);
  const auto at_border = roaming_states(places, {10.0, 5.0});
  EXPECT_NE(std::ranges::count(at_border, true), 0);
  EXPECT_NE(std::ranges::count(at_border, false), 0);
  EXPECT_EQ(roaming_states(places, {8.0, 3.0}),
            at_border);  // the same border, so AGVs that meet there go deaf together
  EXPECT_EQ(roaming_states(places, {12.0, -3.0}), at_border);
  EXPECT_EQ(std::ranges::count(roaming_states(places, {12.01, 5.0}), true), 0);
  EXPECT_EQ(std::ranges::count(roaming_states(places, {0.0, 0.0}), true), 0);
  EXPECT_NE(roaming_states(places, {10.0, 25.0}), at_border);  // the next border up
  EXPECT_NE(roaming_states(places, {30.0, 5.0}), at_border);
  EXPECT_NE(roaming_states(places, {5.0, 10.0}), at_border);
  EXPECT_NE(roaming_states(places, {-10.0, 5.0}), at_border);
}

TEST(Roaming, TakesItsShareOfTheTime) {  // windows of 2.95 s on average, gaps of 2.95 s: half of it
  std::uint64_t roaming = 0;
  for (std::uint64_t world = 0; world < 100'000; ++world) {
    RadioPlaces places(kRoaming, {}, world);
    roaming += places.is_roaming({10.0, 5.0}, at_seconds(3.3)) ? 1 : 0;
  }
  EXPECT_TRUE(test::is_binomial(roaming, 100'000, 0.5));
}

TEST(PlaceOutages, MakeEveryoneInACellDeaf) {
  Radio radio({.loss = 0.5,
               .outages = {.mean_outage_s = 2.0, .scope = Scope::Place, .loss_good = 0.0, .loss_bad = 1.0},
               .places = {.ap_spacing_m = 20.0}},
              6);
  int other_cell_differs = 0, lost = 0;
  for (int i = 0; i < 2000; ++i) {
    const SimTime t = at_ns(i * 50'000'000LL);
    const bool a = radio.delivery(kC, kA, t, 0, {{-90.0, 3.0}, {-9.0, -9.0}}).lost,
               b = radio.delivery(kC, kB, t, 0, {{55.0, 3.0}, {9.0, 9.0}}).lost;
    EXPECT_EQ(a, b);
    lost += a ? 1 : 0;
    other_cell_differs += radio.delivery(kC, kB, t, 0, {{55.0, 3.0}, {11.0, 9.0}}).lost != a ? 1 : 0;
  }
  EXPECT_GT(lost, 400);
  EXPECT_GT(other_cell_differs, 400);
}

// AGV 0 to 2 in a row 4 m apart talk to each other ten times a second; the result lists sender, receiver and instant of
// each reception.
using Reception = std::tuple<std::uint32_t, std::uint32_t, SimTime>;

std::set<Reception> talk(const RadioSetup& radio, std::vector<std::uint32_t> starts, Outcome* outcome = nullptr,
                         bool chatter = false) {
  Scenario scenario = test::row_scenario(8, std::move(starts), 30.0);
  scenario.radio = radio;
  test::Recorder recorder;
  const Outcome result = test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        fp_message message{.struct_size = sizeof(fp_message), .sender = 0, .size = 0, .bytes = nullptr};
        while (host.get_message(c, &message) == FP_OK) {
        }
        if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
        host.send_broadcast(c, "here", 4);
        const bool more = chatter && b.self == 0 && event.now_ns % 100'000'000 == 0;  // a second broadcast between two
        host.set_timer(c, 1, event.now_ns + (chatter && b.self == 0 ? 50'000'000 : 100'000'000));
        if (more) host.send_broadcast(c, "more", 4);
      },
      &recorder);
  if (outcome != nullptr) *outcome = result;
  std::set<Reception> received;
  for (const TraceRecord& r : recorder.of(TraceKind::Received))
    received.emplace(static_cast<std::uint32_t>(r.a), r.entity.value, r.at);
  return received;
}

TEST(WholeRun, WhoChangesAccessPointsNeitherHearsNorIsHeard) {
  RadioSetup radio;
  radio.places = {.ap_spacing_m = 12.0,
                  .roaming_border_m = 2.5,
                  .roaming_gap_s = 3.0};  // station 4 is 2 m from a border, 0 and 3 are 6 m
  Outcome outcome;
  const auto received = talk(radio, {4, 0, 3}, &outcome);
  std::array<std::array<int, 3>, 3> count{};
  std::set<SimTime> to_0_from_1, to_0_from_2, to_1_from_0;
  for (const auto& [from, to, at] : received) {
    ++count[from][to];
    if (from == 1 && to == 0) to_0_from_1.insert(at);
    if (from == 2 && to == 0) to_0_from_2.insert(at);
    if (from == 0 && to == 1) to_1_from_0.insert(at);
  }
  const int sent = static_cast<int>(outcome.counters.messages_sent / 3) - 1;  // the last ones are under way at the end
  EXPECT_EQ(count[1][2], sent);
  EXPECT_EQ(count[2][1], sent);
  EXPECT_GT(count[0][1], 30);
  EXPECT_LT(count[0][1], sent - 30);
  EXPECT_EQ(to_0_from_1, to_0_from_2);
  EXPECT_EQ(to_0_from_1, to_1_from_0);
  EXPECT_EQ(outcome.counters.receptions_lost, outcome.counters.lost_in_outage);
  EXPECT_GE(received.size() + 6, outcome.counters.receptions - outcome.counters.receptions_lost);
}

const RadioSetup kAllAtOnce{.loss = 0.4,
                            .delay_s = 0.5,
                            .delay_model = RadioSetup::DelayModel::HeavyTail,
                            .outages = {.mean_outage_s = 0.5, .model = OutageSetup::Model::HeavyTail},
                            .asymmetry = 0.5,
                            .duplicates = 0.1,
                            .places = {.ap_spacing_m = 12.0, .roaming_border_m = 2.5}};

std::set<Reception> between_0_and_1(const std::set<Reception>& all) {
  std::set<Reception> some;
  for (const auto& r : all) {
    if (std::get<0>(r) < 2 && std::get<1>(r) < 2) some.insert(r);
  }
  return some;
}

TEST(WholeRun, AnAgvLessLeavesTheDeliveriesOfTheOthersAlone) {
  for (const Scope scope : {Scope::Link, Scope::Direction, Scope::Place}) {
    RadioSetup radio = kAllAtOnce;
    radio.outages.scope = scope;
    if (scope == Scope::Place) radio.asymmetry = 0.0;
    const auto three = talk(radio, {4, 0, 3}), two = talk(radio, {4, 0});
    EXPECT_GT(two.size(), 100U);
    EXPECT_EQ(between_0_and_1(three), two);
  }
}

TEST(WholeRun, MessagesMoreMoveNoOthersDelivery) {
  const auto quiet = talk(kAllAtOnce, {4, 0, 3}), busy = talk(kAllAtOnce, {4, 0, 3}, nullptr, true);
  EXPECT_GT(busy.size(), quiet.size() + 100);
  for (const auto& reception : quiet) EXPECT_TRUE(busy.contains(reception));
  // And of those that 0 did not send more of, none is new.
  const auto of_others = [](const std::set<Reception>& all) {
    std::set<Reception> some;
    for (const auto& r : all) {
      if (std::get<0>(r) != 0) some.insert(r);
    }
    return some;
  };
  EXPECT_EQ(of_others(quiet), of_others(busy));
}

TEST(WholeRun, CountsAndTracesTellTheCauses) {
  RadioSetup radio{.loss = 0.4, .outages = {.mean_outage_s = 0.5}, .duplicates = 0.2};
  Outcome outcome;
  Scenario scenario = test::row_scenario(3, {0, 2}, 60.0);
  scenario.radio = radio;
  test::Recorder recorder;
  outcome = test::simulate_with(
      scenario,
      [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind == FP_EVENT_MESSAGE) return;
        host.send_broadcast(c, "here", 4);
        host.set_timer(c, 1, event.now_ns + 10'000'000);
      },
      &recorder);
  const Counters& c = outcome.counters;
  EXPECT_EQ(recorder.of(TraceKind::LostInOutage).size(), c.lost_in_outage);
  EXPECT_EQ(recorder.of(TraceKind::Lost).size(), c.receptions_lost - c.lost_in_outage);
  EXPECT_EQ(recorder.of(TraceKind::Received).size(),
            c.receptions - c.receptions_lost + c.duplicates - 2);  // two arrive after the end
  EXPECT_GT(c.lost_in_outage, 2 * (c.receptions_lost - c.lost_in_outage));
  EXPECT_GT(c.duplicates, 1000U);
  EXPECT_EQ(c.lost_by_interference, 0U);
}

TEST(RecordedRadio, DecidesTheDeliveriesOfItsPairs) {
  const auto ms = [](int n) { return Duration{n * 1'000'000LL}; };
  const RadioTrace trace{{kA, kB, ms(0), ms(10)},
                         {kA, kB, ms(100), std::nullopt},
                         {kA, kB, ms(200), ms(30)},
                         {kB, kA, ms(150), ms(40)},
                         {kB, kA, ms(300), std::nullopt}};
  Radio radio({.loss = 1.0, .delay_s = 5.0, .trace = std::make_shared<const RadioTrace>(trace)}, 1);
  const auto says = [&](AgvId from, AgvId to, std::int64_t at, std::optional<int> delay_ms) {
    const Delivery delivery = radio.delivery(from, to, at_ns(at), 0);
    EXPECT_EQ(delivery.lost, !delay_ms.has_value()) << at;
    EXPECT_TRUE(delivery.lost || delivery.delay == ms(delay_ms.value_or(-1))) << at;
  };
  says(kA, kB, 0, 10);
  says(kA, kB, 1, std::nullopt);
  says(kA, kB, 100'000'000, std::nullopt);
  says(kA, kB, 100'000'001, 30);
  says(kA, kB, 200'000'001, 10);  // none is left: the first one of the next time round
  says(kB, kA, 0, 40);
  says(kB, kA, 150'000'001, std::nullopt);
  says(kB, kA, 300'000'000, std::nullopt);
  says(kB, kA, 300'000'001, 40);  // one nanosecond after the last instant it all begins again
  says(kA, kB, 300'000'001, 10);
  says(kA, kB, 300'000'001 + 200'000'000, 30);
  says(kA, kC, 0, std::nullopt);  // not recorded: the nominal loss of 100 %
}

}  // namespace
}  // namespace fleetproof::radio_place_test
