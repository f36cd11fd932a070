#pragma once

#include <string>

#include "campaign/shrink/trials.hpp"

namespace fleetproof {

// Verdicts that outlive the program, in a file to which each is added as it is found: a search that was killed goes on
// where it ended. Its first line names the case and the programs; verdicts on another case are dropped.
class TrialFile final : public TrialCache {
 public:
  // Throws InputError if there is a file that is none of these.
  TrialFile(std::string path, const std::string& identity);

  void add(std::uint64_t digest, bool fails) override;
  // Its work is done.
  void remove();

 private:
  void read(const std::string& heading);

  std::string path_;
  std::mutex mutex_;
};

}  // namespace fleetproof
