// Every verb in a hostile folder: something else stands in the place of a file that the program knows. It answers with
// one clear error or with the report that it can give; it waits for nothing and takes no memory for what it does not
// read.
#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <set>
#include <vector>

#include "tests/support/program.hpp"
#include "tests/support/unprivileged.hpp"

namespace fleetproof::side_files_test {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

// What a verb may answer. A verdict: the file only tells more, and the report says that it does not.
const std::set<int> kRefused = {2}, kVerdict = {0, 1, 4}, kEither = {0, 1, 2, 4};

// A file that a verb reads or appends to, beside what it was asked about.
struct Reading {
  std::string file, words;
  const std::set<int>& codes;
  bool has_to_exist = true;  // else it is written
};

// A way to be no proper file.
struct Disguise {
  const char* name;
  const char* make;  // for bash, with FILE
};

constexpr Disguise kDisguises[] = {
    {"a pipe", "mkfifo FILE"},
    {"a device", "ln -s /dev/zero FILE"},
    {"a folder", "mkdir FILE"},
    {"a huge file", "truncate -s 1G FILE"},
    {"a file without permission", "cp kept FILE 2>/dev/null || touch FILE; chmod 0 FILE"},
    {"a link to nothing", "ln -s nothing/at/all FILE"},
    {"a link to itself", "ln -s $(basename FILE) FILE"}};

class SideFiles : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml",
          "name = \"a\"\nseed = 5\nreplicates = 8\nhorizon_s = 30\n[factors]\nagents = [\"hull-lock\", \"reckless\"]\n"
          "layouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n");
    ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db")));
    ASSERT_EQ(run("run a.toml --shard 1/1 --out out").exit_code, 0);
    // The folder of the build may be closed to others.
    fs::copy_file(FLEETPROOF_PROGRAM, path("program"));
    write("findings.toml", "# findings\n");
    test::give_away(folder_);
  }
  test::Finished run_unprivileged(const std::string& words, const std::string& before = "") const {
    const bool root = ::geteuid() == 0;
    return shell(before + (root ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "") +
                 "timeout 60 ./program " + words);
  }
  // Puts the disguise in the place of a file, which goes to `kept`.
  void disguise(const std::string& file, std::string make) const {
    fs::remove_all(path("kept"));
    if (fs::exists(path(file))) fs::rename(path(file), path("kept"));
    for (std::size_t at = 0; (at = make.find("FILE", at)) != std::string::npos;) make.replace(at, 4, "'" + file + "'");
    ASSERT_EQ(shell(make).exit_code, 0) << make;
    if (::geteuid() == 0) {
      ASSERT_EQ(::lchown(path(file).c_str(), test::kNobody, test::kNobody), 0);
    }
  }
  void put_back(const std::string& file) const {
    fs::remove_all(path(file));
    if (fs::exists(path("kept"))) fs::rename(path("kept"), path(file));
  }
  void expect_answers(const Reading& reading) const {
    for (const Disguise& as : kDisguises) {
      disguise(reading.file, as.make);
      const auto finished = run_unprivileged(reading.words);
      const std::string what = reading.words + ", where " + reading.file + " is " + as.name + "\n" + finished.err;
      EXPECT_TRUE(reading.codes.contains(finished.exit_code)) << finished.exit_code << ": " << what;
      EXPECT_THAT(finished.err, Not(HasSubstr("engine fault"))) << what;
      if (finished.exit_code == 2) {
        EXPECT_THAT(finished.err, HasSubstr(fs::path(reading.file).filename().string())) << what;
        if (reading.has_to_exist && std::string_view(as.name) == "a link to nothing") {
          EXPECT_THAT(finished.err, HasSubstr("is a link to nothing")) << what;
        }
      }
      put_back(reading.file);
      fs::remove(path("m.db"));
    }
  }
  void expect_small() const {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    rusage used{};
    ::getrusage(RUSAGE_CHILDREN, &used);
    EXPECT_LT(used.ru_maxrss, 300 * 1024) << "kB of the largest process";
#endif
  }
};

TEST_F(SideFiles, BesideAResultsFile) {
  const Reading readings[] = {{"a.sessions.jsonl", "run a.toml --db a.db --overwrite", kRefused},
                              {"a.sessions.jsonl", "merge out --db a.db --overwrite", kRefused},
                              {"a.sessions.jsonl", "report a.db", kVerdict},
                              {"a.sessions.jsonl", "replay a.db 1", kVerdict},
                              {"a.sessions.jsonl", "verify a.db --sample 10%", kVerdict},
                              {"attempts.jsonl", "run a.toml --db a.db --overwrite", kRefused},
                              {"attempts.jsonl", "merge out --db m.db", kRefused},
                              {"attempts.jsonl", "report a.db --ledger attempts.jsonl", kRefused},
                              {"attempts.jsonl", "report a.db", kVerdict},
                              {"a.findings.json", "report a.db", kVerdict},
                              {"a.findings.json", "findings a.db --max-failures 1", kEither},
                              {"a.sensitivity.json", "report a.db", kVerdict},
                              {"a.sensitivity.json", "sensitivity a.toml --runs 1 --agent asks-once", kEither},
                              {"findings.toml", "findings a.db --max-failures 1 --file findings.toml", kRefused},
                              {"findings.toml", "retest findings.toml --agent hull-lock", kRefused},
                              {"case.json.trials", "shrink a.db 1 -o case.json --max-trials 3", kEither},
                              {"a.run-1.explained.json", "replay a.db 1 --html r.html", kVerdict},
                              {"a.run-1.explained.json", "explain a.db 1 --max-trials 3", kEither},
                              {"a.worker-0.log", "report a.db", kVerdict}};
  for (const Reading& reading : readings) expect_answers(reading);
  expect_small();
}

