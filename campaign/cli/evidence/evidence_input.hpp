#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/evidence/confidence.hpp"

namespace fleetproof::cli {

// An argument of the methods of `fleetproof evidence`: the name of its option, and what it means.
struct EvidenceArgument {
  std::string_view name, text;
};
std::span<const EvidenceArgument> evidence_arguments();

// The arguments of one method as the user typed them, checked when they are read. Each function throws InputError with
// the option, its value and what is allowed. An argument that was not given and has no fallback is an error.
class EvidenceInput {
 public:
  // `given` maps names of arguments to words.
  explicit EvidenceInput(std::map<std::string, std::string> given) : given_(std::move(given)) {}

  bool has(const std::string& name) const { return given_.contains(name); }
  // A whole number up to `most`. "1e9" is one.
  std::uint64_t count(const std::string& name, std::uint64_t most) const;
  // Trials: up to 10^15.
  std::uint64_t units(const std::string& name) const;
  std::uint64_t units_from_one(const std::string& name) const;
  // Failures or events: up to 10^9. Those among `units` are no more than the units.
  std::uint64_t failures(const std::string& name) const;
  std::uint64_t failures(const std::string& name, const std::string& units) const;
  // A positive number, such as hours.
  double positive(const std::string& name) const;
  double positive(const std::string& name, double fallback) const;
  // A parameter of a prior without a unit: from 1e-9 to 1e6, where ln M keeps nine digits.
  double prior(const std::string& name, double fallback) const;
  // A number between 0 and 1, both excluded.
  double probability(const std::string& name) const;
  double probability(const std::string& name, double fallback) const;
  // From --confidence or --alpha; 0.95 if neither is given.
  Confidence confidence() const;
  // Lists, as in 1,2,3 or 1|2|3.
  std::vector<std::uint64_t> unit_list(const std::string& name) const;
  std::vector<std::uint64_t> failure_list(const std::string& name) const;
  std::vector<double> weights(const std::string& name) const;  // not negative, with the sum 1
  std::vector<double> positives(const std::string& name) const;
  // Rows of a table, as in 1,2/3,4: all of one length.
  std::vector<std::vector<std::uint64_t>> unit_rows(const std::string& name) const;
  std::vector<std::vector<std::uint64_t>> failure_rows(const std::string& name) const;
  // Pairs of whole numbers below the ends, as in 0:0,0:1,1:1.
  std::vector<std::pair<std::size_t, std::size_t>> pairs(const std::string& name, std::size_t end_of_first,
                                                         std::size_t end_of_second) const;

 private:
  const std::string& word(const std::string& name) const;
  std::vector<std::uint64_t> list(const std::string& name, std::uint64_t most) const;
  std::vector<std::vector<std::uint64_t>> rows(const std::string& name, std::uint64_t most) const;

  std::map<std::string, std::string> given_;
};

}  // namespace fleetproof::cli
