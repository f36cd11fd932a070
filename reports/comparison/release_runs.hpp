#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/outcome/run_result.hpp"
#include "reports/page/page.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof {

// The end points that two releases are compared on. Throughput is that of a whole world.
inline constexpr std::array kComparedEndPoints{EndPoint::Violation, EndPoint::Contact,    EndPoint::Deadlock,
                                               EndPoint::Livelock,  EndPoint::Starvation, EndPoint::WrongLoad,
                                               EndPoint::Crash,     EndPoint::Hang,       EndPoint::Throughput};

// What a comparison needs of one run.
struct ComparedRun {
  std::uint64_t run_index = 0;
  std::array<RunResult, kComparedEndPoints.size()> results{};
  std::uint64_t transports_done = 0, agv_us = 0;
  bool repeats = false;  // an earlier run of its cell had the same trace

  bool is_clean() const;  // no end point failed or stayed unknown
};

// The runs of one agent in a results file, in the order of the file: of each complete replicate, one run for each of
// the agent's cells.
struct ReleaseRuns {
  std::string path, agent;
  CampaignRecord campaign;
  std::vector<CellRecord> cells;                     // of this agent
  std::vector<std::vector<ComparedRun>> replicates;  // [replicate][cell of this agent]
  std::uint64_t audited = 0, differing = 0;          // of its runs
  bool has_unplaced_repeats = false;                 // some runs repeat others, and the file does not say which
  // What stands at the head of its report beside the verdict. A caller adds it.
  std::vector<Headline> head{};
};

// The agents that an archive can compare: those whose gates decide; all agents if no gate does.
std::vector<std::string> agents_to_compare(const ArchiveReader& archive);

// Requires: the campaign has this agent.
ReleaseRuns read_release(const ArchiveReader& archive, std::string path, const std::string& agent);

}  // namespace fleetproof
