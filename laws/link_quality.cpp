#include "laws/link_quality.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/outcome/trace_records.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kFirstSlots = 256;

}  // namespace

void SentMessages::note(std::uint64_t message_hash, AgvId receiver, SimTime at) {
  if (2 * (used_ + 1) > slots_.size()) grow();
  Slot& slot = slots_[slot_of(message_hash, receiver)];
  used_ += slot.at == SimTime::min() ? 1 : 0;
  slot = {message_hash, receiver, at};
}

SimTime SentMessages::last_sent(std::uint64_t message_hash, AgvId receiver) const {
  return slots_.empty() ? SimTime::min() : slots_[slot_of(message_hash, receiver)].at;
}

std::size_t SentMessages::slot_of(std::uint64_t message_hash, AgvId receiver) const {
  const std::size_t last = slots_.size() - 1;
  const std::uint64_t key = message_hash ^ (std::uint64_t{receiver.value} * 0x9e3779b97f4a7c15ULL);
  for (std::size_t at = key & last;; at = (at + 1) & last) {
    const Slot& slot = slots_[at];
    const bool is_here = slot.message_hash == message_hash && slot.receiver == receiver;
    if (is_here || slot.at == SimTime::min()) return at;
  }
}

void SentMessages::grow() {
  const std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(std::max(kFirstSlots, 2 * slots_.size())));
  for (const Slot& slot : before) {
    if (slot.at != SimTime::min()) slots_[slot_of(slot.message_hash, slot.receiver)] = slot;
  }
}

namespace {

constexpr double kSignificance = 1e-4;
constexpr double kNormalQuantile = 3.7190164854556804;  // of 1 - 1e-4
constexpr std::uint32_t kExactUpTo = 512;
constexpr std::size_t kFirstParts = 16;  // of a short run

std::uint32_t exact_rejection(std::uint32_t n) {
  // Starts at the largest k: the tail P(X >= k) grows term by term until it exceeds the significance.
  double term = 1.0;  // P(X = n) = p^n
  for (std::uint32_t i = 0; i < n; ++i) term *= kContractLoss;
  double tail = 0.0;
  std::uint32_t k = n + 1;
  while (k > 0 && tail + term < kSignificance) {
    tail += term;
    --k;
    if (k == 0) break;
    // P(X = k - 1) from P(X = k)
    term *= static_cast<double>(k) / static_cast<double>(n - k + 1) * (1.0 - kContractLoss) / kContractLoss;
  }
  return k;
}

}  // namespace

std::uint32_t losses_that_reject(std::uint32_t receptions) {
  static const std::vector<std::uint32_t> table = [] {
    std::vector<std::uint32_t> all;
    for (std::uint32_t n = 0; n <= kExactUpTo; ++n) all.push_back(exact_rejection(n));
    return all;
  }();
  if (receptions <= kExactUpTo) return table[receptions];
  const double n = static_cast<double>(receptions);
  return static_cast<std::uint32_t>(
      std::ceil(kContractLoss * n + kNormalQuantile * std::sqrt(n * kContractLoss * (1.0 - kContractLoss)) + 0.5));
}

LinkQuality::LinkQuality(std::size_t participants) : participants_(participants) { waiting_.reserve(kFirstParts); }

LinkQuality::Link& LinkQuality::now(std::size_t sender, std::size_t receiver, std::int64_t second) {
  auto& row = places_[receiver];
  if (row.empty()) row.resize(participants_, kSilent);
  std::uint32_t& place = row[sender];
  if (place == kSilent) {
    place = static_cast<std::uint32_t>(links_.size());
    links_.push_back({static_cast<std::uint32_t>(receiver), true, {}, {}});
  }
  Link& link = links_[place].seconds[slot_of(second)];
  if (link.receptions == 0) received_[slot_of(second)].push_back(place);
  return link;
}

void LinkQuality::note_sent(const TraceRecord& record) {
  const auto sent = read<traced::Sent>(record);
  sent_[record.entity.index()].note(sent.message_hash, sent.receiver, record.at);
}

void LinkQuality::take(const TraceRecord& record, std::int64_t second) {
  if (record.kind == TraceKind::Sent) return note_sent(record);
  const auto reception = read<traced::Reception>(record);
  if (reception.sender.index() >= participants_ || record.entity.index() >= participants_) return;
  Link& link = now(reception.sender.index(), record.entity.index(), second);
  ++link.receptions;
  if (reception.is_lost()) {
    ++link.lost;
    return;
  }
  const SentMessages& by_sender = sent_[reception.sender.index()];
  const SimTime sent = std::max(by_sender.last_sent(reception.message_hash, record.entity),
                                by_sender.last_sent(reception.message_hash, AgvId{}));
  if (sent != SimTime::min()) link.longest = std::max(link.longest, record.at - sent);
}

