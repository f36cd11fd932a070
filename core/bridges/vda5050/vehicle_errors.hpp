#pragma once

#include <string>
#include <vector>

#include "core/bridges/vda5050/order_check.hpp"

namespace fleetproof::bridges::vda5050 {

// The active errors of a vehicle. Those of the body stay until the body clears them; what is wrong with a message of
// the master stays until an order or an order update is accepted (6.6.4).
class VehicleErrors {
 public:
  explicit VehicleErrors(std::size_t most) : most_(most) {}

  // One of each type at a time. False: it is active already, as it is.
  bool raise(const Error& error);
  bool clear(std::string_view error_type);
  // A warning. The same one again is kept once; of too many, the oldest goes.
  void reject(const Refusal& refusal, std::vector<Reference> references);
  void accepted() { rejections_.clear(); }

  std::vector<Error> active() const;

 private:
  std::size_t most_;
  std::vector<Error> of_body_, rejections_;
};

}  // namespace fleetproof::bridges::vda5050
