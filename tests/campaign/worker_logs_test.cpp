#include "campaign/workers/worker_logs.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "campaign/workers/fatal_signals.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::worker_logs_test {
namespace {

using samples::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

class WorkerLog : public testing::Test {
 protected:
  std::string prefix() const { return folder_ / "night"; }
  std::string log(int number) const { return prefix() + ".worker-" + std::to_string(number) + ".log"; }
  static std::string label(std::uint64_t run, std::uint64_t call, std::uint32_t agv, std::int64_t at_ns) {
    CallNote note;
    note.number = call;
    note.agv = agv;
    note.at_ns = at_ns;
    note.fleet = 5;
    return line_label(run, note);
  }
  static void print(int file, const std::string& text) {
    ASSERT_EQ(::write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  const TemporaryFolder folder_;
};

TEST_F(WorkerLog, NamesRunAgvAndTimeOnEachLine) {
  EXPECT_EQ(label(17, 4, 2, 12'345'678'900), "run 17, AGV 2, 12.346 s: ");
  EXPECT_EQ(label(17, 4, 6, 0), "run 17, computer 1, 0.000 s: ");
  EXPECT_EQ(label(17, 0, 0, 0), "run 17, before its first call: ");
  const WorkerLogs logs(prefix(), 1, EarlierLogs::Stay);
  const int file = logs.descriptors()[0];
  print(file, "one\ntwo\n");
  std::uint64_t labelled = label_lines(file, 0, label(3, 1, 0, 0));
  EXPECT_EQ(label_lines(file, labelled, label(3, 2, 1, 0)), labelled) << "nothing was printed";
  print(file, "three, without its end");
  labelled = label_lines(file, labelled, label(3, 3, 1, 500'000'000));
  print(file, "four\n");
  labelled = label_lines(file, labelled, label(4, 1, 0, 0));
  EXPECT_EQ(samples::bytes_of(log(0)),
            "run 3, AGV 0, 0.000 s: one\nrun 3, AGV 0, 0.000 s: two\nrun 3, AGV 1, 0.500 s: three, without its "
            "end\nrun 4, AGV 0, 0.000 s: four\n");
  EXPECT_EQ(labelled, samples::bytes_of(log(0)).size());
}

TEST_F(WorkerLog, KeepsLinesThatAreTooManyToLabel) {
  const WorkerLogs logs(prefix(), 1, EarlierLogs::Stay);
  const std::string much(std::size_t{2} << 20, 'x');
  print(logs.descriptors()[0], much);
  EXPECT_EQ(label_lines(logs.descriptors()[0], 0, label(3, 1, 0, 0)), much.size());
  EXPECT_EQ(samples::bytes_of(log(0)), much);
}

TEST_F(WorkerLog, OfAnEarlierCampaignIsRemovedOnlyByANewOne) {
  samples::write_bytes(log(0), "run 1, AGV 0, 0.000 s: old\n");
  samples::write_bytes(log(1), "my notes\n");
  samples::write_bytes(log(2), "start of a worker: old\n");
  {
    const WorkerLogs logs(prefix(), 1, EarlierLogs::Stay);
    EXPECT_EQ(logs.path(0), log(0));
    EXPECT_EQ(logs.size(0), samples::bytes_of(log(0)).size());
    print(logs.descriptors()[0], "run 1, AGV 0, 0.000 s: more\n");
  }
  EXPECT_EQ(samples::bytes_of(log(0)), "run 1, AGV 0, 0.000 s: old\nrun 1, AGV 0, 0.000 s: more\n");
  { const WorkerLogs logs(prefix(), 3, EarlierLogs::AreRemoved); }
  EXPECT_FALSE(std::filesystem::exists(log(0))) << "and nothing was printed";
  EXPECT_EQ(samples::bytes_of(log(1)), "my notes\n");
  EXPECT_FALSE(std::filesystem::exists(log(2)));
}

TEST_F(WorkerLog, ThatAnotherProgramWritesIsLeftAlone) {
  const WorkerLogs running(prefix(), 1, EarlierLogs::AreRemoved);
  print(running.descriptors()[0], "run 1, AGV 0, 0.000 s: mine\n");
  const WorkerLogs other(prefix(), 1, EarlierLogs::AreRemoved);
  EXPECT_EQ(other.path(0), log(1));
  EXPECT_EQ(samples::bytes_of(log(0)), "run 1, AGV 0, 0.000 s: mine\n");
}

TEST_F(WorkerLog, IsNoPipeAndNoLink) {
  ASSERT_EQ(::mkfifo(log(0).c_str(), 0644), 0);
  std::filesystem::create_symlink("nothing", log(1));
  const WorkerLogs logs(prefix(), 1, EarlierLogs::AreRemoved);
  EXPECT_EQ(logs.path(0), log(2));
}

TEST_F(WorkerLog, GivesTheLastLinesOfARun) {
  std::string text;
  for (int i = 0; i < 30; ++i)
    text += "run 1, AGV 0, 0.000 s: line " + std::to_string(i) + "\nrun 11, AGV 0, 0.000 s: other\n";
  samples::write_bytes(log(0), "run 2, AGV 0, 0.000 s: else\n");
  samples::write_bytes(log(1), text + std::string(100'000, 'y'));
  const PrintedLines printed = last_printed(prefix(), 1, 2);
  EXPECT_EQ(printed.log, log(1));
  EXPECT_THAT(printed.lines, ElementsAre("AGV 0, 0.000 s: line 28", "AGV 0, 0.000 s: line 29"));
  EXPECT_THAT(last_printed(prefix(), 3, 2).lines, testing::IsEmpty());
  std::filesystem::remove(log(0));
  ASSERT_EQ(::mkfifo(log(0).c_str(), 0644), 0);
  EXPECT_THAT(last_printed(prefix(), 3, 2).trouble, HasSubstr("is a pipe"));
  EXPECT_EQ(last_printed(prefix(), 1, 2).log, log(1));
}

// As no worker writes it: its lines are not those of a run.
TEST_F(WorkerLog, ThatIsHugeIsNotRead) {
  samples::write_bytes(log(0), "run 1, AGV 0, 0.000 s: line\n");
  std::filesystem::resize_file(log(0), std::uintmax_t{65} << 20);
  const PrintedLines printed = last_printed(prefix(), 1, 2);
  EXPECT_THAT(printed.lines, testing::IsEmpty());
  EXPECT_THAT(printed.trouble, HasSubstr("is larger than the log of a worker ever is"));
}

TEST_F(WorkerLog, GivesTheLastStackWithoutLabels) {
  const WorkerLogs logs(prefix(), 1, EarlierLogs::Stay);
  const std::string crash = label(5, 9, 1, 2'000'000'000);
  print(logs.descriptors()[0], std::string(kStackTitle) + "first\nsecond\n");
  label_lines(logs.descriptors()[0], 0, crash);
  EXPECT_THAT(logs.last_stack(0, crash), ElementsAre("first", "second"));
}

}  // namespace
}  // namespace fleetproof::worker_logs_test