TEST_F(SideFiles, InAFolderOfShards) {
  std::string log;
  for (const auto& entry : fs::directory_iterator(path("out/sessions"))) {
    if (entry.path().extension() == ".jsonl") log = "out/sessions/" + entry.path().filename().string();
  }
  ASSERT_FALSE(log.empty());
  for (const std::string& file : {log, std::string("out/plan.db"), std::string("out/chunks/000/000000.chunk")})
    expect_answers({file, "merge out --db m.db", kRefused});
  for (const std::string& file : {log, std::string("out/plan.db")}) expect_answers({file, "missing out", kEither});
  for (const char* file : {"out/plan.db", "out/canary.txt"})
    expect_answers({file, "run a.toml --shard 1/1 --out out", kEither});
  expect_small();
}

TEST_F(SideFiles, UnderTheNameOfAResultsFile) {
  for (const char* words : {"report a.db", "replay a.db 1", "verify a.db", "shrink a.db 1 -o c.json", "explain a.db 1",
                            "findings a.db", "compare a.db a.db", "report a.db --baseline a.db"})
    expect_answers({"a.db", words, kRefused});
  expect_answers({"a.db", "run a.toml --db a.db", kRefused, false});
  for (const char* file : {"b.db.lock", "b.db.new", "b.db.unfinished", "b.db.partial"})
    expect_answers({file, "run a.toml --db b.db", kEither, false});
  expect_small();
}

// In a live file, which has no seal, and in a published one.
TEST_F(SideFiles, AViewInThePlaceOfATable) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path("a.db").c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db,
                         "DROP TABLE runs; CREATE VIEW runs AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 "
                         "FROM c) SELECT x AS run_index FROM c WHERE x < 0",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(db);
  for (const char* words : {"report a.db", "replay a.db 1", "verify a.db", "shrink a.db 1 -o c.json", "explain a.db 1",
                            "findings a.db", "compare a.db a.db", "merge out --db m.db"}) {
    if (std::string(words).starts_with("merge"))
      fs::copy_file(path("a.db"), path("out/plan.db"), fs::copy_options::overwrite_existing);
    const auto refused = run("" + std::string(words));
    EXPECT_EQ(refused.exit_code, 2) << words << "\n" << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("runs is no table in it, but a view")) << words;
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Whatever the program lacks first: address space for a thread, for a world, or for nothing. Where the C library has no
// room for itself (a stack that grows, the end of a thread), it ends the program by a signal and asks nobody. The same
// command with enough memory then goes on.
TEST_F(SideFiles, TooLittleMemoryIsNamed) {
  const std::set<int> ends_of_the_library = {127, 128 + SIGABRT, 128 + SIGSEGV, 128 + SIGBUS};  // 127: before main
  std::size_t refused = 0;
  for (int kilobytes = 40'000; kilobytes <= 130'000; kilobytes += 10'000) {
    const std::string words = "run a.toml --db " + std::to_string(kilobytes) + ".db";
    const auto finished = shell("ulimit -v " + std::to_string(kilobytes) + "; \"$FLEETPROOF\" " + words);
    if (test::has_verdict(finished)) continue;
    EXPECT_THAT(finished.err, Not(HasSubstr("crash"))) << kilobytes;  // of the agent, which is innocent
    EXPECT_TRUE(test::has_verdict(run(words))) << kilobytes;
    if (ends_of_the_library.contains(finished.exit_code)) continue;
    ++refused;
    EXPECT_EQ(finished.exit_code, 3) << kilobytes << "\n" << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("memory")) << kilobytes;
    EXPECT_THAT(finished.err, Not(HasSubstr("engine fault"))) << kilobytes;
  }
  EXPECT_GT(refused, 0U);
}
#endif

TEST_F(SideFiles, AFolderThatIsNotThereIsNamed) {
  const auto refused = [&](const std::string& lines, const std::string& named) {
    const auto finished = shell(lines);
    EXPECT_EQ(finished.exit_code, 2) << lines << "\n" << finished.err;
    EXPECT_THAT(finished.err, HasSubstr(named)) << lines;
    EXPECT_THAT(finished.err, Not(HasSubstr("engine fault"))) << lines;
  };
  for (const char* words : {"merge out --db m.db", "missing out", "run a.toml --shard 1/1 --out other"})
    refused(std::string("TMPDIR=/not/there \"$FLEETPROOF\" ") + words, "TMPDIR: names \"/not/there\"");
  for (const char* words : {"run a.toml", "report a.db", "import layout l.json", "check a.toml", "new campaign c.toml",
                            "merge out", "findings a.db"})
    refused("mkdir -p gone; cd gone; rmdir ../gone; \"$FLEETPROOF\" " + std::string(words), "");
  refused("mkdir -p gone; cd gone; rmdir ../gone; \"$FLEETPROOF\" report a.db", "the current folder");
  refused("ln -s itself itself; \"$FLEETPROOF\" report itself", "a link that leads back to itself");
  refused("ln -s loop loop; \"$FLEETPROOF\" run a.toml --db loop", "loop");
  refused("ln -s round round; \"$FLEETPROOF\" report round/a.db", "round");
}

}  // namespace
}  // namespace fleetproof::side_files_test
