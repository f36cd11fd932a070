#include "core/scenario/segment.hpp"

#include <algorithm>

namespace fleetproof {

bool Segment::permits(std::string_view vehicle_type, bool loaded) const {
  return permissions.empty() || std::ranges::any_of(permissions, [&](const Permission& permission) {
           return (permission.vehicle_type.empty() || vehicle_type.empty() ||
                   permission.vehicle_type == vehicle_type) &&
                  permission.load != (loaded ? LoadState::Empty : LoadState::Loaded);
         });
}

}  // namespace fleetproof
