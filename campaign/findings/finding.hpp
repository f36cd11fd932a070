#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "campaign/findings/failure_needs.hpp"

namespace fleetproof {

// Why a failure comes about, in words that do not depend on seeds, places or names of AGVs.
struct Mechanism {
  std::string end;                    // "too close, two AGVs"
  std::vector<std::string> needs;     // as FailureNeeds has them
  std::string doing;                  // "one turns"; empty: what the bodies did is not part of it
  std::vector<std::string> words{};   // traits of words that tell it from other failures; sorted
  std::vector<std::string> traits{};  // what else is true of nine in ten of its failures

  // "too close, two AGVs; needs lost messages, GRANT messages; one turns"
  std::string text() const;
};

// A failing run of a campaign, and what it needs.
struct KnownFailure {
  std::uint64_t run = 0;
  std::string agent;
  FailureNeeds needs;
  FailureChoice choice{};               // with which it is found in its run
  std::optional<EndPoint> end_point{};  // of a failure that does not lead its run
};

// Failures of one agent that have one mechanism.
struct Finding {
  std::string agent;
  Mechanism mechanism;
  std::vector<std::size_t> members;    // places in the list of failures, in its order
  std::size_t representative = 0;      // one of them: the simplest
  std::vector<std::string> refuted{};  // needs, a third AGV among them, without which a run fails, too
  bool is_searched = true;             // for runs that fail without its needs

  // The mechanism in words, without what is refuted. Of a single failure, and before the search, it names no needs:
  // other runs may fail so without them.
  std::string text() const;
  // All that it might need is refuted, or there was nothing.
  bool has_no_needs() const;
  // "F-1c2d3e4f": the same for equal agent, end, needs, doing and words on any machine, in any campaign.
  std::string id() const;
};

// A mechanism in words, without the needs that are refuted; these are told behind it.
std::string without_refuted(const std::string& mechanism, const std::vector<std::string>& refuted);

// Failures of one agent with the same end and the same needs are one finding. A set of needs that is rare joins the
// simplest frequent one that it contains: all that the other needs, it needs, too. Unless one in ten of them just drove
// on, they are parted by what the bodies did. Findings are in order of how many failures they have.
std::vector<Finding> findings_of(std::span<const KnownFailure> failures);

}  // namespace fleetproof
