#include "reports/evidence/envelope.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/release_gate.hpp"

namespace fleetproof {

std::vector<std::vector<double>> envelope_p_values(const EnvelopeGrid& grid, double limit) {
  ensure(!grid.empty() && !grid.front().empty(), "a grid has cells");
  std::vector<std::vector<double>> p_values;
  for (const auto& row : grid) {
    ensure(row.size() == grid.front().size(), "the rows of a grid have one length");
    auto& of_row = p_values.emplace_back();
    for (const EnvelopeCell& cell : row) of_row.push_back(probability_of_at_most(cell.failing, cell.units, limit));
  }
  return p_values;
}

std::vector<std::vector<double>> any_time_p_values(const EnvelopeGrid& grid, double limit) {
  std::vector<std::vector<double>> p_values;
  for (const auto& row : grid) {
    auto& of_row = p_values.emplace_back();
    for (const EnvelopeCell& cell : row) {
      const double log_e = cell.units == 0 ? 0.0 : log_e_values(cell.failing, cell.units, limit).gate;
      of_row.push_back(std::min(1.0, std::exp(-log_e)));
    }
  }
  return p_values;
}

std::vector<std::vector<bool>> safe_envelope(const EnvelopeGrid& grid, double limit, Confidence confidence) {
  return predecessor_rule(envelope_p_values(grid, limit), confidence);
}

std::vector<std::vector<bool>> predecessor_rule(const std::vector<std::vector<double>>& p_values, Confidence confidence,
                                                const std::vector<std::vector<bool>>& known) {
  const std::size_t rows = p_values.size(), columns = p_values.front().size();
  const double risk = confidence.risk() / static_cast<double>(std::min(rows, columns));
  std::vector claimed(rows, std::vector<bool>(columns));
  for (std::size_t loss = 0; loss < rows; ++loss) {
    for (std::size_t delay = 0; delay < columns; ++delay) {
      const bool less_loss = loss == 0 || claimed[loss - 1][delay];
      const bool less_delay = delay == 0 || claimed[loss][delay - 1];
      const bool is_known = !known.empty() && known[loss][delay];
      claimed[loss][delay] = is_known || (less_loss && less_delay && p_values[loss][delay] <= risk);
    }
  }
  return claimed;
}

std::vector<std::vector<bool>> bonferroni_envelope(const EnvelopeGrid& grid, double limit, Confidence confidence) {
  std::vector<std::vector<bool>> claimed;
  const double cells = static_cast<double>(grid.size()) * static_cast<double>(grid.front().size());
  for (const auto& row : envelope_p_values(grid, limit)) {
    auto& of_row = claimed.emplace_back();
    for (const double p_value : row) of_row.push_back(p_value <= confidence.risk() / cells);
  }
  return claimed;
}

EnvelopeCell monotone_pool(const EnvelopeGrid& grid, const EnvelopePlace& place) {
  EnvelopeCell pool;
  for (std::size_t loss = place.loss; loss < grid.size(); ++loss) {
    for (std::size_t delay = place.delay; delay < grid[loss].size(); ++delay) {
      pool.failing += grid[loss][delay].failing;
      pool.units += grid[loss][delay].units;
    }
  }
  return pool;
}

std::size_t claimed_on_path(const EnvelopeGrid& grid, const std::vector<EnvelopePlace>& path, double limit,
                            Confidence confidence) {
  std::size_t claimed = 0;
  for (const EnvelopePlace& place : path) {
    const EnvelopeCell& cell = grid.at(place.loss).at(place.delay);
    if (probability_of_at_most(cell.failing, cell.units, limit) > confidence.risk()) break;
    ++claimed;
  }
  return claimed;
}

}  // namespace fleetproof
