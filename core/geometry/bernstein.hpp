#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace fleetproof {

// A polynomial of degree N on [0, 1] in the basis of Bernstein. Its values lie between its least and its largest
// coefficient.
template <std::size_t N>
using Bernstein = std::array<double, N + 1>;

constexpr double binomial(std::size_t n, std::size_t k) {
  double result = 1.0;
  for (std::size_t i = 0; i < k; ++i) result = result * static_cast<double>(n - i) / static_cast<double>(i + 1);
  return result;
}

template <std::size_t M, std::size_t N>
constexpr std::array<std::array<double, N + 1>, M + 1> product_weights() {
  std::array<std::array<double, N + 1>, M + 1> weights{};
  for (std::size_t i = 0; i <= M; ++i) {
    for (std::size_t j = 0; j <= N; ++j) weights[i][j] = binomial(M, i) * binomial(N, j) / binomial(M + N, i + j);
  }
  return weights;
}

template <std::size_t A, std::size_t B>
std::array<double, A + B - 1> product(const std::array<double, A>& p, const std::array<double, B>& q) {
  static constexpr auto kWeights = product_weights<A - 1, B - 1>();
  std::array<double, A + B - 1> result{};
  for (std::size_t i = 0; i < A; ++i) {
    for (std::size_t j = 0; j < B; ++j) result[i + j] += kWeights[i][j] * p[i] * q[j];
  }
  return result;
}

template <std::size_t A>
std::array<double, A - 1> derivative(const std::array<double, A>& p) {
  std::array<double, A - 1> result{};
  for (std::size_t i = 0; i + 1 < A; ++i) result[i] = static_cast<double>(A - 1) * (p[i + 1] - p[i]);
  return result;
}

// p + factor * q.
template <std::size_t A>
std::array<double, A> sum(const std::array<double, A>& p, double factor, const std::array<double, A>& q) {
  std::array<double, A> result{};
  for (std::size_t i = 0; i < A; ++i) result[i] = p[i] + factor * q[i];
  return result;
}

// No value on [0, 1] is farther from zero.
template <std::size_t A>
double most_of(const std::array<double, A>& p) {
  double most = 0.0;
  for (const double c : p) most = std::max(most, c < 0.0 ? -c : c);
  return most;
}

}  // namespace fleetproof
