#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

namespace fleetproof::test {

constexpr int kFailed = 255;

// What `action` returns in a process of its own. Requires: it is below kFailed, and this process has no threads. An
// exception of the action is a failure.
template <class Action>
int in_own_process(Action action) {
  const pid_t child = ::fork();
  if (child == 0) {
    int result = kFailed;
    try {
      result = action();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    ::_exit(result);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const int result = WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
  EXPECT_NE(result, kFailed);
  return result;
}

}  // namespace fleetproof::test
