#include "campaign/batch/machine_facts.hpp"

#include <gnu/libc-version.h>

#include <array>
#include <fstream>
#include <sstream>

namespace fleetproof {
namespace {

// The value of the first line "KEY : VALUE".
std::string cpu_line(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with(key) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

std::string known_instructions() {
  constexpr std::array kChosenBy = {"avx2", "avx512f", "fma", "fma4"};
  std::string known;
  std::istringstream words(cpu_line("flags"));
  for (std::string word; words >> word;) {
    for (const char* wanted : kChosenBy) {
      if (word == wanted) known += (known.empty() ? "" : " ") + word;
    }
  }
  return known;
}

}  // namespace

MachineFacts machine_facts() {
  return {cpu_line("model name"), known_instructions(), std::string("glibc ") + gnu_get_libc_version()};
}

}  // namespace fleetproof
