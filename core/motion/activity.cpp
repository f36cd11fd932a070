#include "core/motion/activity.hpp"

#include "core/base/error.hpp"

namespace fleetproof {

const char* name_of(ActivityKind kind) {
  switch (kind) {
    case ActivityKind::Drive:
      return "drive";
    case ActivityKind::Turn:
      return "turn";
    case ActivityKind::Transmit:
      return "transmit";
    case ActivityKind::Pick:
      return "pick";
    case ActivityKind::Drop:
      return "drop";
    case ActivityKind::Park:
      return "park";
    case ActivityKind::Charge:
      return "charge";
    case ActivityKind::Settle:
      return "settle";
    case ActivityKind::Dock:
      return "dock";
  }
  invariant_violated("an activity has a name");
}

}  // namespace fleetproof