// Many runs never ask.
void LinkQuality::note_let_go() {
  for (const TraceRecord& record : sent_and_let_go_) note_sent(record);
  sent_and_let_go_.clear();
}

void LinkQuality::take_before(SimTime end, std::int64_t second) {
  for (; next_waiting_ < waiting_.size(); ++next_waiting_) {
    TracePart& part = waiting_[next_waiting_];
    const std::uint32_t begin = part.begin;
    while (part.begin < part.end && part.block->at(part.begin) < end) {
      if (kMessageKinds.has(part.block->kind(part.begin)) && !part.block->is_copy(part.begin))
        take(part.block->record(part.begin), second);
      ++part.begin;
    }
    waiting_records_ -= part.begin - begin;
    if (part.begin < part.end) break;
    part.block.reset();
  }
  forget_taken_parts();
}

// Seldom enough to cost nothing.
void LinkQuality::forget_taken_parts() {
  if (2 * next_waiting_ < waiting_.size()) return;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(next_waiting_));
  next_waiting_ = 0;
}

void LinkQuality::skip_to(std::int64_t second) {
  make_room();
  places_.assign(participants_, {}), broken_.assign(participants_, 0);
  links_.clear();
  for (auto& places : received_) places.clear();
  const SimTime end = kStart + std::chrono::seconds(second);
  for (; next_waiting_ < waiting_.size(); ++next_waiting_) {
    TracePart& part = waiting_[next_waiting_];
    let_go_before(end, part);
    if (part.begin < part.end) break;
    part.block.reset();
  }
  forget_taken_parts();
}

// A block knows which of its records are about messages that were sent.
void LinkQuality::let_go_before(SimTime end, TracePart& part) {
  const std::uint32_t begin = part.begin;
  if (part.block->at(part.end - 1) < end) {
    part.begin = part.end;
  } else {
    while (part.block->at(part.begin) < end) ++part.begin;
  }
  for (const TraceBlock::Sent& sent : part.block->sent()) {
    if (sent.place >= begin && sent.place < part.begin) sent_and_let_go_.push_back(part.block->record(sent.place));
  }
  waiting_records_ -= part.begin - begin;
}

void LinkQuality::make_room() {
  if (places_.empty()) places_.resize(participants_), broken_.resize(participants_), sent_.resize(participants_);
}

// Only links that received in the second that leaves the window, or in the one that comes into it, can have changed.
void LinkQuality::end_second(std::int64_t second) {
  make_room();
  note_let_go();
  const SimTime end = kStart + std::chrono::seconds(second + 1);
  take_before(end, second);
  auto& leaves = received_[slot_of(second - kQualityWindow_s)];
  for (const std::uint32_t place : leaves) {
    take_out(links_[place], second - kQualityWindow_s);
    judge(links_[place]);
  }
  leaves.clear();
  for (const std::uint32_t place : received_[slot_of(second)]) {
    Active& link = links_[place];
    const Link& comes = link.seconds[slot_of(second)];
    link.sum.receptions += comes.receptions;
    link.sum.lost += comes.lost;
    link.sum.longest = std::max(link.sum.longest, comes.longest);
    judge(link);
  }
}

void LinkQuality::take_out(Active& link, std::int64_t second) {
  Link& leaves = link.seconds[slot_of(second)];
  link.sum.receptions -= leaves.receptions;
  link.sum.lost -= leaves.lost;
  const bool was_longest = leaves.longest == link.sum.longest;
  leaves = {};
  if (!was_longest) return;
  link.sum.longest = {};
  for (std::int64_t i = 1; i < kQualityWindow_s; ++i)
    link.sum.longest = std::max(link.sum.longest, link.seconds[slot_of(second + i)].longest);
}

void LinkQuality::judge(Active& link) {
  const bool kept = link.sum.in_contract();
  if (kept == link.in_contract) return;
  link.in_contract = kept;
  kept ? --broken_[link.receiver] : ++broken_[link.receiver];
}

LinkQuality::Link LinkQuality::link(std::size_t sender, std::size_t receiver) const {
  const std::uint32_t place = places_.empty() || places_[receiver].empty() ? kSilent : places_[receiver][sender];
  return place == kSilent ? Link{} : links_[place].sum;
}

std::int64_t LinkQuality::worst_loss_ppm(std::size_t receiver) const {
  std::int64_t worst = 0;
  for (std::size_t sender = 0; sender < participants_; ++sender) {
    const Link one = link(sender, receiver);
    if (one.receptions > 0) worst = std::max(worst, std::int64_t{1'000'000} * one.lost / one.receptions);
  }
  return worst;
}

}  // namespace fleetproof
