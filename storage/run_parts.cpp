#include "storage/run_parts.hpp"

#include "storage/rows.hpp"
#include "storage/schema.hpp"

namespace fleetproof {
namespace {

template <class Part>
Part& part_at(std::vector<Part>& parts, std::size_t ordinal) {
  return ordinal < parts.size() ? parts[ordinal] : parts.emplace_back();
}

}  // namespace

const std::array<PartTable, 3>& part_tables() {
  static const std::array<PartTable, 3> tables{{
      {"violations", violation_values,
       [](const Row& row, Outcome& o, std::size_t i) { part_at(o.violations, i) = read_violation(row); },
       [](Outcome& o, std::size_t count) { o.violations.resize(count); }},
      {"incidents", [](std::int32_t) { return std::string(kIncidentColumns); },
       [](const Row& row, Outcome& o, std::size_t i) { part_at(o.incidents, i) = read_incident(row); },
       [](Outcome& o, std::size_t count) { o.incidents.resize(count); }},
      {"probes", [](std::int32_t) { return std::string(kProbeColumns); },
       [](const Row& row, Outcome& o, std::size_t i) { read_probe(row, part_at(o.probes, i)); },
       [](Outcome& o, std::size_t count) { o.probes.resize(count); }},
  }};
  return tables;
}

}  // namespace fleetproof
