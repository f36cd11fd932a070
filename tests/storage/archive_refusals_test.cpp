#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/unprivileged.hpp"

namespace fleetproof::archive_refusals_test {
namespace {

using samples::TemporaryFolder;
using test::sentence_of;
using test::tamper;
using testing::HasSubstr;

void write_archive(const std::string& path, std::uint64_t runs = 60) {
  ArchiveWriter writer(path, samples::plan());
  for (const auto& run : samples::runs(runs)) writer.add(run);
  writer.publish(runs);
}

void read_everything(const std::string& path) {
  ArchiveReader(path).for_each_run([](const RunRecord&) {});
}

TEST(ArchiveReader, refuses_what_is_not_a_results_file) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& path) {
    return sentence_of<InputError>([&] { ArchiveReader reader(path); });
  };
  EXPECT_THAT(refusal(folder / "none.fp"), HasSubstr("there is no such file"));
  EXPECT_THAT(refusal(folder / "."), HasSubstr("folder"));
  samples::write_bytes(folder / "empty.fp", "");
  EXPECT_THAT(refusal(folder / "empty.fp"), HasSubstr("empty"));
  samples::write_bytes(folder / "text.fp", std::string(5000, 'x'));
  EXPECT_THAT(refusal(folder / "text.fp"), HasSubstr("not a results file"));
  samples::write_bytes(folder / "short.fp", "x");
  EXPECT_THAT(refusal(folder / "short.fp"), HasSubstr("not a results file"));
  tamper(folder / "other.db", "CREATE TABLE t(x); INSERT INTO t VALUES (1)");
  EXPECT_THAT(refusal(folder / "other.db"), HasSubstr("not a results file"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("a pipe, a device or a socket"));
}

TEST(ArchiveReader, names_the_live_file_of_an_interrupted_campaign) {
  const TemporaryFolder folder;
  { ArchiveWriter writer(folder / "a.fp", samples::plan()); }
  EXPECT_THAT(sentence_of<InputError>([&] { ArchiveReader reader(folder / "a.fp"); }), HasSubstr("a.fp.partial"));
}

TEST(ArchiveReader, refuses_another_schema_and_says_what_to_do) {
  const TemporaryFolder folder;
  write_archive(folder / "a.fp");
  tamper(folder / "a.fp", "PRAGMA user_version = 1000");
  EXPECT_THAT(sentence_of<InputError>([&] { ArchiveReader reader(folder / "a.fp"); }), HasSubstr("newer fleetproof"));
  tamper(folder / "a.fp", "PRAGMA user_version = 1");
  EXPECT_THAT(sentence_of<InputError>([&] { ArchiveReader reader(folder / "a.fp"); }), HasSubstr("older fleetproof"));
}

TEST(ArchiveReader, every_truncation_is_noticed) {
  const TemporaryFolder folder;
  write_archive(folder / "a.fp");
  const auto bytes = samples::bytes_of(folder / "a.fp");
  for (std::size_t length = 4096; length < bytes.size(); length += 4096) {
    samples::write_bytes(folder / "cut.fp", bytes.substr(0, length));
    EXPECT_THROW(read_everything(folder / "cut.fp"), EngineError) << length;
  }
  samples::write_bytes(folder / "cut.fp", bytes.substr(0, bytes.size() - 100));
  EXPECT_THROW(read_everything(folder / "cut.fp"), EngineError);
}

TEST(ArchiveReader, a_changed_row_is_named) {
  const TemporaryFolder folder;
  const std::vector<std::string> changes{
      "UPDATE runs SET violation = 1 - violation WHERE run_index = 17",
      "UPDATE runs SET transports_done = transports_done + 1 WHERE run_index = 17",
      "UPDATE runs SET min_clearance_um = 100000 WHERE run_index = 17",
      "UPDATE runs SET outcome_class = 'clean' WHERE run_index = 17",
      "UPDATE runs SET scenario_digest = ~scenario_digest WHERE run_index = 17",
      "UPDATE runs SET contact = 2 WHERE run_index = 17",
      "UPDATE runs SET running_digests = x'00' WHERE run_index = 17",
      "INSERT INTO violations SELECT 17, 99, entity_a, entity_b, first_ns, last_ns, closest_at_ns, min_clearance_um, "
      "relative_speed_um_s, normal_speed_um_s, x_um, y_um, contact FROM "
      "violations LIMIT 1",
      "INSERT INTO incidents SELECT 17, 99, kind, entity_a, entity_b, first_ns, last_ns, value FROM incidents LIMIT 1",
      "INSERT INTO incidents SELECT 17, 99, 4711, entity_a, entity_b, first_ns, last_ns, value FROM incidents LIMIT 1",
      "INSERT INTO probes VALUES (17, 99, 0, x'61', 1)",
      "INSERT INTO probes VALUES (17, 99, 2, x'61', 1)"};
  for (const auto& change : changes) {
    const auto path = folder / ("a" + std::to_string(&change - changes.data()) + ".fp");
    write_archive(path);
    read_everything(path);
    tamper(path, change);
    EXPECT_THAT(sentence_of<EngineError>([&] { read_everything(path); }), HasSubstr("run 17")) << change;
    EXPECT_THROW(ArchiveReader(path).run(17), EngineError) << change;
    EXPECT_NO_THROW(ArchiveReader(path).run(16)) << change;
  }
}

TEST(ArchiveReader, a_replay_can_read_what_was_changed_but_no_run_without_a_cell) {
  const TemporaryFolder folder;
  write_archive(folder / "a.fp");
  tamper(folder / "a.fp",
         "UPDATE runs SET drives = 123 WHERE run_index = 17; UPDATE cells SET loss = 0.1 WHERE cell = 3; UPDATE runs "
         "SET cell = 6 WHERE run_index = 18");
  EXPECT_THROW(ArchiveReader(folder / "a.fp"), EngineError);
  const ArchiveReader reader(folder / "a.fp", Checksums::Ignore);
  EXPECT_EQ(reader.run(17)->outcome.counters.drives, 123u);
  EXPECT_THAT(sentence_of<EngineError>([&] { reader.run(18); }), HasSubstr("no cell"));
}

TEST(ArchiveReader, a_row_or_a_violation_taken_away_is_noticed) {
  const TemporaryFolder folder;
  const std::vector<std::string> changes{
      "DELETE FROM violations WHERE run_index = (SELECT max(run_index) FROM violations)",
      "DELETE FROM incidents WHERE run_index = (SELECT max(run_index) FROM incidents)",
      "DELETE FROM probes WHERE run_index = (SELECT max(run_index) FROM probes)",
      "DELETE FROM violations WHERE run_index = 59; DELETE FROM runs WHERE run_index = 59",
      "DELETE FROM runs WHERE run_index = (SELECT max(run_index) FROM violations)"};
  for (const auto& change : changes) {
    const auto path = folder / ("a" + std::to_string(&change - changes.data()) + ".fp");
    write_archive(path);
    tamper(path, change);
    EXPECT_THROW(read_everything(path), EngineError) << change;
  }
}

TEST(ArchiveReader, a_changed_plan_is_noticed) {
  const TemporaryFolder folder;
  const std::vector<std::string> changes{"UPDATE cells SET loss = 0.1 WHERE cell = 3",
                                         "UPDATE gates SET limit_rate = 0.5",
                                         "UPDATE gates SET fleet_size = 6 WHERE gate = 1",
                                         "UPDATE gates SET fleet_size = NULL",
                                         "UPDATE gates SET fleet_size = 0 WHERE gate = 0",
                                         "UPDATE gates SET loss = 0.0",
                                         "UPDATE gates SET call_cost_s = NULL",
                                         "UPDATE campaign SET seed = 1",
                                         "UPDATE campaign SET required_probes = ''",
                                         "DELETE FROM gates WHERE gate = 1",
                                         "UPDATE gates SET kind = 'perhaps'"};
  for (const auto& change : changes) {
    const auto path = folder / ("a" + std::to_string(&change - changes.data()) + ".fp");
    write_archive(path);
    tamper(path, change);
    EXPECT_THROW(ArchiveReader reader(path), EngineError) << change;
  }
}

TEST(ArchiveWriter, refuses_names_that_are_taken_or_cannot_be) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& path) {
    return sentence_of<InputError>([&] { ArchiveWriter writer(path, samples::plan()); });
  };
  write_archive(folder / "a.fp");
  const auto before = samples::bytes_of(folder / "a.fp");
  EXPECT_THAT(refusal(folder / "a.fp"), HasSubstr("exists already"));
  EXPECT_TRUE(samples::bytes_of(folder / "a.fp") == before);
  { ArchiveWriter writer(folder / "b.fp", samples::plan()); }
  EXPECT_THAT(refusal(folder / "b.fp"), HasSubstr("interrupted"));
  EXPECT_THAT(refusal(folder / "."), HasSubstr("folder"));
  EXPECT_THAT(refusal(folder / "no/such/a.fp"), HasSubstr("there is no folder"));
  EXPECT_THAT(refusal(""), HasSubstr("needs a name"));
}

