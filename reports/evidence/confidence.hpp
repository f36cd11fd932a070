#pragma once

namespace fleetproof {

// How sure a statement is to be: 0.95 is a risk of 0.05 that it is wrong. The risk is kept, because a difference like
// 1 - 0.999999 has only ten correct digits.
class Confidence {
 public:
  // The risk is what the decimal digits leave: 0.999999 leaves 1e-6. Requires: 0 < confidence < 1.
  Confidence(double confidence);
  // Requires: 0 < risk < 1.
  static Confidence with_risk(double risk);

  double risk() const { return risk_; }
  // The same statement with one part of the risk, as each of `parts` statements gets it. Requires: parts > 0.
  Confidence shared(double parts) const { return with_risk(risk_ / parts); }

 private:
  Confidence() = default;

  double risk_ = 0.05;
};

}  // namespace fleetproof
