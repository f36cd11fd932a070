#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::views_test {
namespace {

using samples::TemporaryFolder;

// One row as text, columns separated by "|".
std::string query(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY, nullptr);
  std::string row;
  const auto append = [](void* out, int count, char** values, char**) {
    auto& text = *static_cast<std::string*>(out);
    for (int i = 0; i < count; ++i)
      text += (text.empty() ? "" : "|") + std::string(values[i] == nullptr ? "null" : values[i]);
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), append, &row, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  sqlite3_close(db);
  return row;
}

class Views : public testing::Test {
 protected:
  Views() {
    RunRecord run;
    ArchiveWriter writer(path_, samples::plan());
    for (std::uint32_t i = 0; i < 12; ++i) {
      run.run_index = i;
      run.cell = i % 6;
      run.replicate = i / 6;
      run.factors = samples::cells()[run.cell].lowest;
      run.outcome = Outcome{};
      run.outcome.simulated_ns = 3'600'000'000'000;
      run.outcome.agv_count = 5;
      run.outcome.counters.transports_done = 2;
      if (i == 4) {  // loss 0.4, delay 2 s
        run.scenario_digest = 0xff;
        run.outcome.digest = 0xfedcba9876543210ULL;
        Violation violation;
        violation.a = EntityId{1u};
        violation.b = EntityId{3u};
        violation.first = at_seconds(1.5);
        violation.min_clearance_um = 70'000;
        file_violations(run.outcome, {violation});
        file_incidents(run.outcome, {{IncidentKind::Deadlock, EntityId{2u}, {}, at_seconds(3.0), at_seconds(9.0), 2}});
        file_probes(run.outcome, {{ProbeSource::World, "head-on", 3}, {ProbeSource::Agent, "negotiation", 17}});
      }
      writer.add(run);
    }
    writer.publish(12);
  }
  TemporaryFolder folder_;
  std::string path_ = folder_ / "a.fp";
};

TEST_F(Views, v1_runs_joins_the_factors_of_the_cell) {
  EXPECT_EQ(query(path_,
                  "SELECT agent, layout, fleet_size, loss, delay_s, in_contract, outcome_class, violation, contact, "
                  "min_clearance_um, transports_done, digest, "
                  "scenario_digest FROM v1_runs WHERE run_index = 4"),
            "sound|ring|5|0.4|2.0|1|violation|1|0|70000|2|fedcba9876543210|00000000000000ff");
  EXPECT_EQ(query(path_, "SELECT outcome_class, min_clearance_um, in_contract FROM v1_runs WHERE run_index = 5"),
            "clean|null|0");
}

TEST_F(Views, v1_cells_counts) {
  EXPECT_EQ(query(path_,
                  "SELECT is_worst_case, runs, violation_runs, contact_runs, min_clearance_um, transports_done, "
                  "agv_hours FROM v1_cells WHERE cell = 4"),
            "1|2|1|0|70000|4|10.0");
}

TEST_F(Views, v1_violations_tells_where_it_happened) {
  EXPECT_EQ(query(path_,
                  "SELECT run_index, ordinal, loss, delay_s, entity_a, entity_b, first_ns, min_clearance_um FROM "
                  "v1_violations"),
            "4|0|0.4|2.0|1|3|1500000000|70000");
}

TEST_F(Views, v1_violations_tells_level_and_kind_of_entities) {
  EXPECT_EQ(query(path_, "SELECT level, entities FROM v1_violations"), "safety distance broken|AGV-AGV");
}

TEST_F(Views, v1_incidents_names_kind_and_unit) {
  EXPECT_EQ(query(path_,
                  "SELECT run_index, ordinal, agent, in_contract, kind, entity_a, entity_b, first_ns, last_ns, value, "
                  "unit FROM v1_incidents"),
            "4|0|sound|1|deadlock|2|null|3000000000|9000000000|2|AGVs in the circle; 0: no circle known");
}

