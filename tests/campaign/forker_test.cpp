#include "campaign/workers/forker.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include "core/base/error.hpp"

namespace fleetproof::forker_test {
namespace {

using Wait = Channel::Wait;

// tests/support/echo_worker.cpp
WorkerProgram echo() { return {FLEETPROOF_ECHO_WORKER, {"echo"}}; }

std::string ask(Forker::Worker& worker, const std::string& words) {
  EXPECT_TRUE(worker.channel.send(words));
  return worker.channel.wait(std::chrono::seconds(20)) == Wait::Arrived ? worker.channel.received() : "no answer";
}

// A process that lost its parent is collected by another one, perhaps late.
bool is_dead(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string number, name, letter = "gone";
  file >> number >> name >> letter;
  return letter == "gone" || letter == "Z";
}

bool is_alive(pid_t pid) { return ::kill(pid, 0) == 0; }

std::set<pid_t> processes_of_group(pid_t group) {
  std::set<pid_t> found;
  DIR* folder = ::opendir("/proc");
  while (const dirent* entry = ::readdir(folder)) {
    const pid_t pid = std::atoi(entry->d_name);
    if (pid > 0 && ::getpgid(pid) == group) found.insert(pid);
  }
  ::closedir(folder);
  return found;
}

void expect_group_ends(pid_t group) {
  const auto lives = [&] { return !std::ranges::all_of(processes_of_group(group), is_dead); };
  for (int i = 0; i < 2000 && lives(); ++i) ::usleep(1000);
  EXPECT_FALSE(lives());
}

TEST(Forker, StartsWorkersAndTellsHowEachEnds) {
  Forker forker(echo());
  for (const auto& [words, signal, code] : {std::tuple{"exit", 0, 7}, {"crash", SIGSEGV, 0}}) {
    auto worker = forker.start(3);
    EXPECT_EQ(ask(worker, "hello"), "3hello");
    worker.channel.send(words);
    EXPECT_EQ(worker.channel.wait(std::chrono::seconds(20)), Wait::Gone);
    const WorkerDeath death = forker.collect(worker);
    EXPECT_FALSE(death.had_to_be_killed);
    EXPECT_EQ(WIFSIGNALED(death.status) ? WTERMSIG(death.status) : 0, signal);
    EXPECT_EQ(WIFEXITED(death.status) ? WEXITSTATUS(death.status) : 0, code);
    EXPECT_GT(death.max_memory_kb, 0);
    EXPECT_FALSE(is_alive(worker.pid));
  }
}

TEST(Forker, KillsAWorkerThatClosedItsChannelAndLives) {
  Forker forker(echo());
  auto worker = forker.start(0);
  worker.channel.send("close");
  EXPECT_EQ(worker.channel.wait(std::chrono::seconds(20)), Wait::Gone);
  EXPECT_TRUE(forker.collect(worker).had_to_be_killed);
  EXPECT_FALSE(is_alive(worker.pid));
}

TEST(Forker, KillsWhatAWorkerHasStarted) {
  Forker forker(echo());
  auto worker = forker.start(0);
  EXPECT_EQ(ask(worker, "child"), "0child");
  EXPECT_EQ(processes_of_group(worker.pid).size(), 2U);
  worker.channel.send("exit");
  forker.collect(worker);
  expect_group_ends(worker.pid);
}

TEST(Forker, LeavesNoProcessBehind) {
  pid_t one = 0, other = 0;
  {
    Forker forker(echo());
    auto first = forker.start(0), second = forker.start(1);
    one = first.pid;
    other = second.pid;
    EXPECT_EQ(ask(second, "child"), "1child");
    EXPECT_TRUE(is_alive(one) && is_alive(other));
    EXPECT_EQ(processes_of_group(other).size(), 2U);
  }
  EXPECT_FALSE(is_alive(one) || is_alive(other));
  expect_group_ends(other);
}

TEST(Forker, EndsWhileALaterOneLives) {
  std::optional<Forker> first(std::in_place, echo());
  Forker second(echo());
  auto of_first = first->start(0), of_second = second.start(1);
  EXPECT_EQ(ask(of_first, "hello"), "0hello");
  first.reset();
  EXPECT_FALSE(is_alive(of_first.pid));
  EXPECT_EQ(ask(of_second, "hello"), "1hello");
}

// What the main process, killed, cannot do any more.
TEST(Forker, DiesWithTheProcessThatMadeIt) {
  auto [here, there] = Channel::make_pair();
  const pid_t main_process = ::fork();
  if (main_process == 0) {
    here.close();
    Forker forker(echo());
    auto worker = forker.start(0);
    if (ask(worker, "child") == "0child") there.send(std::to_string(worker.pid));
    for (;;) ::pause();
  }
  ASSERT_EQ(here.wait(std::chrono::seconds(20)), Wait::Arrived);
  const pid_t worker = std::stoi(here.received());
  ::kill(main_process, SIGKILL);
  ::waitpid(main_process, nullptr, 0);
  expect_group_ends(worker);
}

TEST(Forker, StartsAgainAfterItWasKilled) {
  Forker forker(echo());
  auto worker = forker.start(0);
  const pid_t in_a_group = std::stoi(ask(worker, "child in a group"));
  EXPECT_TRUE(is_alive(in_a_group));
  worker.channel.send("kill forker");
  while (worker.channel.wait(std::chrono::seconds(20)) == Wait::Arrived) (void)worker.channel.received();
  EXPECT_TRUE(forker.collect(worker).with_forker) << "its workers end with it";
  expect_group_ends(worker.pid);
  auto next = forker.start(1);
  EXPECT_TRUE(is_dead(in_a_group)) << "what it has started, in whichever group";
  EXPECT_EQ(ask(next, "hello"), "1hello");
  next.channel.send("exit");
  EXPECT_EQ(WEXITSTATUS(forker.collect(next).status), 7);
  EXPECT_TRUE(forker.collect(worker).with_forker) << "it was started by another process";
}

TEST(Forker, GoesOnAfterItWasStopped) {
  std::optional<Forker> forker(std::in_place, echo());
  auto worker = forker->start(0);
  EXPECT_EQ(ask(worker, "stop forker"), "0stop forker");
  auto next = forker->start(1);
  EXPECT_EQ(ask(next, "stop forker"), "1stop forker");
  forker.reset();
  EXPECT_FALSE(is_alive(worker.pid) || is_alive(next.pid));
}

TEST(Forker, TellsThatAProgramCannotBeStarted) {
  Forker forker({"/nowhere", {}});
  EXPECT_THROW(forker.start(0), MachineError);
}

// Its owner has not said that programs which it starts must not have it.
TEST(Forker, LeavesFilesToTheProcessThatMadeIt) {
  const int file = ::fcntl(STDIN_FILENO, F_DUPFD, 200);
  Forker forker(echo());
  auto worker = forker.start(0);
  EXPECT_EQ(ask(worker, "hello"), "0hello");
  const std::string open_file = "/fd/" + std::to_string(file);
  EXPECT_TRUE(std::filesystem::is_symlink("/proc/self" + open_file)) << "the test is about something";
  EXPECT_FALSE(std::filesystem::is_symlink("/proc/" + std::to_string(worker.pid) + open_file));
  ::close(file);
}

}  // namespace
}  // namespace fleetproof::forker_test