// A writer as a campaign would open it.
void open_writer(const std::string& path, Existing existing = Existing::Refuse) {
  ArchiveWriter writer(path, samples::plan(), existing);
}

TEST(ArchiveWriter, a_place_that_cannot_be_written_is_for_the_user_to_mend) {
  const TemporaryFolder folder;
  samples::write_bytes(folder / "file", "x");
  for (const auto existing : {Existing::Refuse, Existing::Replace}) {
    const auto refusal = [&](const std::string& path) {
      return sentence_of<InputError>([&] { open_writer(path, existing); });
    };
    EXPECT_THAT(refusal("/proc/a.fp"), HasSubstr("name another folder"));
    EXPECT_THAT(refusal(folder / "file/a.fp"), HasSubstr("give another name"));
    EXPECT_THAT(refusal(folder / "file/deeper/a.fp"), HasSubstr("folder"));
    EXPECT_THAT(refusal(folder / "none/a.fp"), HasSubstr("there is no folder"));
    EXPECT_THAT(refusal(folder / std::string(300, 'x')), HasSubstr("too long"));
    EXPECT_THAT(refusal(folder / (std::string(300, 'x') + "/a.fp")), HasSubstr("too long"));
    EXPECT_THAT(refusal(folder / "."), HasSubstr("this is a folder"));
  }
}

