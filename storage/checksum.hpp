#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// XXH3 over run index, cell, replicate, scenario digest and the canonical bytes of the outcome. These bytes contain the
// violations, incidents and probes.
std::uint64_t row_checksum(const RunRecord& run);

// XXH3 over everything that is fixed before the first run: campaign, cells, gates.
std::uint64_t plan_checksum(const CampaignRecord& campaign, const std::vector<CellRecord>& cells,
                            const std::vector<GateRecord>& gates);

// One digest over the checksums of many rows. Requires: the rows come in order of run index.
class RowsDigest {
 public:
  RowsDigest();
  ~RowsDigest();
  RowsDigest(const RowsDigest&) = delete;
  RowsDigest& operator=(const RowsDigest&) = delete;

  void add(std::uint64_t checksum);
  std::uint64_t value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A digest of the whole content: the plan's checksum and all rows.
std::uint64_t content_digest_of(std::uint64_t plan, std::uint64_t rows);

}  // namespace fleetproof
