#include "storage/plan_rows.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>

#include "core/base/error.hpp"
#include "storage/row_fields.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

std::string in_lines(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += word + "\n";
  return text;
}

std::vector<std::string> from_lines(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start < text.size();) {
    const auto end = std::min(text.find('\n', start), text.size());
    words.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return words;
}

// "38 73 103": an assessor reads it with any tool.
std::string numbers_text(const std::vector<std::uint64_t>& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

std::vector<std::uint64_t> numbers_of(const std::string& text) {
  std::vector<std::uint64_t> numbers;
  const char* const end = text.data() + text.size();
  for (const char* next = text.data(); next != end;) {
    const auto [stop, error] = std::from_chars(next, end, numbers.emplace_back());
    if (error != std::errc{} || (stop != end && *stop != ' ')) throw EngineError("a gate holds a broken table");
    next = stop == end ? end : stop + 1;
  }
  return numbers;
}

template <HasWords Enum>
Enum word_to(const std::string& word) {
  if (const auto value = value_of<Enum>(word)) return *value;
  throw EngineError(fmt::format("the plan holds the unknown word \"{}\"", word));
}

}  // namespace

void bind_campaign(Insert& insert, const CampaignRecord& campaign, std::uint64_t plan_checksum) {
  Binder(insert) << std::uint32_t{1} << campaign.name << campaign.kind << campaign.seed << campaign.replicates
                 << campaign.plan_json << campaign.plan_hash << campaign.engine.version
                 << campaign.engine.program_sha256 << campaign.engine.compiler << campaign.engine.flags
                 << campaign.engine.libraries << in_lines(campaign.required_probes) << campaign.sampling
                 << in_lines(campaign.held_streams) << campaign.held_replicate << campaign.exempt_purposes
                 << campaign.exempt_radius_m << in_lines(campaign.exempt_pairs) << in_lines(campaign.plugin_agents)
                 << plan_checksum << campaign.chunk_runs << name_of(campaign.keep)
                 << in_lines(campaign.deterministic_agents) << in_lines(campaign.agents_under_test)
                 << campaign.engine.source_commit;
}

void bind_cell(Insert& insert, const CellRecord& cell) {
  Binder(insert) << cell.index << cell.agent << cell.layout << cell.fleet_size << cell.lowest << cell.highest;
}

void bind_gate(Insert& insert, const GateRecord& gate) {
  Binder(insert) << gate.index << gate.name << gate.agent << name_of(gate.kind) << name_of(gate.end_point)
                 << name_of(gate.region) << gate.limit << gate.confidence << gate.min_transports_per_agv_hour
                 << gate.requirement << gate.where.layout << name_of(gate.unit) << name_of(gate.method) << gate.decides
                 << numbers_text(gate.table.passes_from) << numbers_text(gate.table.refuted_up_to)
                 << gate.where.fleet_size << gate.where.factors;
}

CampaignRecord read_campaign(const Row& row) {
  Taker from(row);
  CampaignRecord campaign;
  from.i64();
  campaign.name = from.text();
  campaign.kind = from.text();
  campaign.seed = from.u64();
  campaign.replicates = from.u64();
  campaign.plan_json = from.text();
  campaign.plan_hash = from.u64();
  campaign.engine.version = from.text();
  campaign.engine.program_sha256 = from.text();
  campaign.engine.compiler = from.text();
  campaign.engine.flags = from.text();
  campaign.engine.libraries = from.text();
  campaign.required_probes = from_lines(from.text());
  campaign.sampling = from.text();
  campaign.held_streams = from_lines(from.text());
  campaign.held_replicate = from.u64();
  campaign.exempt_purposes = from.text();
  campaign.exempt_radius_m = from.real();
  campaign.exempt_pairs = from_lines(from.text());
  campaign.plugin_agents = from_lines(from.text());
  from.u64();  // the checksum of the plan
  campaign.chunk_runs = from.u64();
  campaign.keep = word_to<Keep>(from.text());
  campaign.deterministic_agents = from_lines(from.text());
  campaign.agents_under_test = from_lines(from.text());
  campaign.engine.source_commit = from.text();
  campaign.horizon_s = from.maybe_real().value_or(0.0);
  campaign.audit_share = from.maybe_real().value_or(0.0);
  return campaign;
}

std::uint64_t read_plan_checksum(const Query& row) {
  return std::bit_cast<std::uint64_t>(row.number(row.column_of("plan_checksum")));
}

CellRecord read_cell(const Row& row) {
  Taker from(row);
  CellRecord cell;
  cell.index = from.u32();
  cell.agent = from.text();
  cell.layout = from.text();
  cell.fleet_size = from.u32();
  cell.lowest = from.factors();
  cell.highest = from.factors();
  return cell;
}

GateRecord read_gate(const Row& row) {
  Taker from(row);
  GateRecord gate;
  gate.index = from.u32();
  gate.name = from.text();
  gate.agent = from.text();
  gate.kind = word_to<GateKind>(from.text());
  gate.end_point = word_to<EndPoint>(from.text());
  gate.region = word_to<Region>(from.text());
  gate.limit = from.real();
  gate.confidence = from.real();
  gate.min_transports_per_agv_hour = from.real();
  gate.requirement = from.text();
  gate.where.layout = from.text();
  gate.unit = word_to<GateUnit>(from.text());
  gate.method = word_to<GateMethod>(from.text());
  gate.decides = from.flag();
  gate.table.passes_from = numbers_of(from.text());
  gate.table.refuted_up_to = numbers_of(from.text());
  gate.where.fleet_size = from.maybe_u32();
  gate.where.factors = from.named_factors();
  return gate;
}

}  // namespace fleetproof
