#pragma once

#include <vector>

#include "core/geometry/pose.hpp"
#include "core/radio/message_key.hpp"
#include "core/radio/outage_process.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// External sources, see RadioSource. Each source has its own randomness, keyed by its number. Whether a source is on
// depends on key and time only. Whether it destroys a message depends on the message and the place of the receiver.
// The draws of one source do not depend on the other sources.
// Threads: one object serves one run on one thread.
class RadioSources {
 public:
  RadioSources(const std::vector<RadioSource>& sources, std::uint64_t key);

  // Whether a source destroys this message at a receiver at this place.
  bool destroy(const MessageKey& message, const Vec2& receiver_m);
  OutageProcess& on_process(std::size_t source) { return sources_[source].on; }  // "bad" means: the source is on

 private:
  struct Source {
    Vec2 at_m;
    double range_m, loss;
    OutageProcess on;
    std::uint64_t loss_key;
  };
  std::vector<Source> sources_;
};

}  // namespace fleetproof