TEST(ArchiveWriter, a_folder_without_permission_is_for_the_user_to_mend) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  fs::create_directory(folder / "locked");
  test::give_away(folder / ".");
  test::unprivileged([&] {
    open_writer(folder / "a.fp");  // the folder itself is open
    for (const auto rights : {fs::perms::owner_read | fs::perms::owner_exec, fs::perms::none}) {
      fs::permissions(folder / "locked", rights);
      EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / "locked/a.fp"); }), HasSubstr("permissions"));
    }
    fs::permissions(folder / "locked", fs::perms::owner_all);
  });
}

TEST(ArchiveReader, a_file_without_permission_is_for_the_user_to_mend) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  write_archive(folder / "a.fp");
  test::give_away(folder / ".");
  test::unprivileged([&] {
    read_everything(folder / "a.fp");
    fs::permissions(folder / "a.fp", fs::perms::none);
    EXPECT_THAT(sentence_of<InputError>([&] { read_everything(folder / "a.fp"); }), HasSubstr("may not be read"));
    fs::create_directory(folder / "locked");
    fs::permissions(folder / "locked", fs::perms::none);
    EXPECT_THAT(sentence_of<InputError>([&] { read_everything(folder / "locked/a.fp"); }),
                HasSubstr("may not be read"));
    fs::permissions(folder / "locked", fs::perms::owner_all);
  });
}

