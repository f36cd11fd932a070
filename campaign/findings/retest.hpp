#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "campaign/findings/neighbourhood.hpp"
#include "campaign/findings/whole_failures.hpp"

namespace fleetproof {

// What became of a finding in other software.
enum class RetestVerdict : std::uint8_t {
  Fixed,       // neither the case nor any neighbour fails so, and many neighbours failed before
  Dodged,      // the case passes, and neighbours fail as it did, about as often as before
  StillThere,  // the case fails as it did; or neighbours do, but much more seldom than before
  NewKind,     // it does not fail as it did, but otherwise, and more often than before
  NotKnown,    // nothing fails, but before, too, hardly any neighbour did; or the fleets hardly drive anywhere now
};
constexpr const char* name_of(RetestVerdict verdict) {
  switch (verdict) {
    case RetestVerdict::Fixed:
      return "fixed";
    case RetestVerdict::Dodged:
      return "dodged";
    case RetestVerdict::StillThere:
      return "still there";
    case RetestVerdict::NewKind:
      return "new kind";
    case RetestVerdict::NotKnown:
      return "not known";
  }
  return kNoWord;
}

struct Retest {
  RetestVerdict verdict = RetestVerdict::NotKnown;
  bool case_fails = false;  // as the kept one did
  NeighbourCounts now;
  NeighbourCounts whole_runs;  // none if the case fails, or its neighbours in another way
  double upper_bound = 1.0;    // of the share of neighbours that fail so, 95 % sure
  // Of the first neighbours that end as the case did: looked at, known to be the kept failure, and known not to be it.
  std::size_t looked_at = 0, known_kept = 0, known_other = 0;
  std::string new_kind;  // how else it fails: an end, and what that needs
  std::string standing;  // how little the fleets drive there, if less than half as far as before
};

// As many whole runs as neighbours are tried, if they decide, and kWholeRuns at most.
// `before`: how the software in which the failure was found fared; `known`: how it fared in its whole runs.
Retest retest(CaseHost& host, const KeptFailure& kept, const NeighbourCounts& before,
              std::uint32_t neighbours = kNeighbours, const KnownRuns& known = {});

}  // namespace fleetproof
