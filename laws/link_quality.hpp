#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/contract.hpp"
#include "core/outcome/law.hpp"
#include "laws/sent_messages.hpp"

namespace fleetproof {

// The contract of the radio (core/base/contract.hpp) is judged at an instant by the seconds before it.
inline constexpr int kQualityWindow_s = 10;

// The smallest number of losses among `receptions` that rejects "at most 40 % are lost", by a one-sided binomial test
// at 1e-4. Larger than `receptions` if no number of losses rejects it.
std::uint32_t losses_that_reject(std::uint32_t receptions);

// The links of a fleet over the last ten whole seconds, from the records of the trace. A loss counts at the instant of
// sending, a reception at its arrival, however late it comes. If several messages of a sender have equal bytes, the
// last one that was sent counts as the one received. The delay is therefore never too large.
class LinkQuality {
 public:
  explicit LinkQuality(std::size_t agvs);

  static TraceKinds reads() { return kMessageKinds; }
  void note(const TraceRecord& record);

  struct Link {
    std::uint32_t receptions = 0, lost = 0;
    Duration longest{};
    bool in_contract() const { return longest <= kContractDelay && lost < losses_that_reject(receptions); }
  };
  // The link over the second that begins at `second`, and the nine seconds before it.
  Link link(std::size_t sender, std::size_t receiver, std::int64_t second) const;
  // Whether every link to `receiver` kept the contract; the largest share lost on one of these links, in millionths.
  bool all_in_contract(std::size_t receiver, std::int64_t second) const;
  std::int64_t worst_loss_ppm(std::size_t receiver, std::int64_t second) const;

 private:
  struct Second {
    std::int64_t number = -1;
    Link link;
  };
  Link& now(std::size_t sender, std::size_t receiver, SimTime at);

  std::size_t agvs_;
  std::vector<std::array<Second, kQualityWindow_s>> seconds_;  // by receiver x AGVs + sender
  std::vector<std::int64_t> last_second_;                      // by receiver: of its newest reception; -1: none
  std::vector<SentMessages> sent_;                             // by sender
};

}  // namespace fleetproof
