// Every figure of the text and the HTML page, counted again by a program of its own (tests/recount).
#include <gmock/gmock.h>

#include "tests/support/program.hpp"
#include "tests/support/synthetic_archive.hpp"

namespace fleetproof::recount_test {
namespace {

using samples::campaign_of;
using samples::gates_of_every_kind;
using samples::grid;

class Recount : public test::ProgramTest {
 protected:
  test::Finished recount() const {
    return shell(
        "\"$FLEETPROOF\" report a.db --exit-zero >page.txt && \"$FLEETPROOF\" report a.db --exit-zero --html "
        "page.html " +
        options_ + " && python3 -B '" + test::source("tests/recount/recount.py") + "' a.db page.txt page.html");
  }
  void expect_same() const {
    const auto finished = recount();
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    EXPECT_EQ(finished.out, "\nno difference\n");
  }
  // Each change of pages that are right is a difference.
  void expect_noticed(const std::vector<std::string>& changes) const {
    std::string make = "set -e\n", folders;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const std::string folder = std::to_string(i);
      make += "mkdir " + folder + "; cp page.txt page.html " + folder + "; (cd " + folder + "; " + changes[i] + ")\n";
      folders += " " + folder;
    }
    ASSERT_EQ(shell(make).exit_code, 0);
    const auto finished =
        shell("python3 -B '" + test::source("tests/recount/recount.py") + "' a.db --each ." + folders);
    EXPECT_THAT(finished.out, testing::StartsWith(".: no difference\n")) << finished.err;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      EXPECT_THAT(finished.out, testing::ContainsRegex("\n" + std::to_string(i) + ": [0-9]+ differences\n"))
          << changes[i];
    }
  }
  void write_archive(const CampaignRecord& campaign, const std::vector<CellRecord>& cells,
                     const std::vector<GateRecord>& gates, std::uint64_t runs, double trouble = 0.1) const {
    samples::write_archive(path("a.db"), campaign, cells, gates, runs, trouble);
  }

  std::string options_;  // of the HTML page
};

// 2 agents, 2 layouts, 2 fleet sizes, losses and delays, and outages in half of the cells.
std::vector<CellRecord> many_cells(std::size_t losses, std::size_t delays) {
  std::vector<CellRecord> cells;
  for (const char* agent : {"sound", "odd"}) {
    for (const char* layout : {"ring", "cross"}) {
      for (const std::uint32_t fleet : {3u, 8u}) {
        for (std::size_t i = 0; i < losses * delays; ++i) {
          CellRecord cell;
          cell.index = static_cast<std::uint32_t>(cells.size());
          cell.agent = agent;
          cell.layout = layout;
          cell.fleet_size = fleet;
          cell.lowest[Factor::Loss] = 0.2 * static_cast<double>(i / delays);
          cell.lowest[Factor::Delay] = 0.5 * static_cast<double>(i % delays);
          cell.lowest[Factor::MeanOutage] = i % delays == 1 ? 0.5 : 0.0;
          cell.highest = cell.lowest;
          cells.push_back(cell);
        }
      }
    }
  }
  return cells;
}

