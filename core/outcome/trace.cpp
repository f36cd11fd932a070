#include "core/outcome/trace.hpp"

#include <algorithm>

// The library's own choice of instructions for the processor, where it has one. The digest is the same with each.
#if defined(FLEETPROOF_XXHASH_DISPATCHES) && __has_include(<xxh_x86dispatch.h>)
#include <xxh_x86dispatch.h>
#else
#define XXH_INLINE_ALL
#include <xxhash.h>
#endif

namespace fleetproof {
namespace {

XXH3_state_t* hash(void* state) { return static_cast<XXH3_state_t*>(state); }

const char* name_beside_digest(TraceKind kind) {
  return kind == TraceKind::Described      ? "described"
         : kind == TraceKind::AgentState   ? "state"
         : kind == TraceKind::Belief       ? "believes"
         : kind == TraceKind::NotesLeftOut ? "notes left out"
         : kind == TraceKind::CallAccepted ? "accepted"
         : kind == TraceKind::Denied       ? "denied"
                                           : "delivery";
}

const char* name_of_loss(TraceKind kind) {
  return kind == TraceKind::Lost                 ? "lost"
         : kind == TraceKind::LostInOutage       ? "lost in an outage"
         : kind == TraceKind::LostByInterference ? "lost by interference"
                                                 : "lost to an external source";
}

// A block that nobody keeps. Each thread has some that are used again and again: they are so large that the allocator
// takes long for them, and laws keep all of a run.
std::shared_ptr<TraceBlock> free_block() {
  constexpr std::size_t kMost = 64;  // 1.3 MB
  thread_local std::vector<std::shared_ptr<TraceBlock>> blocks;
  thread_local std::size_t newest = 0;  // the block that was given last; those after it were given longest ago
  for (const std::size_t next : {newest, newest + 1 < blocks.size() ? newest + 1 : 0}) {
    if (next >= blocks.size() || blocks[next].use_count() > 1) continue;
    newest = next;
    blocks[next]->begin_anew();
    return blocks[next];
  }
  auto block = std::make_shared_for_overwrite<TraceBlock>();
  if (blocks.size() == kMost) return block;
  newest = std::min(newest + 1, blocks.size());
  blocks.insert(blocks.begin() + static_cast<std::ptrdiff_t>(newest), block);
  return block;
}

}  // namespace

const char* name_of(TraceKind kind) {
  switch (kind) {
    case TraceKind::ActivityBegins:
      return "begins";
    case TraceKind::ActivityEnds:
      return "ends";
    case TraceKind::OrderReleased:
      return "order";
    case TraceKind::TransportDone:
      return "transport done";
    case TraceKind::Sent:
      return "sent";
    case TraceKind::Received:
      return "received";
    case TraceKind::TimerWentOff:
      return "timer";
    case TraceKind::CallRefused:
      return "refused";
    case TraceKind::Contact:
      return "contact";
    case TraceKind::SafeMode:
      return "safe mode";
    case TraceKind::WaitingFor:
      return "waiting for";
    case TraceKind::Probe:
      return "probe";
    case TraceKind::Log:
      return "log";
    case TraceKind::AgentCrashed:
    case TraceKind::AgentHung:
      return kind == TraceKind::AgentHung ? "agent hung" : "agent crashed";
    case TraceKind::LoadMoves:
      return "load moves";
    case TraceKind::BatteryEmpty:
      return "battery empty";
    case TraceKind::FaultStrikes:
      return "fault";
    case TraceKind::FaultOver:
      return "fault over";
    case TraceKind::ScannerStops:
      return "scanner stops";
    case TraceKind::OperatorAssists:
      return "operator assists";
    case TraceKind::Appears:
    case TraceKind::Leaves:
      return kind == TraceKind::Appears ? "appears" : "leaves";
    case TraceKind::StoppedByAgent:
      return "stop by agent";
    case TraceKind::OrderWithdrawn:
      return "order withdrawn";
    case TraceKind::WorksOn:
      return "works on";
    case TraceKind::Kept:
      return "kept";
    case TraceKind::Lost:
    case TraceKind::LostInOutage:
    case TraceKind::LostByInterference:
    case TraceKind::LostToSource:
      return name_of_loss(kind);
    case TraceKind::Described:
    case TraceKind::AgentState:
    case TraceKind::Belief:
    case TraceKind::NotesLeftOut:
    case TraceKind::DeliveryDecided:
    case TraceKind::CallAccepted:
    case TraceKind::Denied:
      return name_beside_digest(kind);
  }
  return "?";
}

TraceDigest::TraceDigest()
    : state_(XXH3_createState()), block_(free_block()), next_(block_->bytes_to(0)), pause_(block_->bytes_to(1)) {
  XXH3_64bits_reset(hash(state_));
}
TraceDigest::~TraceDigest() { XXH3_freeState(hash(state_)); }

void TraceDigest::pause() {
  const std::uint64_t count = record_count();
  if ((count & (count - 1)) == 0) running_.push_back(value());  // std::has_single_bit counts bits, which costs a call
  if (count % TraceBlock::kRecords == 0) end_block();
  // A block ends at each later power of two.
  pause_ = block_->bytes_to(count < TraceBlock::kRecords ? 2 * count : TraceBlock::kRecords);
}

void TraceDigest::end_block() {
  flush();
  if (full_ != nullptr) full_(reader_);
  taken_ = before_block_ = record_count();
  block_.reset();
  block_ = free_block();  // another one, if somebody keeps that
  next_ = block_->bytes_to(0);
}

TracePart TraceDigest::take_newest() {
  const std::uint64_t count = record_count(), first = taken_ / TraceBlock::kRecords * TraceBlock::kRecords;
  const TracePart part{block_, static_cast<std::uint32_t>(taken_ - first), static_cast<std::uint32_t>(count - first)};
  taken_ = count;
  return part;
}

void TraceDigest::mark_copy() { block_->mark_copy(next_); }

std::uint64_t TraceDigest::value() {
  flush();
  return XXH3_64bits_digest(hash(state_));
}

// Of the block, what was not flushed before. It is flushed whenever it is full.
void TraceDigest::flush() {
  const std::uint64_t count = record_count();
  XXH3_64bits_update(hash(state_), block_->bytes_from(flushed_ - before_block_),
                     (count - flushed_) * TraceBlock::kRecordBytes);
  flushed_ = count;
}

}  // namespace fleetproof
