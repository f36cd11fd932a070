#pragma once

namespace fleetproof {

// The edge of a set of real numbers between a number inside and a number outside: the first double outside, so that an
// interval with these ends holds the whole set. Requires: `is_inside` changes once between the two.
template <class IsInside>
double edge_between(double inside, double outside, const IsInside& is_inside) {
  for (;;) {
    const double middle = inside + (outside - inside) / 2.0;
    if (middle == inside || middle == outside) return outside;
    (is_inside(middle) ? inside : outside) = middle;
  }
}

}  // namespace fleetproof