TEST_F(Views, v1_probes_tells_what_was_met) {
  EXPECT_EQ(query(path_, "SELECT run_index, agent, loss, source, name, count FROM v1_probes ORDER BY name"),
            "4|sound|0.4|world|head-on|3|4|sound|0.4|agent|negotiation|17");
}

TEST_F(Views, runs_have_the_quality_they_drew_and_cells_their_bounds) {
  TemporaryFolder folder;
  const std::string path = folder / "drawn.fp";
  auto campaign = samples::campaign();
  campaign.sampling = "uniform";
  const std::vector<CellRecord> cells{{0, "sound", "ring", 5, {0.0, 1.0, 0.5, 0.001}, {0.8, 2.0, 2.5, 0.016}},
                                      {1, "sound", "ring", 5, {0.0, 0.0, 0.0}, {0.4, 2.0, 0.0}}};
  ArchiveWriter writer(path, {campaign, cells, samples::gates()});
  RunRecord run;
  run.factors = {0.125, 1.5, 0.75};
  writer.add(run);
  run.run_index = run.cell = 1;
  run.factors = {0.4, 2.0, 0.0};
  writer.add(run);
  run = {2, 0, 1, 0, {0.75, 1.25, 0.5, 0.004}, {}};
  file_violations(run.outcome, {Violation{}});
  writer.add(run);
  writer.publish(3);
  EXPECT_EQ(query(path,
                  "SELECT loss, loss_to, delay_s, delay_to_s, mean_outage_s, mean_outage_to_s, in_contract, "
                  "is_worst_case FROM v1_cells WHERE cell = 0"),
            "0.0|0.8|1.0|2.0|0.5|2.5|0|0");
  EXPECT_EQ(query(path, "SELECT in_contract, is_worst_case FROM v1_cells WHERE cell = 1"), "1|0");
  EXPECT_EQ(query(path, "SELECT loss, delay_s, mean_outage_s, in_contract FROM v1_runs"),
            "0.125|1.5|0.75|1|0.4|2.0|0.0|1|0.75|1.25|0.5|0");
  EXPECT_EQ(query(path, "SELECT loss, delay_s, mean_outage_s, in_contract FROM v1_violations"), "0.75|1.25|0.5|0");
  EXPECT_EQ(query(path, "SELECT call_cost_s, call_cost_to_s FROM v1_cells"), "0.001|0.016|0.0|0.0");
  EXPECT_EQ(query(path, "SELECT call_cost_s FROM v1_runs"), "0.0|0.0|0.004");
  EXPECT_EQ(query(path, "SELECT call_cost_s FROM v1_violations"), "0.004");
  const ArchiveReader reader(path);
  EXPECT_EQ(reader.cells(), cells);
  EXPECT_EQ(reader.campaign(), campaign);
  EXPECT_EQ(reader.run(2)->factors, (FactorValues{0.75, 1.25, 0.5, 0.004}));
}

TEST_F(Views, the_dictionary_has_every_column_of_every_view_once) {
  const std::string columns =
      "(SELECT s.name AS view, c.name AS column FROM sqlite_schema s JOIN pragma_table_info(s.name) "
      "c WHERE s.type = 'view')";
  const std::string words = "(SELECT view_name, column_name FROM v1_dictionary)";
  EXPECT_EQ(query(path_, "SELECT * FROM " + columns + " EXCEPT SELECT * FROM " + words), "") << "no meaning";
  EXPECT_EQ(query(path_, "SELECT * FROM " + words + " EXCEPT SELECT * FROM " + columns), "") << "no such column";
  EXPECT_EQ(query(path_, "SELECT view_name, column_name FROM v1_dictionary GROUP BY 1, 2 HAVING count(*) > 1"), "");
  EXPECT_EQ(query(path_, "SELECT column_name FROM v1_dictionary WHERE length(meaning) < 3 OR unit = ''"), "");
  EXPECT_GT(std::stoi(query(path_, "SELECT count(*) FROM v1_dictionary")), 150);
}

