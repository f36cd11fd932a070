#include "laws/link_quality.hpp"

#include <algorithm>
#include <cmath>

#include "core/outcome/trace_records.hpp"

namespace fleetproof {
namespace {

constexpr double kSignificance = 1e-4;
constexpr double kNormalQuantile = 3.7190164854556804;  // of 1 - 1e-4
constexpr std::uint32_t kExactUpTo = 512;

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

LinkQuality::LinkQuality(std::size_t agvs) : agvs_(agvs), seconds_(agvs * agvs), last_second_(agvs, -1), sent_(agvs) {}

LinkQuality::Link& LinkQuality::now(std::size_t sender, std::size_t receiver, SimTime at) {
  const std::int64_t number = to_ns(at) / 1'000'000'000;
  Second& second = seconds_[receiver * agvs_ + sender][static_cast<std::size_t>(number % kQualityWindow_s)];
  if (second.number != number) second = {number, {}};
  last_second_[receiver] = std::max(last_second_[receiver], number);
  return second.link;
}

void LinkQuality::note(const TraceRecord& record) {
  if (record.kind == TraceKind::Sent) {
    const auto sent = read<traced::Sent>(record);
    sent_[record.entity.index()].note(sent.message_hash, sent.receiver, record.at);
    return;
  }
  const auto reception = read<traced::Reception>(record);
  const std::size_t sender = reception.sender.index();
  if (sender >= agvs_ || record.entity.index() >= agvs_) return;
  Link& link = now(sender, record.entity.index(), record.at);
  ++link.receptions;
  if (reception.is_lost()) {
    ++link.lost;
    return;
  }
  const SentMessages& by_sender = sent_[sender];
  const SimTime sent = std::max(by_sender.last_sent(reception.message_hash, AgvId{record.entity.value}),
                                by_sender.last_sent(reception.message_hash, AgvId{}));
  if (sent != SimTime::min()) link.longest = std::max(link.longest, record.at - sent);
}

LinkQuality::Link LinkQuality::link(std::size_t sender, std::size_t receiver, std::int64_t second) const {
  Link sum;
  for (const Second& one : seconds_[receiver * agvs_ + sender]) {
    if (one.number < 0 || one.number > second || one.number <= second - kQualityWindow_s) continue;
    sum.receptions += one.link.receptions;
    sum.lost += one.link.lost;
    sum.longest = std::max(sum.longest, one.link.longest);
  }
  return sum;
}

bool LinkQuality::all_in_contract(std::size_t receiver, std::int64_t second) const {
  // Without this line, a fleet that sends nothing would spend half of its run here, on links without a reception.
  if (last_second_[receiver] <= second - kQualityWindow_s) return true;
  for (std::size_t sender = 0; sender < agvs_; ++sender) {
    if (sender != receiver && !link(sender, receiver, second).in_contract()) return false;
  }
  return true;
}

std::int64_t LinkQuality::worst_loss_ppm(std::size_t receiver, std::int64_t second) const {
  std::int64_t worst = 0;
  for (std::size_t sender = 0; sender < agvs_; ++sender) {
    const Link one = link(sender, receiver, second);
    if (one.receptions > 0) worst = std::max(worst, std::int64_t{1'000'000} * one.lost / one.receptions);
  }
  return worst;
}

}  // namespace fleetproof