TEST(ArchiveWriter, a_second_writer_is_refused_while_the_first_is_alive) {
  const TemporaryFolder folder;
  const auto path = folder / "a.fp";
  {
    ArchiveWriter first(path, samples::plan());
    for (const auto& run : samples::runs(6)) first.add(run);
    first.commit();
    for (const auto existing : {Existing::Refuse, Existing::Replace}) {
      EXPECT_THAT(sentence_of<InputError>([&] { open_writer(path, existing); }),
                  HasSubstr("another fleetproof run is writing this file"));
    }
    EXPECT_TRUE(std::filesystem::exists(path + ".lock"));
    EXPECT_EQ(ArchiveReader(path + ".partial").run_count(), 6u);
    first.publish(6);
    EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
    EXPECT_NO_THROW(open_writer(path, Existing::Replace));
  }
  EXPECT_EQ(ArchiveReader(path).run_count(), 6u);
  EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
}

TEST(ArchiveWriter, a_lock_left_behind_holds_nobody_up_but_a_foreign_file_of_its_name_stays) {
  const TemporaryFolder folder;
  samples::write_bytes(folder / "a.fp.lock", "");
  EXPECT_NO_THROW(write_archive(folder / "a.fp"));
  samples::write_bytes(folder / "b.fp.lock", "mine");
  EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / "b.fp"); }), HasSubstr("b.fp.lock"));
  EXPECT_EQ(samples::bytes_of(folder / "b.fp.lock"), "mine");
  std::filesystem::create_directory(folder / "c.fp.lock");
  EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / "c.fp"); }), HasSubstr("c.fp.lock"));
}

TEST(ArchiveWriter, replaces_a_results_file_only_when_the_new_one_is_published) {
  const TemporaryFolder folder;
  const auto path = folder / "a.fp";
  write_archive(path, 60);
  const auto before = samples::bytes_of(path);
  open_writer(path, Existing::Replace);  // interrupted at once: its live file stays
  EXPECT_TRUE(samples::bytes_of(path) == before);
  ASSERT_TRUE(std::filesystem::exists(path + ".partial"));
  samples::write_bytes(path + ".partial-wal", "left over");
  {
    ArchiveWriter writer(path, samples::plan(), Existing::Replace);
    for (const auto& run : samples::runs(12)) writer.add(run);
    writer.commit();
    EXPECT_TRUE(samples::bytes_of(path) == before);
    writer.publish(12);
  }
  EXPECT_EQ(ArchiveReader(path).run_count(), 12u);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / ".")) ++files;
  EXPECT_EQ(files, 1u);
}

TEST(ArchiveWriter, replaces_a_damaged_campaign_file_and_makes_one_where_none_is) {
  const TemporaryFolder folder;
  write_archive(folder / "a.fp");
  samples::write_bytes(folder / "a.fp", samples::bytes_of(folder / "a.fp").substr(0, 5000));
  for (const auto* name : {"a.fp", "b.fp"}) {
    {
      ArchiveWriter writer(folder / name, samples::plan(), Existing::Replace);
      writer.publish(0);
    }
    EXPECT_EQ(ArchiveReader(folder / name).run_count(), 0u);
  }
}

TEST(ArchiveWriter, replaces_nothing_that_is_not_a_results_file) {
  const TemporaryFolder folder;
  write_archive(folder / "ours.fp");
  samples::write_bytes(folder / "text.fp", std::string(5000, 'x'));
  samples::write_bytes(folder / "empty.fp", "");
  tamper(folder / "other.fp", "CREATE TABLE t(x); INSERT INTO t VALUES (1)");
  std::filesystem::create_symlink(folder / "ours.fp", folder / "link.fp");
  for (const auto* name : {"text.fp", "empty.fp", "other.fp", "link.fp"}) {
    const auto before = samples::bytes_of(folder / name);
    EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / name, Existing::Replace); }),
                HasSubstr("this is not a results file of fleetproof; it is not overwritten"))
        << name;
    EXPECT_TRUE(samples::bytes_of(folder / name) == before) << name;
    EXPECT_FALSE(std::filesystem::exists((folder / name) + ".partial")) << name;
    EXPECT_FALSE(std::filesystem::exists((folder / name) + ".lock")) << name;
  }
  std::filesystem::create_directory(folder / "folder.fp");
  EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / "folder.fp", Existing::Replace); }),
              HasSubstr("folder"));
  EXPECT_TRUE(std::filesystem::is_directory(folder / "folder.fp"));
}

