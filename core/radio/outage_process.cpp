#include "core/radio/outage_process.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// Each cycle has two blocks of draws: one for its lengths, one that decides whether an outage ends at its beginning.
// Cycle 0 begins at time zero, and its second block decides the state there.
enum class Use : std::uint32_t { Lengths = 0, Beginning = 1 };

Block draw(const ProcessKey& key, std::uint64_t number, Use use) {
  const std::uint32_t topic =
      (static_cast<std::uint32_t>(number >> 32) << 8) | (key.kind << 1) | static_cast<std::uint32_t>(use);
  return philox(key.key, {static_cast<std::uint32_t>(number), topic, key.a, key.b});
}

double unit_exponential(std::uint64_t bits) { return -natural_log(1.0 - unit_interval(bits)); }

constexpr Duration kShortest{1};  // every cycle takes time, so that the process advances

SimTime later(SimTime t, Duration by) { return by >= kForever - std::max(t, kStart) ? kForever : t + by; }

}  // namespace

OutageProcess::OutageProcess(const OutageLaw& law, const ProcessKey& key) : law_(law), key_(key) {
  if (law_.sojourn == OutageLaw::Sojourn::Lomax) {
    scale_s_ = law_.mean_bad_s * (law_.shape - 1.0);
    hazard_ = law_.shape / scale_s_;
  } else if (law_.sojourn == OutageLaw::Sojourn::Exponential) {
    hazard_ = 1.0 / law_.mean_bad_s;
  } else {
    law_.mean_bad_s = 0.5 * (law_.min_s + law_.max_s);
  }
  if (law_.bad_share > 0.0) mean_good_s_ = law_.mean_bad_s * (1.0 - law_.bad_share) / law_.bad_share;
}

bool OutageProcess::bad_at(SimTime t) {
  if (law_.bad_share <= 0.0) return false;
  if (law_.bad_share >= 1.0) return true;
  if (t < from_) start();
  while (until_ <= t) step();
  return bad_since_ <= t;
}

SimTime OutageProcess::next_change(SimTime t) {
  if (law_.bad_share <= 0.0 || law_.bad_share >= 1.0) return kForever;
  const bool bad = bad_at(t);
  if (!bad && bad_since_ != kForever) return bad_since_;
  do {
    step();
  } while (until_ != kForever && (bad ? bad_since_ <= from_ : bad_since_ == kForever));
  return bad ? from_ : bad_since_;
}

// The state at time zero has the stationary distribution. It is bad with the probability of the bad share. The age of
// an outage then has the density P(an outage is longer). The age is drawn in the same way for every bad share.
// Therefore an outage at a higher share is at least as old as at a lower share, from the beginning.
void OutageProcess::start() {
  number_ = 0;
  from_ = kStart;
  const Block block = draw(key_, 0, Use::Beginning);
  const bool bad = unit_interval(word64(block, 0)) < law_.bad_share;
  const double rest = 1.0 - unit_interval(word64(block, 1));
  if (law_.sojourn == OutageLaw::Sojourn::Uniform) {
    if (!bad) return draw_cycle();
    // An instant drawn at random lies in a long outage more often, in proportion to its length.
    const Block more = draw(key_, 0, Use::Lengths);
    const double low = law_.min_s * law_.min_s, high = law_.max_s * law_.max_s;
    const double length_s = std::sqrt(low + (high - low) * unit_interval(word64(more, 0)));
    bad_since_ = kStart - seconds(length_s * (1.0 - rest));
    until_ = later(kStart, std::max(seconds(length_s * rest), kShortest));
    return;
  }
  bad_since_ = kForever;
  if (bad) {
    const bool lomax = law_.sojourn == OutageLaw::Sojourn::Lomax;
    const double age_s = lomax ? scale_s_ * (natural_exp(-natural_log(rest) / (law_.shape - 1.0)) - 1.0)
                               : -natural_log(rest) * law_.mean_bad_s;
    bad_since_ = kStart - seconds(age_s);
  }
  draw_cycle();
}

void OutageProcess::step() {
  ++number_;
  from_ = until_;
  if (law_.sojourn == OutageLaw::Sojourn::Uniform || (bad_since_ != kForever && !survives())) bad_since_ = kForever;
  draw_cycle();
}

// Draws the end of the cycle, and the instant in it at which the state turns bad.
void OutageProcess::draw_cycle() {
  const Block block = draw(key_, number_, Use::Lengths);
  if (law_.sojourn == OutageLaw::Sojourn::Uniform) {
    bad_since_ = later(from_, seconds(unit_exponential(word64(block, 0)) * mean_good_s_));
    until_ =
        later(bad_since_,
              std::max(seconds(law_.min_s + (law_.max_s - law_.min_s) * unit_interval(word64(block, 1))), kShortest));
    return;
  }
  until_ = later(from_, std::max(seconds(unit_exponential(word64(block, 0)) / hazard_), kShortest));
  if (bad_since_ != kForever) return;
  const SimTime begin = later(from_, seconds(unit_exponential(word64(block, 1)) * mean_good_s_));
  if (begin < until_) bad_since_ = begin;
}

bool OutageProcess::survives() const {
  if (law_.sojourn != OutageLaw::Sojourn::Lomax) return false;
  const double mark = unit_interval(word64(draw(key_, number_, Use::Beginning), 0));
  return mark >= scale_s_ / (scale_s_ + to_seconds(from_ - bad_since_));
}

}  // namespace fleetproof
