// Ten thousand campaigns with a known rate: how often a gate calls software good that is exactly at the limit. What the
// gates do keeps its promise; what is often done instead does not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "reports/evidence/gate_bounds.hpp"
#include "reports/evidence/gate_table.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/reports/synthetic_campaigns.hpp"

namespace fleetproof::synthetic_campaigns_test {
namespace {

using synthetic::kConfidence;
using synthetic::kLimit;
using synthetic::most_by_chance;
using synthetic::share_of;
constexpr std::uint64_t kWorlds = 400;

GateRecord gate(GateMethod method) {
  GateRecord gate;
  gate.agent = "sound";
  gate.method = method;
  gate.limit = kLimit;
  gate.confidence = kConfidence;
  return gate;
}

// Whether each world of a campaign fails.
class Worlds {
 public:
  Worlds(std::uint64_t campaign, double rate, std::uint64_t topic = 1) {
    Draws draws(campaign, static_cast<std::uint32_t>(topic));
    for (std::uint64_t i = 0; i < kWorlds; ++i) failed_.push_back(synthetic::uniform(draws) < rate);
  }
  bool failed(std::uint64_t world) const { return failed_[world]; }

 private:
  std::vector<bool> failed_;
};

using Rule = std::function<bool(std::uint64_t failing, std::uint64_t worlds)>;

// The rule is asked after every world; the campaign stops as soon as it passes.
bool ever_passes(const Worlds& worlds, const Rule& rule, std::uint64_t most = kWorlds) {
  std::uint64_t failing = 0;
  for (std::uint64_t n = 1; n <= most; ++n) {
    failing += worlds.failed(n - 1) ? 1 : 0;
    if (rule(failing, n)) return true;
  }
  return false;
}

std::uint64_t failing_of(const Worlds& worlds, std::uint64_t n) {
  std::uint64_t failing = 0;
  for (std::uint64_t i = 0; i < n; ++i) failing += worlds.failed(i) ? 1 : 0;
  return failing;
}

const Rule kAnyTime = [](std::uint64_t failing, std::uint64_t worlds) {
  static const GateTable table = gate_table(gate(GateMethod::AnyTime), {1}, kWorlds);
  return passes(table, failing, worlds);
};
const Rule kClopperPearson = [](std::uint64_t failing, std::uint64_t worlds) {
  static const std::vector<std::uint64_t> needed = [] {
    std::vector<std::uint64_t> list;
    for (std::uint64_t k = 0; k <= kWorlds; ++k) list.push_back(*units_needed(k, kLimit, kConfidence));
    return list;
  }();
  return worlds >= needed[failing];
};
const Rule kWald = [](std::uint64_t failing, std::uint64_t worlds) {
  const double rate = static_cast<double>(failing) / static_cast<double>(worlds);
  return worlds >= 10 && rate + 1.645 * std::sqrt(rate * (1.0 - rate) / static_cast<double>(worlds)) <= kLimit;
};

TEST(SyntheticCampaigns, AnyTimeGatesKeepTheirRiskHoweverTheyAreWatched) {
  const double most = most_by_chance();
  for (const double rate : {kLimit, 1.2 * kLimit}) {
    EXPECT_LE(share_of([&](std::uint64_t c) { return ever_passes(Worlds(c, rate), kAnyTime); }), most) << rate;
    // Stopped for another reason, looked at, extended, looked at again.
    EXPECT_LE(share_of([&](std::uint64_t c) {
                const Worlds worlds(c, rate);
                const std::uint64_t first = 30 + c % 100;
                return kAnyTime(failing_of(worlds, first), first) || ever_passes(worlds, kAnyTime, 3 * first);
              }),
              most);
  }
}

TEST(SyntheticCampaigns, AnyTimeGatesPassGoodSoftware) {
  EXPECT_GT(share_of([](std::uint64_t c) { return ever_passes(Worlds(c, kLimit / 10.0), kAnyTime); }), 0.99);
}

TEST(SyntheticCampaigns, AnyTimeRefutationsKeepTheirRisk) {
  const GateTable table = gate_table(gate(GateMethod::AnyTime), {1}, kWorlds);
  const Rule refuted = [&](std::uint64_t failing, std::uint64_t worlds) { return refutes(table, failing, worlds); };
  EXPECT_LE(share_of([&](std::uint64_t c) { return ever_passes(Worlds(c, kLimit), refuted); }), most_by_chance());
  EXPECT_GT(share_of([&](std::uint64_t c) { return ever_passes(Worlds(c, 3.0 * kLimit), refuted); }), 0.99);
}

TEST(SyntheticCampaigns, TheIntervalHoldsTheTruthAtAllNumbersAtOnce) {
  for (const double rate : {0.02, kLimit, 0.5}) {
    // Bounds by number of worlds and failures, computed once.
    std::vector<std::vector<RateInterval>> bounds(201);
    for (std::uint64_t n = 1; n <= 200; ++n) {
      for (std::uint64_t k = 0; k <= n; ++k) bounds[n].push_back(gate_interval_95(gate(GateMethod::AnyTime), k, n));
    }
    const double missed = share_of([&](std::uint64_t c) {
      return ever_passes(
          Worlds(c, rate),
          [&](std::uint64_t k, std::uint64_t n) { return rate < bounds[n][k].lower || rate > bounds[n][k].upper; },
          200);
    });
    EXPECT_LE(missed, most_by_chance()) << rate;
  }
}

TEST(SyntheticCampaigns, AFixedGateKeepsItsRiskOnlyAtThePlannedNumber) {
  EXPECT_LE(share_of([](std::uint64_t c) {
              const Worlds worlds(c, kLimit);
              return kClopperPearson(failing_of(worlds, kWorlds), kWorlds);
            }),
            most_by_chance());
  EXPECT_GT(share_of([](std::uint64_t c) { return ever_passes(Worlds(c, kLimit), kClopperPearson); }), 0.10)
      << "watched after every world";
}

TEST(SyntheticCampaigns, WaldPassesBadSoftware) {
  EXPECT_GT(share_of([](std::uint64_t c) { return ever_passes(Worlds(c, kLimit), kWald); }), 0.30);
}

TEST(SyntheticCampaigns, AnotherSeedUntilItPassesIsNoEvidence) {
  EXPECT_GT(share_of([](std::uint64_t c) {
              for (std::uint64_t seed = 1; seed <= 10; ++seed) {
                const Worlds worlds(c, kLimit, seed);
                if (kClopperPearson(failing_of(worlds, kWorlds), kWorlds)) return true;
              }
              return false;
            }),
            0.20);
}

// A world fails in all of its twelve cells or in none: the runs are not independent.
TEST(SyntheticCampaigns, RunsOfCellsThatShareWorldsAreNoUnits) {
  constexpr std::uint64_t kCells = 12;
  const std::uint64_t needed = *units_needed(0, kLimit, kConfidence);  // runs without a failure
  const auto pooled = [&](std::uint64_t c) {
    const Worlds worlds(c, kLimit);
    return failing_of(worlds, (needed + kCells - 1) / kCells) == 0;
  };
  EXPECT_GT(share_of(pooled), 0.50);
}

// Failing runs take ten times as long. Whoever takes runs as they finish sees the good ones first.
TEST(SyntheticCampaigns, OrderOfFinishingIsNotOrderOfRuns) {
  constexpr std::uint64_t kWorkers = 32;
  const std::uint64_t needed = *units_needed(0, kLimit, kConfidence);
  const auto first_finished_are_clean = [&](std::uint64_t c) {
    const Worlds worlds(c, kLimit);
    using Finish = std::pair<double, std::uint64_t>;  // time, world
    std::priority_queue<Finish, std::vector<Finish>, std::greater<>> under_way;
    std::uint64_t next = 0, clean = 0;
    const auto begin = [&](double now) {
      if (next < kWorlds) under_way.emplace(now + (worlds.failed(next) ? 10.0 : 1.0), next), ++next;
    };
    for (std::uint64_t worker = 0; worker < kWorkers; ++worker) begin(0.0);
    while (!under_way.empty()) {
      const auto [now, world] = under_way.top();
      under_way.pop();
      if (worlds.failed(world)) return false;
      if (++clean == needed) return true;
      begin(now);
    }
    return false;
  };
  EXPECT_GT(share_of(first_finished_are_clean), 0.30);
}

// The decisions above are those of a report.
TEST(SyntheticCampaigns, EvidenceDecidesByTheSameTable) {
  for (std::uint64_t c = 0; c < 40; ++c) {
    const Worlds worlds(c, 0.04);
    CampaignRecord campaign = samples::campaign_of("claim", kWorlds);
    campaign.required_probes.clear();
    Evidence evidence({campaign, samples::grid({"sound"}, {0.4}, {2.0}), {gate(GateMethod::AnyTime)}});
    std::uint64_t failing = 0;
    for (std::uint64_t n = 1; n <= 120; ++n) {
      RunRecord run = samples::clean_run(n - 1, 1);
      if (worlds.failed(n - 1)) samples::violate(run);
      failing += worlds.failed(n - 1) ? 1 : 0;
      evidence.add(run);
      EXPECT_EQ(evidence.judge(0).verdict == Verdict::Demonstrated, kAnyTime(failing, n)) << failing << " of " << n;
    }
  }
}

}  // namespace
}  // namespace fleetproof::synthetic_campaigns_test
