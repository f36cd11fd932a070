#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// A row of folded runs that nothing here wrote.
class BrokenFold : public EngineError {
 public:
  using EngineError::EngineError;
};

// The replicates that are folded together: the runs of a cell in these are one row of the table `folded`.
inline constexpr std::uint64_t kReplicatesPerFold = 512;

// What a folded file has of a run in which nothing went wrong.
struct FoldedRun {
  std::uint64_t transports_done = 0, safe_mode_ns = 0;
  std::optional<std::int64_t> min_clearance_um;
  bool in_contract = true;  // the factors of the run itself
  bool repeats = false;     // an earlier run of its cell had the same trace
  std::uint16_t check = 0;  // the lowest bits of the checksum that its row had
  friend bool operator==(const FoldedRun&, const FoldedRun&) = default;
};

// How many folded runs met something, and how often in total. "encounter" stands for all probes of the world that are
// encounters, counted once for each run.
struct MetTotal {
  ProbeSource source = ProbeSource::World;
  std::string name;
  std::uint64_t runs = 0, times = 0;
  friend bool operator==(const MetTotal&, const MetTotal&) = default;
};

// A row of the table `folded`: the folded runs of a cell in replicates [block x kReplicatesPerFold, ...).
struct FoldedRow {
  std::uint64_t place = 0;  // block x cells + cell
  std::uint32_t cell = 0;
  std::uint64_t runs = 0, transports_done = 0;
  std::uint64_t simulated_ns = 0;  // of each run
  std::uint32_t agv_count = 0;     // of each run
  std::optional<std::int64_t> min_clearance_um;
  std::string content;  // what they met, and what each of them did
};

// The runs of one cell in consecutive replicates, each folded or kept as a row of its own.
class FoldedCell {
 public:
  // The next replicate's run. Requires of all that are folded: the same simulated time and the same number of AGVs.
  void fold(const RunRecord& run, std::uint64_t checksum);
  void keep(bool repeats);

  std::uint64_t runs() const { return runs_; }  // folded
  // A row says nothing if all of its runs are kept and none repeats another one.
  bool says_nothing() const { return runs_ == 0 && !keeps_a_repetition_; }
  std::uint64_t transports_done() const { return transports_done_; }
  std::uint64_t simulated_ns() const { return simulated_ns_; }  // of each folded run
  std::uint32_t agv_count() const { return agv_count_; }
  std::optional<std::int64_t> min_clearance_um() const { return min_clearance_um_; }
  // Whether the run could be one of these by its time and its AGVs.
  bool suits(const Outcome& outcome) const;
  std::string content() const;  // as UnfoldedCell reads it

 private:
  void meet(ProbeSource source, const std::string& name, std::uint64_t times);

  std::uint64_t runs_ = 0, transports_done_ = 0, simulated_ns_ = 0;
  std::uint32_t agv_count_ = 0;
  bool keeps_a_repetition_ = false;
  std::optional<std::int64_t> min_clearance_um_;
  std::map<std::pair<ProbeSource, std::string>, MetTotal> met_;
  std::string bytes_;  // of the runs
};

// How the bytes of a run say what it is: an earlier schema did not know which run repeats another one.
enum class FoldEncoding : std::uint8_t { WithoutRepeats, WithRepeats };

// The next run of a cell; nothing if it was kept.
struct UnfoldedRun {
  std::optional<FoldedRun> run;
  bool repeats = false;
};

// Reads the content of a folded cell. Its functions throw BrokenFold.
class UnfoldedCell {
 public:
  UnfoldedCell(std::string content, FoldEncoding encoding);

  const std::vector<MetTotal>& met() const { return met_; }
  UnfoldedRun next();  // of the next replicate
  bool next_is_folded_and_new() const;
  bool at_end() const { return at_ == content_.size(); }

 private:
  std::uint64_t number();
  std::string text(std::size_t size);

  std::string content_;
  FoldEncoding encoding_;
  std::size_t at_ = 0;
  std::vector<MetTotal> met_;
};

}  // namespace fleetproof
