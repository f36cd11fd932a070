#include "storage/checksum.hpp"

#include <xxhash.h>

#include <bit>

#include "core/base/byte_text.hpp"
#include "core/base/error.hpp"
#include "core/outcome/outcome_bytes.hpp"

namespace fleetproof {
namespace {

std::uint32_t outcome_encoding(std::int32_t schema) {
  if (schema < kFirstWithNormalSpeed) return kEncodingWithoutNormalSpeed;
  if (schema < kFirstJudged) return kEncodingWithoutProcessorChanges;
  return schema < kFirstWithWithdrawn ? kEncodingWithoutWithdrawn : kEncodingVersion;
}

// The length of every text comes before the text, so that no two different records have the same bytes.
class Bytes {
 public:
  Bytes& operator<<(std::uint64_t value) { return sink_.u64(value), *this; }
  // 2.0 and 2 are stored alike, and -0.0 comes back as 0: fold the two zeros.
  Bytes& operator<<(double value) { return *this << std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value); }
  Bytes& operator<<(const std::string& value) {
    *this << std::uint64_t{value.size()};
    return sink_.raw(value), *this;
  }
  void factors(const FactorValues& factors, std::int32_t schema) {
    for (const FactorInfo& factor : kFactors) {
      if (factor.first_schema <= schema) *this << factors[factor.id];
    }
  }
  // As the text that `encode` makes of it.
  void outcome(const Outcome& outcome, std::uint32_t version) {
    const std::size_t length_at = sink_.size();
    sink_.u64(0);
    const std::size_t begin = sink_.size();
    encode(outcome, sink_, version);
    sink_.u64_at(length_at, sink_.size() - begin);
  }
  void clear() { sink_.clear(); }
  std::uint64_t hash() const { return XXH3_64bits(sink_.bytes().data(), sink_.size()); }

 private:
  ByteSink sink_;
};

void add_method(Bytes& bytes, const GateRecord& gate) {
  bytes << gate.requirement << gate.where.layout << std::string(name_of(gate.unit)) << std::string(name_of(gate.method))
        << std::uint64_t{gate.decides};
  for (const auto* numbers : {&gate.table.passes_from, &gate.table.refuted_up_to}) {
    bytes << std::uint64_t{numbers->size()};
    for (const std::uint64_t number : *numbers) bytes << number;
  }
}

void add_cells(Bytes& bytes, const CellFilter& filter, std::int32_t schema) {
  bytes << std::uint64_t{filter.fleet_size.has_value()} << std::uint64_t{filter.fleet_size.value_or(0)};
  for (const FactorInfo& factor : kFactors) {
    if (factor.first_schema > schema) continue;
    const auto& named = filter.factors[factor.id];
    bytes << std::uint64_t{named.has_value()} << named.value_or(0.0);
  }
}

}  // namespace

std::uint64_t row_checksum(const RunRecord& run, std::int32_t schema) {
  // Its memory serves the next row: a campaign has millions, and each would ask for it and give it back.
  thread_local Bytes bytes;
  bytes.clear();
  bytes << run.run_index << std::uint64_t{run.cell} << run.replicate << run.scenario_digest;
  bytes.factors(run.factors, schema);
  bytes.outcome(run.outcome, outcome_encoding(schema));
  return bytes.hash();
}

