#pragma once

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>

// Root may read and write everything, so that a test of "permission denied" would test nothing under root.
namespace fleetproof::test {

inline constexpr unsigned kNobody = 65534;

// Gives a folder, with all that is in it, to the user that `unprivileged` becomes.
inline void give_away(const std::filesystem::path& folder) {
  if (::geteuid() != 0) return;
  ASSERT_EQ(::chown(folder.c_str(), kNobody, kNobody), 0) << folder;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    ASSERT_EQ(::lchown(entry.path().c_str(), kNobody, kNobody), 0) << entry.path();
}

// Acts in a child process, without the rights of root: as the user nobody if the test runs as root. A failed
// expectation in the child, or an exception, fails the test.
template <class Action>
void unprivileged(Action action) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const bool root = ::geteuid() == 0;
    if (root && (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) ::_exit(2);
    if (::geteuid() == 0) ::_exit(2);
    try {
      action();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    ::_exit(testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << "the child died";
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: see above; 2: the child cannot give up the rights of root";
}

}  // namespace fleetproof::test
