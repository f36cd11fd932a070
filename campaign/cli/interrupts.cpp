#include "campaign/cli/interrupts.hpp"

#include <csignal>
#include <cstdlib>

#include "campaign/cli/command_line.hpp"

namespace fleetproof::cli {
namespace {

std::atomic<int> first_signal{0};

void on_signal(int number) {
  if (first_signal.exchange(number) != 0) std::_Exit(exit_code_of_signal(number));
}

}  // namespace

void listen_to_interrupts() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
}

const std::atomic<int>& interrupted() { return first_signal; }

}  // namespace fleetproof::cli