std::uint64_t plan_checksum(const StoredPlan& plan, std::int32_t schema) {
  const auto& [campaign, cells, gates] = plan;
  Bytes bytes;
  bytes << campaign.name << campaign.kind << campaign.seed << campaign.replicates << campaign.plan_json
        << campaign.plan_hash;
  bytes << campaign.engine.version << campaign.engine.program_sha256 << campaign.engine.compiler
        << campaign.engine.flags << campaign.engine.libraries;
  bytes << std::uint64_t{campaign.required_probes.size()};
  for (const auto& probe : campaign.required_probes) bytes << probe;
  bytes << campaign.sampling << std::uint64_t{campaign.held_streams.size()};
  for (const auto& stream : campaign.held_streams) bytes << stream;
  bytes << campaign.held_replicate << campaign.exempt_purposes << campaign.exempt_radius_m
        << std::uint64_t{campaign.exempt_pairs.size()};
  for (const auto& pair : campaign.exempt_pairs) bytes << pair;
  bytes << std::uint64_t{campaign.plugin_agents.size()};
  for (const auto& agent : campaign.plugin_agents) bytes << agent;
  if (schema >= kFirstJudged) {
    for (const auto* agents : {&campaign.deterministic_agents, &campaign.agents_under_test}) {
      bytes << std::uint64_t{agents->size()};
      for (const auto& agent : *agents) bytes << agent;
    }
  }
  if (schema >= kFirstChunked) bytes << campaign.chunk_runs;
  bytes << std::uint64_t{cells.size()};
  for (const auto& cell : cells) {
    bytes << std::uint64_t{cell.index} << cell.agent << cell.layout << std::uint64_t{cell.fleet_size};
    bytes.factors(cell.lowest, schema);
    bytes.factors(cell.highest, schema);
  }
  bytes << std::uint64_t{gates.size()};
  for (const auto& gate : gates) {
    bytes << std::uint64_t{gate.index} << gate.name << gate.agent << std::string(name_of(gate.kind))
          << std::string(name_of(gate.end_point));
    bytes << std::string(name_of(gate.region)) << gate.limit << gate.confidence << gate.min_transports_per_agv_hour;
    if (schema >= kFirstTabled) add_method(bytes, gate);
    if (schema >= kFirstOfOneCell) add_cells(bytes, gate.where, schema);
  }
  // At the end, and only if there is one: a plan without its program has the digest that it always had.
  const std::string& commit = campaign.engine.source_commit;
  if (schema >= kFirstWithCommit && !commit.empty()) bytes << commit;
  return bytes.hash();
}

std::uint64_t recording_checksum(const std::string& calls) { return XXH3_64bits(calls.data(), calls.size()); }

std::uint64_t folded_checksum(const FoldedRow& row) {
  Bytes bytes;
  bytes << row.place << std::uint64_t{row.cell} << row.runs << row.transports_done << row.simulated_ns
        << std::uint64_t{row.agv_count} << std::uint64_t{row.min_clearance_um.has_value()}
        << static_cast<std::uint64_t>(row.min_clearance_um.value_or(0)) << row.content;
  return bytes.hash();
}

struct RowsDigest::State {
  // The hash takes many checksums in one call: a call costs as much as all else that a row costs here.
  static constexpr std::size_t kMostWaiting = 64;
  XXH3_state_t* hash = XXH3_createState();
  ByteSink waiting;

  State() {
    ensure(hash != nullptr, "there is memory for a digest");
    XXH3_64bits_reset(hash);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { XXH3_freeState(hash); }

  void take_waiting() {
    XXH3_64bits_update(hash, waiting.bytes().data(), waiting.size());
    waiting.clear();
  }
};

RowsDigest::RowsDigest() : state_(std::make_unique<State>()) {}
RowsDigest::~RowsDigest() = default;

void RowsDigest::add(std::uint64_t checksum) {
  state_->waiting.u64(checksum);
  if (state_->waiting.size() == State::kMostWaiting * sizeof(checksum)) state_->take_waiting();
}

std::uint64_t RowsDigest::value() const {
  state_->take_waiting();
  return XXH3_64bits_digest(state_->hash);
}

void RowsDigest::reset() {
  state_->waiting.clear();
  XXH3_64bits_reset(state_->hash);
}

std::uint64_t content_digest_of(std::uint64_t plan, std::uint64_t rows) { return (Bytes{} << plan << rows).hash(); }

std::uint64_t digest_of(const FoldedContent& content) {
  return (Bytes{} << content.content << content.rows << content.repeated_traces << content.kept << content.folded)
      .hash();
}

std::uint64_t seal_of(const std::string& schema_text, std::uint64_t plan, std::uint64_t run_count,
                      std::uint64_t content) {
  return (Bytes{} << schema_text << plan << run_count << content).hash();
}

}  // namespace fleetproof
