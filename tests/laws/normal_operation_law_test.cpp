#include "laws/normal_operation_law.hpp"

#include <gmock/gmock.h>

#include "laws/link_quality.hpp"
#include "tests/laws/told.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::normal_operation_law_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using enum IncidentKind;

// P(X >= k) by summing binomial terms in logarithms: another way than the law's.
double upper_tail(int n, int k, double p) {
  double sum = 0.0;
  for (int i = k; i <= n; ++i)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  return sum;
}

TEST(LossesThatReject, AreTheFewestWithATailBelowOneInTenThousand) {
  for (const int n : {1, 5, 10, 11, 20, 40, 100, 333, 512}) {
    const int k = static_cast<int>(losses_that_reject(static_cast<std::uint32_t>(n)));
    if (k <= n) {
      EXPECT_LT(upper_tail(n, k, 0.4), 1e-4) << n;
    }
    EXPECT_GE(upper_tail(n, k - 1, 0.4), 1e-4) << n;
  }
  EXPECT_EQ(losses_that_reject(0), 1U) << "without receptions nothing is rejected";
  EXPECT_GT(losses_that_reject(10), 10U) << "0.4^10 is above 1e-4: ten losses in a row reject nothing";
  EXPECT_EQ(losses_that_reject(11), 11U);
}

TEST(LossesThatReject, GoOnSmoothlyWhereTheyAreNoLongerExact) {
  EXPECT_NEAR(static_cast<double>(losses_that_reject(513)), static_cast<double>(losses_that_reject(512)), 2.0);
}

// Two AGVs; AGV 1 sends ten messages a second to AGV 0, of which `lost_of_ten` are lost and the others take `delay_s`.
class NormalOperation : public testing::Test {
 protected:
  NormalOperation() { scenario_ = row_scenario(4, {0, 3}, 60.0); }
  // The law is told in order of time; `happens` is called at the beginning of each second.
  std::vector<Incident> run(double end_s, int lost_of_ten, double delay_s,
                            const std::function<void(Told&, int)>& happens) {
    Told told(scenario_, "normal-operation");
    std::multimap<double, std::function<void()>> story;
    for (int second = 0; second < static_cast<int>(end_s); ++second) {
      story.emplace(second, [&told, &happens, second] { happens(told, second); });
      for (int i = 0; i < 10; ++i) {
        const auto hash = static_cast<std::uint64_t>(10 * second + i);
        const double sent_s = second + 0.1 * i + 0.01;
        story.emplace(sent_s, [&told, sent_s, hash] { told.sends(sent_s, 1, 0, hash); });
        const double there_s = i < lost_of_ten ? sent_s : sent_s + delay_s;
        const auto kind = i < lost_of_ten ? TraceKind::Lost : TraceKind::Received;
        if (there_s < end_s)
          story.emplace(there_s, [&told, there_s, hash, kind] { told.reception(there_s, 0, kind, 1, hash); });
      }
    }
    for (const auto& [at, tell] : story) tell();
    return told.finish(end_s).incidents;
  }
  static void safe_from_20(Told& told, int second) {
    if (second == 20) told.record(20.0, 0, traced::SafeMode{true});
  }
  static void nothing(Told&, int) {}
  Scenario scenario_;
};

TEST_F(NormalOperation, SafeModeWithinTheContractIsAccused) {
  const auto found = run(60.0, 3, 1.5, safe_from_20);
  ASSERT_THAT(kinds_of(found), ElementsAre(SafeModeInContract));
  EXPECT_EQ(found[0].a, EntityId{0U});
  EXPECT_EQ(found[0].first, at_seconds(20.0)) << "the radio has kept its contract all the time";
  EXPECT_EQ(found[0].last, at_seconds(60.0));
  EXPECT_NEAR(static_cast<double>(found[0].value), 300'000.0, 50'000.0);
}

TEST_F(NormalOperation, SafeModeUnderMoreLossOrMoreDelayIsLegal) {
  EXPECT_THAT(run(60.0, 8, 1.5, safe_from_20), IsEmpty());
  EXPECT_THAT(run(60.0, 0, 2.1, safe_from_20), IsEmpty());
}

TEST_F(NormalOperation, TheContractsOwnLimitsAreWithinIt) {
  EXPECT_THAT(kinds_of(run(60.0, 4, 2.0, safe_from_20)), ElementsAre(SafeModeInContract));
}

