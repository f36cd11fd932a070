#include "core/scenario/faults.hpp"

#include "core/base/outside_text.hpp"

namespace fleetproof {

std::string text_of(const Fault& fault) {
  const std::string kind = name_of(fault.kind);
  if (fault.kind != Fault::Kind::Named) return kind;
  return kind + " " + printable(fault.word) + " " + std::to_string(fault.number);
}

}  // namespace fleetproof
