#pragma once

#include <array>
#include <cstdint>

#include "core/agents/path.hpp"

namespace fleetproof::agents {

// The way that an AGV announces from the end of its held path: first what it requests, then where it means to go on.
// Every message contains it, so another AGV knows of a lane what its newest message said. Instants are the stamps of
// messages.
class AnnouncedWay {
 public:
  const Path& path() const { return path_; }

  // From now on, messages contain this way; `first_ms` is the first stamp of which this is true of each message.
  // Lanes with which the former way began, too, have been announced since then.
  void replace(const Path& way, std::uint32_t first_ms);
  // The first lanes are held now. Requires: the way has so many.
  void shorten(const MapView& map, std::uint32_t lanes);
  // Each message with this stamp or a later one contains the first `lanes` of the way. Requires: the way has so many.
  std::uint32_t since_ms(std::uint32_t lanes) const { return lanes == 0 ? 0 : since_ms_[lanes - 1]; }

 private:
  Path path_;
  std::array<std::uint32_t, kPathLanesMax> since_ms_{};  // by lane; never less than that of the lane before
};

}  // namespace fleetproof::agents
