#include "storage/folded_cell.hpp"

#include <algorithm>

#include "core/outcome/probe_names.hpp"

namespace fleetproof {
namespace {

// Of the first number of a run. 0 and 1 stand for runs that are kept, so the others begin at 2. Without repetitions, 0
// alone does, and they begin at 1.
constexpr std::uint64_t kKept = 0, kKeptRepetition = 1;
constexpr std::uint64_t kHasClearance = 1, kHasSafeMode = 2, kBeyondContract = 4, kRepeats = 8, kTransports = 16;
constexpr std::uint64_t kTransportsWithoutRepeats = 8;

std::uint64_t first_folded(FoldEncoding encoding) { return encoding == FoldEncoding::WithRepeats ? 2 : 1; }

// Seven bits a byte, the lowest first; the last byte has no top bit.
void put_number(std::string& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(value | 0x80)));
  bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(value)));
}

[[noreturn]] void broken() { throw BrokenFold("a row of folded runs is broken"); }

}  // namespace

bool FoldedCell::suits(const Outcome& outcome) const {
  return runs_ == 0 || (outcome.simulated_ns == simulated_ns_ && outcome.agv_count == agv_count_);
}

void FoldedCell::meet(ProbeSource source, const std::string& name, std::uint64_t times) {
  MetTotal& total = met_.try_emplace({source, name}, MetTotal{source, name, 0, 0}).first->second;
  ++total.runs;
  total.times += times;
}

void FoldedCell::keep(bool repeats) {
  put_number(bytes_, repeats ? kKeptRepetition : kKept);
  keeps_a_repetition_ |= repeats;
}

void FoldedCell::fold(const RunRecord& run, std::uint64_t checksum) {
  const Outcome& outcome = run.outcome;
  ensure(suits(outcome), "runs that are folded together are alike");
  ++runs_;
  simulated_ns_ = outcome.simulated_ns;
  agv_count_ = outcome.agv_count;
  transports_done_ += outcome.counters.transports_done;
  std::uint64_t encounters = 0;
  for (const ProbeCount& probe : outcome.probes) {
    meet(probe.source, probe.name, probe.count);
    if (probe.source == ProbeSource::World && is_encounter_probe(probe.name)) encounters += probe.count;
  }
  if (encounters > 0) meet(ProbeSource::World, std::string(kEncounterProbe), encounters);

  const auto& clearance_um = outcome.min_clearance_um;
  const std::uint64_t safe_mode_ns = outcome.counters.safe_mode_ns;
  put_number(bytes_, first_folded(FoldEncoding::WithRepeats) + outcome.counters.transports_done * kTransports +
                         (clearance_um ? kHasClearance : 0) + (safe_mode_ns > 0 ? kHasSafeMode : 0) +
                         (run.factors.in_contract() ? 0 : kBeyondContract) + (run.repeats ? kRepeats : 0));
  bytes_.push_back(static_cast<char>(static_cast<std::uint8_t>(checksum)));
  bytes_.push_back(static_cast<char>(static_cast<std::uint8_t>(checksum >> 8)));
  if (clearance_um) {
    ensure(*clearance_um >= 0, "a clearance is not negative");
    put_number(bytes_, static_cast<std::uint64_t>(*clearance_um));
    min_clearance_um_ = std::min(min_clearance_um_.value_or(*clearance_um), *clearance_um);
  }
  if (safe_mode_ns > 0) put_number(bytes_, safe_mode_ns);
}

std::string FoldedCell::content() const {
  std::string content;
  put_number(content, met_.size());
  for (const auto& [key, total] : met_) {
    content.push_back(total.source == ProbeSource::World ? '\0' : '\1');
    put_number(content, total.name.size());
    content += total.name;
    put_number(content, total.runs);
    put_number(content, total.times);
  }
  return content + bytes_;
}

UnfoldedCell::UnfoldedCell(std::string content, FoldEncoding encoding)
    : content_(std::move(content)), encoding_(encoding) {
  const std::uint64_t count = number();
  for (std::uint64_t i = 0; i < count; ++i) {
    MetTotal& total = met_.emplace_back();
    total.source = text(1) == std::string(1, '\0') ? ProbeSource::World : ProbeSource::Agent;
    total.name = text(number());
    total.runs = number();
    total.times = number();
  }
}

bool UnfoldedCell::next_is_folded_and_new() const {
  if (at_end()) return false;
  const auto byte = static_cast<unsigned char>(content_[at_]);  // its lowest bits hold the flags
  if (byte < first_folded(encoding_)) return false;
  return encoding_ == FoldEncoding::WithoutRepeats || ((byte - first_folded(encoding_)) & kRepeats) == 0;
}

UnfoldedRun UnfoldedCell::next() {
  const bool with_repeats = encoding_ == FoldEncoding::WithRepeats;
  const std::uint64_t first = number(), kept = first_folded(encoding_);
  if (first < kept) return {std::nullopt, first == kKeptRepetition};
  const std::uint64_t said = first - kept;
  FoldedRun run;
  run.transports_done = said / (with_repeats ? kTransports : kTransportsWithoutRepeats);
  run.in_contract = (said & kBeyondContract) == 0;
  run.repeats = with_repeats && (said & kRepeats) != 0;
  const std::string check = text(2);
  run.check = static_cast<std::uint16_t>(static_cast<unsigned char>(check[0]) |
                                         static_cast<unsigned>(static_cast<unsigned char>(check[1])) << 8);
  if ((said & kHasClearance) != 0) run.min_clearance_um = static_cast<std::int64_t>(number());
  if ((said & kHasSafeMode) != 0) run.safe_mode_ns = number();
  return {run, run.repeats};
}

std::uint64_t UnfoldedCell::number() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    if (at_ >= content_.size()) broken();
    const auto byte = static_cast<unsigned char>(content_[at_++]);
    value |= std::uint64_t{byte & 0x7fU} << shift;
    if ((byte & 0x80U) == 0) return value;
  }
  broken();
}

std::string UnfoldedCell::text(std::size_t size) {
  if (size > content_.size() - at_) broken();
  at_ += size;
  return content_.substr(at_ - size, size);
}

}  // namespace fleetproof