TEST_F(NormalOperation, AnAgentMayTakeItsTimeToLeaveSafeMode) {
  // All is lost up to 20 s, nothing later: safe mode is legal until the bad seconds have left the window, and for the
  // reaction time from then on.
  const auto quiet_later = [&](double reaction_s) {
    scenario_.law.reaction_s = reaction_s;
    Told told(scenario_, "normal-operation");
    told.record(5.0, 0, traced::SafeMode{true});
    for (int i = 0; i < 600; ++i) {
      const double t_s = 0.1 * i + 5.0;
      told.sends(t_s, 1, 0, static_cast<std::uint64_t>(i));
      told.reception(t_s, 0, t_s < 20.0 ? TraceKind::Lost : TraceKind::Received, 1, static_cast<std::uint64_t>(i));
    }
    return told.finish(65.0).incidents;
  };
  ASSERT_EQ(quiet_later(10.0).size(), 1U);
  EXPECT_GT(quiet_later(10.0)[0].first, at_seconds(30.0));
  EXPECT_EQ(quiet_later(20.0)[0].first, quiet_later(10.0)[0].first + std::chrono::seconds(10));
  EXPECT_THAT(quiet_later(50.0), IsEmpty());
}

TEST_F(NormalOperation, WhoWaitsForTheOperatorAfterAContactIsExcused) {
  for (const bool comes : {false, true}) {
    scenario_.operator_help.on = comes;
    const auto found = run(200.0, 1, 0.1, [](Told& told, int second) {
      if (second == 1) told.released(1.0, 0, 0).touches(1.0, 0, 1).appears(1.0, 99);
    });
    EXPECT_EQ(found.empty(), comes) << "the last of the records is about none of the fleet";
  }
}

TEST_F(NormalOperation, AFleetThatStandsWithOpenTransportsIsAccused) {
  scenario_.stuck_after = seconds(20.0);
  const auto order = [](Told& told, int second) {
    if (second == 3) told.released(3.0, 0, 0);
    if (second == 5) told.begins(5.0, 0, ActivityKind::Drive).ends(5.0, 0, ActivityKind::Drive);
  };
  const auto found = run(60.0, 3, 1.5, order);
  ASSERT_THAT(kinds_of(found), ElementsAre(StandstillInContract));
  EXPECT_EQ(found[0].first, at_seconds(5.0));
  EXPECT_EQ(found[0].value, 1);
  EXPECT_THAT(run(60.0, 8, 1.5, order), IsEmpty()) << "outside the contract standing still is legal";
  EXPECT_THAT(run(24.0, 3, 1.5, order), IsEmpty()) << "not yet";
  EXPECT_THAT(run(60.0, 3, 1.5, nothing), IsEmpty()) << "no order is open";
}

TEST_F(NormalOperation, AFleetThatChargesStandsForAReason) {
  scenario_.stuck_after = seconds(20.0);
  for (const bool charges : {true, false}) {
    const auto found = run(60.0, 3, 1.5, [&](Told& told, int second) {
      if (second == 3) told.released(3.0, 0, 0);
      if (second == 5) told.begins(5.0, 0, charges ? ActivityKind::Charge : ActivityKind::Park);
    });
    EXPECT_EQ(found.empty(), charges);
  }
}

TEST_F(NormalOperation, TooFewTransportsAreAccusedOnlyIfAFloorIsSet) {
  scenario_.stuck_after = seconds(1000.0);
  const auto order = [](Told& told, int second) {
    if (second == 3) told.released(3.0, 0, 0).released(3.0, 0, 1);
    if (second == 40) told.done(40.0, 0, 0);
  };
  EXPECT_THAT(run(60.0, 3, 1.5, order), IsEmpty());
  scenario_.law.min_transports_per_agv_hour = 31.0;  // one of two AGVs in a minute: 30
  const auto found = run(60.0, 3, 1.5, order);
  ASSERT_THAT(kinds_of(found), ElementsAre(ThroughputBelowFloor));
  EXPECT_EQ(found[0].value, 30'000);
  scenario_.law.min_transports_per_agv_hour = 29.0;
  EXPECT_THAT(run(60.0, 3, 1.5, order), IsEmpty());
}

}  // namespace
}  // namespace fleetproof::test::normal_operation_law_test