TEST_F(Views, the_dictionary_tells_how_runs_are_judged) {
  const std::string rule =
      query(path_, "SELECT meaning FROM v1_dictionary WHERE view_name = 'v1_runs' AND column_name = 'failed'");
  for (const char* words : {"before the first contact", "fallen load", "unknown"})
    EXPECT_THAT(rule, testing::HasSubstr(words));
}

TEST_F(Views, say_how_a_run_is_judged_beside_its_flags) {
  EXPECT_EQ(query(path_, "SELECT violation, failed, judged FROM v1_runs WHERE run_index = 4"),
            "1|violation deadlock|failed");
  EXPECT_EQ(query(path_, "SELECT DISTINCT judged FROM v1_runs WHERE run_index <> 4"), "passed");
  EXPECT_EQ(query(path_, "SELECT run_failed FROM v1_violations"), "violation deadlock");
  EXPECT_EQ(query(path_, "SELECT kind, end_point, run_failed FROM v1_incidents"),
            "deadlock|deadlock|violation deadlock");
  EXPECT_EQ(query(path_, "SELECT sum(failed_runs), sum(deadlock_failed_runs), sum(contact_failed_runs) FROM v1_cells"),
            "1|1|0");
}

// Software that is told of no fallen load does not answer for one: the flags say what happened, and failed what counts.
TEST(ViewsOfJudgedRuns, AContactWithAFallenLoadFailsNothing) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fp";
  RunRecord run;
  run.outcome.agv_count = 2;
  run.outcome.simulated_ns = 1'000'000'000;
  Violation violation;
  violation.a = EntityId{1u};
  violation.b = EntityId{2u};  // behind the AGVs: a load or an obstacle
  violation.contact = true;
  file_violations(run.outcome, {violation});
  run.factors = samples::cells()[0].lowest;
  {
    ArchiveWriter writer(path, samples::plan());
    writer.add(run);
    writer.commit();
  }
  const std::string live = path + ".partial";
  EXPECT_EQ(query(live, "SELECT violation, contact, failed, judged FROM v1_runs"), "1|1||unknown");
  EXPECT_THAT(query(live, "SELECT run_failed, run_unknown FROM v1_violations"),
              testing::HasSubstr("violation contact"));
  EXPECT_EQ(query(live, "SELECT violation_runs, failed_runs, unknown_runs FROM v1_cells WHERE cell = 0"), "1|0|1");
  EXPECT_EQ(
      query(live,
            "SELECT contact_failed_runs, contact_unknown_runs, violation_unknown_runs, deadlock_unknown_runs FROM "
            "v1_cells WHERE cell = 0"),
      "0|1|1|1")
      << "who touches something stands there";
}

// An audit that failed where the run had passed.
TEST(ViewsOfJudgedRuns, AnAuditIsJudgedByItself) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fp";
  RunRecord run;
  run.outcome.agv_count = 2;
  run.outcome.simulated_ns = 1'000'000'000;
  run.factors = samples::cells()[0].lowest;
  RunRecord again = run;
  Violation violation;
  violation.a = EntityId{0u};
  violation.b = EntityId{1u};
  file_violations(again.outcome, {violation});
  {
    ArchiveWriter writer(path, samples::plan());
    writer.add(run);
    writer.add(AuditRecord{0, 7, audited_outcome(again)});
    writer.commit();
  }
  const std::string live = path + ".partial";
  EXPECT_EQ(query(live, "SELECT judged, failed FROM v1_runs"), "passed|");
  EXPECT_EQ(query(live, "SELECT same, failed, judged, violations FROM v1_audits"), "0|violation|failed|1");
}

TEST_F(Views, the_file_names_its_kind_and_version) {
  EXPECT_EQ(query(path_, "PRAGMA application_id"), std::to_string(0x464C5046));
  EXPECT_EQ(query(path_, "PRAGMA user_version"), "14");
  EXPECT_EQ(query(path_, "PRAGMA page_size"), "4096");
  EXPECT_EQ(query(path_, "PRAGMA journal_mode"), "delete");
  EXPECT_EQ(query(path_, "PRAGMA integrity_check"), "ok");
}

}  // namespace
}  // namespace fleetproof::views_test
