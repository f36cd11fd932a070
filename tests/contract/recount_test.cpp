// Every figure of the text and the HTML page, counted again by a program of its own (tests/recount).
#include <gmock/gmock.h>

#include "tests/support/program.hpp"
#include "tests/support/synthetic_archive.hpp"

namespace fleetproof {
namespace {

using samples::campaign_of;
using samples::gates_of_every_kind;
using samples::grid;

class Recount : public test::ProgramTest {
 protected:
  test::Finished recount(const std::string& change = "true") const {
    return shell(
        "\"$FLEETPROOF\" report a.db --exit-zero >page.txt && \"$FLEETPROOF\" report a.db --exit-zero --html "
        "page.html && " +
        change + " && python3 -B '" + test::source("tests/recount/recount.py") + "' a.db page.txt page.html");
  }
  void expect_same() const {
    const auto finished = recount();
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    EXPECT_EQ(finished.out, "\nno difference\n");
  }
  void write_archive(const CampaignRecord& campaign, const std::vector<CellRecord>& cells,
                     const std::vector<GateRecord>& gates, std::uint64_t runs, double trouble = 0.1) const {
    samples::write_archive(path("a.db"), campaign, cells, gates, runs, trouble);
  }
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
    ArchiveWriter writer(path("a.db"), campaign_of("claim", 30), cells, gates_of_every_kind("sound", "ring"));
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
  EXPECT_THAT(read(path("page.txt")), testing::HasSubstr("paired, because both ran in the same 55 worlds"));
  std::filesystem::remove(path("old.db"));
  campaign.seed += 1;
  samples::write_archive(path("old.db"), campaign, cells, gates, 60 * cells.size(), 0.01);
  const auto unpaired = shell(compared);
  EXPECT_EQ(unpaired.out, "\nno difference\n") << unpaired.err;
  EXPECT_THAT(read(path("page.txt")), testing::HasSubstr("not paired: the seeds differ"));
}

// The control: one figure that is off by one, in each kind of place.
TEST_F(Recount, NoticesOneFigureThatIsOff) {
  write_archive(campaign_of("claim", 12), many_cells(3, 4), gates_of_every_kind("sound", "cross"), 12 * 96);
  ASSERT_EQ(recount().out, "\nno difference\n");
  for (const char* change :
       {"sed -i -E '0,/(interval [0-9.]+ to )/s//\\19/' page.txt",
        "sed -i -E '0,/sound +all +contract +([0-9]+)/s//sound  all  contract  1\\1/' page.txt",
        "sed -i -E '0,/(run [0-9]+: contact.*at )[0-9]/s//\\19/' page.txt",
        "sed -i -E 's/([0-9]+)\\/12<\\/text>/\\1\\/13<\\/text>/' page.html",
        "sed -i -E 's/judged, 12 of/judged, 11 of/' page.html",
        "sed -i -E 's/the last new one in run ([0-9]+) of/the last new one in run 1\\1 of/' page.html",
        "sed -i -E 's/<p>Runs with an unknown/<p>In 17 runs of 18. Runs with an unknown/' page.html"}) {
    const auto finished = recount(std::string("cp page.txt t && cp page.html h && ") + change +
                                  " && ! (cmp -s t page.txt && cmp -s h page.html)");
    EXPECT_EQ(finished.exit_code, 1) << change << finished.out << finished.err;
    EXPECT_THAT(finished.out, testing::HasSubstr("difference")) << change;
  }
}

}  // namespace
}  // namespace fleetproof