TEST(ArchiveWriter, a_foreign_file_named_like_the_live_file_stays) {
  const TemporaryFolder folder;
  samples::write_bytes(folder / "a.fp.partial", "half of a download");
  EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / "a.fp", Existing::Replace); }),
              HasSubstr("a.fp.partial"));
  EXPECT_EQ(samples::bytes_of(folder / "a.fp.partial"), "half of a download");
}

TEST(ArchiveWriter, a_foreign_file_with_a_name_that_is_needed_on_the_way_stays) {
  const TemporaryFolder folder;
  for (const char* ending : {".new", ".unfinished"}) {
    samples::write_bytes((folder / "a.fp") + ending, "mine");
    EXPECT_THAT(sentence_of<InputError>([&] { open_writer(folder / "a.fp", Existing::Refuse); }),
                HasSubstr("this file is not of fleetproof; move it away"));
    EXPECT_EQ(samples::bytes_of((folder / "a.fp") + ending), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.fp.partial"));
    // What a killed program left gives way, also before SQLite wrote its first page.
    for (const std::string& rest : {std::string(), std::string(8192, '\0')}) {
      samples::write_bytes((folder / "a.fp") + ending, rest);
      ArchiveWriter writer(folder / "a.fp", samples::plan());
      writer.discard();
    }
  }
}

TEST(ArchiveWriter, the_rest_of_a_killed_merge_gives_way) {
  const TemporaryFolder folder;
  const auto merge = [&] {
    return ArchiveWriter(folder / "a.fp", samples::plan(), Existing::Refuse, {}, LiveName::Merging);
  };
  samples::write_bytes(folder / "a.fp.merging", "mine");
  EXPECT_THAT(sentence_of<InputError>(merge), HasSubstr("a.fp.merging"));
  std::filesystem::remove(folder / "a.fp.merging");
  { auto killed = merge(); }  // leaves its live file, as a kill does
  ASSERT_TRUE(std::filesystem::exists(folder / "a.fp.merging"));
  auto again = merge();
  again.publish(0);
  EXPECT_EQ(ArchiveReader(folder / "a.fp").run_count(), 0U);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.fp.merging"));
}

TEST(ArchiveWriter, a_file_that_appears_while_the_campaign_runs_is_not_overwritten) {
  const TemporaryFolder folder;
  for (const auto existing : {Existing::Refuse, Existing::Replace}) {
    const auto path = folder / (existing == Existing::Refuse ? "a.fp" : "b.fp");
    ArchiveWriter writer(path, samples::plan(), existing);
    samples::write_bytes(path, "mine");
    EXPECT_THAT(sentence_of<InputError>([&] { writer.publish(0); }), HasSubstr("appeared while the campaign ran"));
    EXPECT_EQ(samples::bytes_of(path), "mine");
  }
}

TEST(ArchiveWriter, an_empty_file_that_appears_while_the_campaign_runs_gives_way) {
  const TemporaryFolder folder;
  ArchiveWriter writer(folder / "a.fp", samples::plan());
  samples::write_bytes(folder / "a.fp", "");
  writer.publish(0);
  EXPECT_FALSE(samples::bytes_of(folder / "a.fp").empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "a.fp.unfinished"));
}

}  // namespace
}  // namespace fleetproof::archive_refusals_test
