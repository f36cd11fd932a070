#include "reports/comparison/baseline.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

std::optional<std::string> partner_of(const std::string& agent, const ArchiveReader& baseline) {
  if (std::ranges::find(baseline.cells(), agent, &CellRecord::agent) != baseline.cells().end()) return agent;
  const auto under_test = agents_to_compare(baseline);
  return under_test.size() == 1 ? std::optional(under_test.front()) : std::nullopt;
}

}  // namespace

std::vector<BaselineComparison> compare_with_baseline(const ArchiveReader& archive, const std::string& archive_path,
                                                      const ArchiveReader& baseline, const std::string& baseline_path) {
  std::vector<BaselineComparison> list;
  for (const std::string& agent : agents_to_compare(archive)) {
    BaselineComparison& one = list.emplace_back();
    one.agent = agent;
    one.baseline_path = baseline_path;
    if (const auto partner = partner_of(agent, baseline)) {
      one.comparison = compare(read_release(baseline, baseline_path, *partner),
                               read_release(archive, archive_path, agent), one.rule);
    }
  }
  return list;
}

}  // namespace fleetproof
