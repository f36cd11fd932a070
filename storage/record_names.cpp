#include "core/base/error.hpp"
#include "storage/records.hpp"

namespace fleetproof {

const char* name_of(EndPoint end_point) {
  switch (end_point) {
    case EndPoint::Violation:
      return "violation";
    case EndPoint::Contact:
      return "contact";
  }
  invariant_violated("an end point has a name");
}

const char* name_of(Region region) {
  switch (region) {
    case Region::Contract:
      return "contract";
    case Region::WorstCase:
      return "worst-case";
    case Region::All:
      return "all";
  }
  invariant_violated("a region has a name");
}

const char* name_of(GateKind kind) {
  switch (kind) {
    case GateKind::None:
      return "none";
    case GateKind::Rate:
      return "rate";
  }
  invariant_violated("a gate kind has a name");
}

}  // namespace fleetproof
