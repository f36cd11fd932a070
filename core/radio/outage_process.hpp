#pragma once

#include <cstdint>

#include "core/base/sim_time.hpp"

namespace fleetproof {

// Which process a place in the radio has, and its randomness: pure functions of key, kind and the two numbers.
struct ProcessKey {
  std::uint64_t key = 0;
  std::uint32_t kind = 0;  // below 64
  std::uint32_t a = 0, b = 0;
};

// How long outages last and how much of the time they take.
struct OutageLaw {
  enum class Sojourn : std::uint8_t { Exponential, Lomax, Uniform };
  Sojourn sojourn = Sojourn::Exponential;
  double bad_share = 0.0;           // 0 .. 1
  double mean_bad_s = 1.0;          // Exponential, Lomax
  double shape = 1.5;               // Lomax: above 1
  double min_s = 0.0, max_s = 0.0;  // Uniform
};

// A stationary process of two states with exponential good sojourns, as a function of time: what it answers about t
// depends on key, law and t, never on what was asked before. Asking forward is cheap; asking back starts over at time
// zero.
//
// Exponential and Lomax: candidate ends form a Poisson process with the hazard rate that an outage has at age 0. In
// each stretch between two candidates a good state turns bad after (unit exponential) / (rate of outages). At a
// candidate an outage of age x ends with probability hazard(x) / hazard(0), which is 1 for exponential outages. All
// these draws are the same for every bad share, so that with a higher share the outages begin earlier, are older, and
// end at fewer candidates (the hazard of a Lomax outage falls with age): they *contain* those of a lower share.
// Uniform: window and gap take turns.
class OutageProcess {
 public:
  OutageProcess() = default;
  OutageProcess(const OutageLaw& law, const ProcessKey& key);

  bool bad_at(SimTime t);          // t >= kStart; an outage holds its first instant, not its last
  SimTime next_change(SimTime t);  // the first instant after t at which the state is another; kForever if it never is

 private:
  void start();
  void step();
  void draw_stretch();
  bool survives() const;

  OutageLaw law_{};
  ProcessKey key_{};
  double hazard_ = 0.0, scale_s_ = 0.0;  // of an outage: at age 0; of its Lomax law
  double mean_good_s_ = 0.0;
  std::uint64_t number_ = 0;           // of the stretch
  SimTime from_ = kForever, until_{};  // the stretch in hand: [from_, until_)
  SimTime bad_since_ = kForever;       // from then to until_ the state is bad
};

}  // namespace fleetproof
