#include "campaign/cli/evidence/evidence_methods.hpp"

namespace fleetproof::cli {

std::vector<EvidenceMethod> evidence_methods() {
  std::vector<EvidenceMethod> all;
  for (const auto part : {fixed_size_methods(), sequential_methods(), grouped_methods(), comparison_methods()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace fleetproof::cli
