#include "reports/evidence/confidence.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace fleetproof {

Confidence::Confidence(double confidence) {
  ensure(confidence > 0.0 && confidence < 1.0, "a confidence lies between 0 and 1");
  constexpr double kDecimals = 1e15;  // a double keeps no more of a confidence
  const double nearest = std::round((1.0 - confidence) * kDecimals) / kDecimals;
  risk_ = 1.0 - nearest == confidence ? nearest : 1.0 - confidence;
}

Confidence Confidence::with_risk(double risk) {
  ensure(risk > 0.0 && risk < 1.0, "a risk lies between 0 and 1");
  Confidence confidence;
  confidence.risk_ = risk;
  return confidence;
}

}  // namespace fleetproof
