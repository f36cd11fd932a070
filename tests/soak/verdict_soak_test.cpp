// Software that is unsafe, many campaigns of it under many seeds, through the command line: none may be green.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::verdict_soak_test {
namespace {

int seeds() {
  const char* wanted = std::getenv("FLEETPROOF_SOAK_SEEDS");
  return wanted == nullptr ? 200 : std::atoi(wanted);
}

// `top`: lines before the first table. `agents`: with the name "ours" for the one under test.
struct Campaign {
  std::string agents = "{ agent = \"reckless\", name = \"ours\", role = \"candidate\" }", top{}, tables{};
  int replicates = 60;
  std::string gate = "limit = 0.2";
};

class VerdictSoak : public test::AuditedCampaign {
 protected:
  std::string text(const Campaign& campaign, int seed) const {
    return fmt::format(
        "seed = {}\nreplicates = {}\nhorizon_s = 120\n{}\n[factors]\nagents = [{}]\nlayouts = [\"aisle-grid\"]\n"
        "fleet_sizes = [3]\nloss = [0.4]\ndelay_s = [2]\n[world]\ntransports_per_agv_hour = 60\n[coverage]\n"
        "probes = []\n{}\n[[gate]]\nname = \"g\"\nagent = \"ours\"\nmin_transports_per_agv_hour = 0.5\n{}\n",
        seed, campaign.replicates, campaign.top, campaign.agents, campaign.tables, campaign.gate);
  }
  void expect_never_green(const Campaign& campaign, const std::string& options = "") {
    for (int seed = 1; seed <= seeds(); ++seed) {
      write("c.toml", text(campaign, seed));
      const auto finished = run("run c.toml --db c.db --overwrite " + options);
      EXPECT_TRUE(finished.exit_code == 1 || finished.exit_code == 4) << seed << ": " << finished.out << finished.err;
    }
  }
  static std::string unsteady_as_ours(const std::string& kind) {
    return fmt::format("{{ file = \"unsteady.so\", name = \"ours\", config = \"{}\" }}", kind);
  }
};

TEST_F(VerdictSoak, OneWorldManyTimes) {
  for (const char* replicate : {"0", "3", "17"}) {
    expect_never_green({.tables = fmt::format("[vary]\nhold = [\"layout\", \"placement\", \"transports\", \"motion\", "
                                              "\"radio\", \"agent\"]\nheld_replicate = {}",
                                              replicate)});
  }
}

TEST_F(VerdictSoak, CoinsThatFallOnceForTheNight) {
  for (const char* kind : {"coin-place", "coin-process", "coin-heap"})
    expect_never_green({.agents = unsteady_as_ours(kind)});
}

// One command, 22 times.
TEST_F(VerdictSoak, OneCommandAgainAndAgain) {
  for (const char* kind : {"coin-place", "coin-process", "coin-heap"}) {
    write("c.toml", text({.agents = unsteady_as_ours(kind), .replicates = 340, .gate = "limit = 0.01"}, 1));
    for (int time = 0; time < 22; ++time) EXPECT_NE(run("run c.toml --db c.db --overwrite").exit_code, 0) << kind;
  }
}

TEST_F(VerdictSoak, HoursOfAnyHazard) { expect_never_green({.gate = "limit = 1\nunit = \"agv-hour\""}); }

TEST_F(VerdictSoak, ANumberChosenAfterwards) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    write("c.toml", text({.gate = "limit = 0.2\nmethod = \"fixed\""}, seed));
    (void)run("run c.toml --db c.db --overwrite");
    const auto second = run("run c.toml --db c.db --overwrite --replicates 20");
    if (second.exit_code != 0) continue;
    EXPECT_NE(run("report c.db").out.find("attempts for this release: this one and"), std::string::npos) << seed;
  }
}

TEST_F(VerdictSoak, ACandidateWithoutAGate) {
  expect_never_green({.agents = "{ agent = \"hull-lock\", name = \"ours\", role = \"candidate\" }, { agent = "
                                "\"reckless\", name = \"theirs\", role = \"candidate\" }"});
}

TEST_F(VerdictSoak, OldReleasesThatCrash) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    Campaign old_release;
    old_release.agents = "{ file = \"failing.so\", name = \"ours\", config = \"abort 1\" }";
    old_release.replicates = 30;
    write("old.toml", text(old_release, seed));
    (void)run("run old.toml --db old.db --overwrite");
    write("new.toml", text({.replicates = 30}, seed));
    (void)run("run new.toml --db new.db --overwrite");
    EXPECT_NE(run("compare old.db new.db --margin 0.5 --fail-on-regression").exit_code, 0) << seed;
  }
}

TEST_F(VerdictSoak, AnotherNameIsNamed) {
  write("c.toml", text({}, 1));
  (void)run("run c.toml --db c.db");
  for (int time = 1; time <= seeds(); ++time) {
    Campaign renamed;
    renamed.agents =
        fmt::format("{{ agent = \"reckless\", name = \"ours\", config = \"{}\", role = \"candidate\" }}", time);
    write("c.toml", text(renamed, 1 + time));
    (void)run("run c.toml --db c.db --overwrite");
    EXPECT_NE(run("report c.db").out.find("at the same plan by other software"), std::string::npos) << time;
  }
}

}  // namespace
}  // namespace fleetproof::verdict_soak_test
