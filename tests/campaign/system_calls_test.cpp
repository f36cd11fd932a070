#include "campaign/workers/system_calls.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <thread>

namespace fleetproof::system_calls_test {
namespace {

#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
constexpr bool kCanTell = true;
#else
constexpr bool kCanTell = false;
#endif

double work() {
  double sum = 0.0;
  for (int i = 1; i < 10'000; ++i) sum += 1.0 / i;
  return sum;
}

TEST(SystemCalls, AComputationMakesNone) {
  SystemCalls calls;
  for (int time = 0; time < 3; ++time) {
    calls.begin();
    const double sum = work();
    EXPECT_EQ(calls.any(), !kCanTell);
    EXPECT_GT(sum, 9.0);
  }
}

// The first one is noticed, and all of them have their effects.
TEST(SystemCalls, AreNoticedAndMade) {
  SystemCalls calls;
  const pid_t own = ::getpid();
  calls.begin();
  EXPECT_EQ(::getpid(), own);
  EXPECT_TRUE(calls.any());
  calls.begin();
  const mode_t before = ::umask(S_IWOTH);
  const mode_t during = ::umask(before);
  EXPECT_TRUE(calls.any());
  EXPECT_EQ(during, S_IWOTH);
  calls.begin();
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ASSERT_EQ(::write(ends[1], "abc", 3), 3);
  std::array<char, 4> text{};
  ASSERT_EQ(::read(ends[0], text.data(), 3), 3);
  EXPECT_TRUE(calls.any());
  EXPECT_STREQ(text.data(), "abc");
  for (const int end : ends) ::close(end);
}

// A call that fails sets errno as it does without the watch.
TEST(SystemCalls, FailAsTheyWould) {
  SystemCalls calls;
  calls.begin();
  errno = 0;
  EXPECT_EQ(::open("/nowhere/at/all", O_RDONLY), -1);
  EXPECT_EQ(errno, ENOENT);
  EXPECT_TRUE(calls.any());
}

TEST(SystemCalls, ToStartAThreadIsOne) {
  SystemCalls calls;
  calls.begin();
  double sum = 0.0;
  std::thread([&] { sum = work(); }).join();
  EXPECT_TRUE(calls.any());
  EXPECT_GT(sum, 9.0);
}

// Software that blocks or handles the signal by which calls are noticed keeps it: then nothing is known of its calls.
TEST(SystemCalls, LeaveTheSignalToSoftwareThatUsesIt) {
  sigset_t signal, before;
  sigemptyset(&signal);
  sigaddset(&signal, SIGSYS);
  ::pthread_sigmask(SIG_BLOCK, &signal, &before);
  SystemCalls blocked;
  blocked.begin();
  EXPECT_TRUE(blocked.any());
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);

  struct sigaction own {
  }, old{};
  own.sa_handler = [](int) {};
  ::sigaction(SIGSYS, &own, &old);
  SystemCalls handled;
  handled.begin();
  EXPECT_TRUE(handled.any());
  struct sigaction now {};
  ::sigaction(SIGSYS, nullptr, &now);
  EXPECT_EQ(now.sa_handler, own.sa_handler);
  ::sigaction(SIGSYS, &old, nullptr);
}

// Nothing is left behind for calls outside a watch.
TEST(SystemCalls, OutsideAWatchAreFree) {
  SystemCalls calls;
  calls.begin();
  (void)calls.any();
  EXPECT_GT(::getpid(), 0);
  calls.begin();
  EXPECT_EQ(calls.any(), !kCanTell);
}

}  // namespace
}  // namespace fleetproof::system_calls_test
