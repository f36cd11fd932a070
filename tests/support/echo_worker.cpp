// A worker that answers every frame with its slot and the frame, and ends as the frame says.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "campaign/workers/forker.hpp"

namespace {

using fleetproof::Channel;

void echo(Channel channel, const std::string& slot) {
  while (channel.wait(std::chrono::hours(1)) == Channel::Wait::Arrived) {
    const std::string words = channel.received();
    if (words == "exit") ::_exit(7);
    if (words == "crash") {
      ::signal(SIGSEGV, SIG_DFL);  // the address sanitizer has a handler of its own
      ::raise(SIGSEGV);
    }
    if (words == "close") {
      channel.close();
      for (;;) ::pause();
    }
    if (words == "child" && ::fork() == 0) {
      for (;;) ::pause();
    }
    if (words == "child in a group") {
      const pid_t child = ::fork();
      ::setpgid(child, child);
      while (child == 0) ::pause();
      channel.send(std::to_string(child));
      continue;
    }
    if (words == "kill forker") ::kill(::getppid(), SIGKILL);
    if (words == "stop forker") ::kill(::getppid(), SIGSTOP);
    channel.send(slot + words);
  }
}

}  // namespace

int main(int argc, char** argv) {
  fleetproof::serve_forker_if_called(argc, argv);
  if (argc == 4) echo(Channel(std::atoi(argv[2])), argv[3]);
}
