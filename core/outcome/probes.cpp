#include "core/outcome/probes.hpp"

#include <algorithm>

#include "core/base/words.hpp"

namespace fleetproof {

const char* name_of(ProbeSource source) {
  switch (source) {
    case ProbeSource::World:
      return "world";
    case ProbeSource::Agent:
      return "agent";
  }
  return kNoWord;
}

void ProbeTally::declare(std::string_view name, std::uint64_t hash) {
  const auto seen = std::ranges::find(seen_, hash, &Seen::hash);
  if (seen != seen_.end()) {
    ++seen->count;
  } else if (seen_.size() < kNamesMax && name.size() <= kNameBytesMax) {
    seen_.push_back({hash, 1, std::string(name)});
  } else {
    ++left_out_;
  }
}

std::vector<ProbeCount> ProbeTally::counts() const {
  std::vector<ProbeCount> counts;
  for (const Seen& seen : seen_) counts.push_back({ProbeSource::Agent, seen.name, seen.count});
  std::ranges::sort(counts, {}, &ProbeCount::name);
  return counts;
}

}  // namespace fleetproof