TEST_F(Recount, NoRuns) {
  write_archive(campaign_of("claim", 3), grid({"sound"}, {0.4}, {2.0}), gates_of_every_kind("sound", "ring"), 0);
  expect_same();
}
TEST_F(Recount, OneRun) {
  write_archive(campaign_of("claim", 1), grid({"sound"}, {0.4}, {2.0}), gates_of_every_kind("sound", "ring"), 1);
  expect_same();
}
TEST_F(Recount, OneCell) {
  write_archive(campaign_of("claim", 300), grid({"sound"}, {0.4}, {2.0}), gates_of_every_kind("sound", "ring"), 300);
  expect_same();
}
TEST_F(Recount, NothingWentWrong) {
  write_archive(campaign_of("claim", 300), grid({"sound"}, {0.0, 0.4}, {1.0, 2.0}),
                gates_of_every_kind("sound", "ring"), 1200, 0.0);
  expect_same();
}
TEST_F(Recount, EveryRunFailed) {
  write_archive(campaign_of("claim", 40), grid({"sound"}, {0.4}, {1.0, 2.0}), gates_of_every_kind("sound", "ring"), 80,
                1.0);
  expect_same();
}
TEST_F(Recount, OnlyCrashes) {
  const auto cells = grid({"sound"}, {0.4}, {1.0, 2.0});
  {
    ArchiveWriter writer(path("a.db"),
                         {samples::with_length(campaign_of("claim", 30)), cells, gates_of_every_kind("sound", "ring")});
    for (std::uint64_t i = 0; i < 60; ++i) {
      auto run = samples::clean_run(i, cells.size());
      run.factors = cells[run.cell].lowest;
      run.outcome.crash = true;
      run.outcome.message = "agent of AGV 0 threw an exception";
      if (i < 4) run.outcome.simulated_ns = 0;  // nothing is known of these runs
      writer.add(run);
    }
    writer.publish(60);
  }
  expect_same();
}
TEST_F(Recount, FourHundredCellsOfAnUnfinishedCampaign) {
  const auto cells = many_cells(5, 10);
  ASSERT_EQ(cells.size(), 400u);
  write_archive(campaign_of("claim", 20), cells, gates_of_every_kind("sound", "cross"), 12 * cells.size() + 37);
  expect_same();
}
TEST_F(Recount, ASearch) {
  write_archive(campaign_of("search", 20), many_cells(3, 6), gates_of_every_kind("sound", "cross"), 2'000);
  expect_same();
}
// Some gates leave a part of the cell open, and some name a cell that is outside of their region.
TEST_F(Recount, GatesThatNameTheirCells) {
  const auto cells = many_cells(3, 4);
  std::vector<GateRecord> gates;
  for (const CellRecord& cell : cells) {
    if (cell.index % 5 != 0) continue;
    auto gate = gates_of_every_kind(cell.agent, "").at(gates.size() % 12);
    gate.index = static_cast<std::uint32_t>(gates.size());
    gate.name = "cell " + std::to_string(cell.index);
    if (cell.index % 2 == 0) gate.where.layout = cell.layout;
    if (cell.index % 3 != 1) gate.where.fleet_size = cell.fleet_size;
    for (const FactorInfo& factor : kFactors) {
      if (cell.index % 7 != 0 || factor.id == Factor::MeanOutage)
        gate.where.factors[factor.id] = cell.lowest[factor.id];
    }
    gates.push_back(gate);
  }
  write_archive(campaign_of("claim", 40), cells, gates, 40 * cells.size());
  expect_same();
}
TEST_F(Recount, ACampaignThatWasRun) {
  write("a.toml",
        "replicates = 8\nhorizon_s = 200\n[factors]\nagents = [{ agent = \"hull-lock\", role = \"candidate\" }, "
        "\"timeout-grant\", \"reckless\"]\nlayouts = [\"aisle-grid\", \"loop-spurs\"]\nfleet_sizes = [3, 5]\n"
        "loss = [0.0, 0.4, 0.6]\ndelay_s = [0, 2]\n[world]\ntransports_per_agv_hour = 60\n");
  run("run a.toml --db a.db");
  expect_same();
}

// Paired, and with another seed not paired.
TEST_F(Recount, AComparisonWithABaseline) {
  auto campaign = campaign_of("claim", 60);
  const auto cells = many_cells(2, 3);
  const auto gates = gates_of_every_kind("sound", "cross");
  samples::write_archive(path("old.db"), campaign, cells, gates, 60 * cells.size(), 0.01);
  write_archive(campaign, cells, gates, 55 * cells.size(), 0.05);
  const std::string compared =
      "\"$FLEETPROOF\" report a.db --exit-zero --baseline old.db >page.txt && \"$FLEETPROOF\" report a.db "
      "--exit-zero --baseline old.db --html page.html && python3 -B '" +
      test::source("tests/recount/recount.py") + "' a.db page.txt page.html old.db";
  const auto paired = shell(compared);
  EXPECT_EQ(paired.out, "\nno difference\n") << paired.err;
  EXPECT_THAT(read(path("page.html")), testing::HasSubstr("both ran in the same 55 worlds"));
  std::filesystem::remove(path("old.db"));
  campaign.seed += 1;
  samples::write_archive(path("old.db"), campaign, cells, gates, 60 * cells.size(), 0.01);
  const auto unpaired = shell(compared);
  EXPECT_EQ(unpaired.out, "\nno difference\n") << unpaired.err;
  EXPECT_THAT(read(path("page.html")), testing::HasSubstr("drawn from other seeds"));
}

// The control: one figure that is off by one, in each kind of place.
TEST_F(Recount, NoticesOneFigureThatIsOff) {
  write_archive(campaign_of("claim", 12), many_cells(3, 4), gates_of_every_kind("sound", "cross"), 12 * 96);
  expect_same();
  expect_noticed({"sed -i -E '0,/(\\[[0-9.]+ %, )/s//\\19/' page.txt",
                  "sed -i -E 's/(Guaranteed envelope: shown in )([0-9]+)/\\19\\2/' page.html",
                  "sed -i -E 's/(of a row by itself is )/\\19/' page.html",
                  "sed -i -E 's/(a field shows at most )/\\19/' page.html",
                  "sed -i -E '0,/sound +all +contract +([0-9]+)/s//sound  all  contract  1\\1/' page.txt",
                  "sed -i -E '0,/(run [0-9]+: contact.*at )[0-9]/s//\\19/' page.txt",
                  "sed -i -E 's/([0-9]+)\\/12<\\/text>/\\1\\/13<\\/text>/' page.html",
                  "sed -i -E 's/judged, 12 of/judged, 11 of/' page.html",
                  "sed -i -E 's/the last new one in run ([0-9]+) of/the last new one in run 1\\1 of/' page.html",
                  "sed -i -E 's/<p>Runs with an unknown/<p>In 17 runs of 18. Runs with an unknown/' page.html",
                  "sed -i -E '0,/upper 95 %/s//upper 98 %/' page.txt",
                  "sed -i -E 's/unless the scenario/, 7, unless the/' page.txt",
                  "sed -i -E 's/(plan digest: )[0-9a-f]/\\1g/' page.txt",
                  "sed -i -E 's/seed ([0-9]+)/seed 9\\1/' page.txt"});
}

// Of what the page says about the plan. `\\1` and a figure that is not there.
TEST_F(Recount, NoticesOneConditionThatIsOff) {
  write("a.toml",
        "replicates = 3\nhorizon_s = 120\n[factors]\nagents = [{ agent = \"hull-lock\", role = \"candidate\" }, "
        "{ agent = \"reckless\", name = \"wild\" }]\nlayouts = [\"aisle-grid\", \"loop-spurs\"]\nfleet_sizes = [3, 5]\n"
        "loss = [0.0, 0.4]\ndelay_s = { from = 0.5, to = 1.5 }\nmean_outage_s = [0.0, 1.5]\n[world]\n"
        "transports_per_agv_hour = 60\n[law]\nsafety_distance_m = 0.125\n[radio]\nrange_m = 45\nduplicates = 0.05\n"
        "[vehicle]\nlength_m = 2.0\n[faults]\nfreezes_per_agv_hour = 12\nlow_battery_share = 0.25\n");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
  options_ = "--no-film";
  expect_same();
  std::vector<std::string> changes;
  for (const std::string change :
       {"s/(Safety distance: 0.12)5/\\14/", "s/(Loss: 0, )40/\\150/", "s/(Delay: 0.5 to )1.5/\\12.5/",
        "s/(Mean outage: 0, )1.5/\\11.6/", "s/(range )45/\\146/", "s/(duplicates )5/\\16/",
        "s/(Layouts: a)isle/\\1cme/", "s/(Fleet sizes: 3, )5/\\16/", "s/2 m x 1 m, 2/2 m x 1 m, 3/",
        "s/(orders\\): )60/\\161/", "s/(freezes per agv hour )12/\\113/", "s/(Horizon of a run: )120/\\1121/",
        "s/(test conditions\\): )32/\\133/", "s/(distance of )0.125/\\10.124/",
        "0,/mean outage = 1.5/s//mean outage = 1.6/", "0,/fleets of 3/s//fleets of 4/",
        "0,/120 s a run/s//130 s a run/", "s/(a limit of )1 %/\\12 %/"}) {
    changes.push_back("sed -i -E '" + change + "' page.txt");
  }
  for (const std::string change :
       {">0.125 m/>0.126 m", "range 45/range 46", "60 per AGV-hour/61 per AGV-hour", "120 s sim/121 s sim"})
    changes.push_back("sed -i -E 's/" + change + "/' page.html");
  expect_noticed(changes);
}

}  // namespace
}  // namespace fleetproof::recount_test
