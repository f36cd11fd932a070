#pragma once

#include <cstdint>

#include "core/base/sim_time.hpp"

namespace fleetproof {

// Identifies one process. All its draws are pure functions of key, kind and the two numbers.
struct ProcessKey {
  std::uint64_t key = 0;
  std::uint32_t kind = 0;  // below 64
  std::uint32_t a = 0, b = 0;
};

// How long outages last, and which share of the time they take.
struct OutageLaw {
  enum class Sojourn : std::uint8_t { Exponential, Lomax, Uniform };
  Sojourn sojourn = Sojourn::Exponential;
  double bad_share = 0.0;           // 0 .. 1
  double mean_bad_s = 1.0;          // Exponential, Lomax
  double shape = 1.5;               // Lomax: above 1
  double min_s = 0.0, max_s = 0.0;  // Uniform
};

// A stationary process with two states, good and bad, as a function of time. Good sojourns are exponential. The answer
// for t depends on key, law and t, and not on earlier questions. A question about a later time is cheap; a question
// about an earlier time starts the process again at time zero.
//
// Exponential and Lomax outages: candidate ends form a Poisson process. Its rate is the hazard rate of an outage of
// age 0. Between two candidates, a good state turns bad after (unit exponential draw) / (rate of outages). At a
// candidate, an outage of age x ends with probability hazard(x) / hazard(0), which is 1 for exponential outages. These
// draws are the same for every bad share. With a higher share, outages begin earlier, are older, and end at fewer
// candidates, because the hazard of a Lomax outage falls with age. They therefore *contain* the outages at a lower
// share. Uniform outages: windows and gaps alternate.
// Threads: one object serves one run on one thread.
class OutageProcess {
 public:
  OutageProcess() = default;
  OutageProcess(const OutageLaw& law, const ProcessKey& key);

  // Requires: t >= kStart. The first instant of an outage belongs to the outage, its last instant does not.
  bool bad_at(SimTime t);
  // The first instant after t at which the state changes; kForever if it never changes.
  SimTime next_change(SimTime t);

 private:
  void start();
  void step();
  void draw_cycle();
  bool survives() const;

  OutageLaw law_{};
  ProcessKey key_{};
  double hazard_ = 0.0, scale_s_ = 0.0;  // the hazard rate of an outage at age 0; the scale of the Lomax law
  double mean_good_s_ = 0.0;
  std::uint64_t number_ = 0;           // number of the current cycle
  SimTime from_ = kForever, until_{};  // the current cycle: [from_, until_)
  SimTime bad_since_ = kForever;       // the state is bad from here to until_
};

}  // namespace fleetproof
