#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/outcome/note_records.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A message at one receiver, and what became of it.
struct MessageDelivery {
  GivenDelivery delivery;
  std::string kind;                        // as its sender describes it; empty if it does not
  std::uint32_t number = 0;                // of the message in its run
  std::string content{};                   // what it says, as its sender describes it; may be empty
  std::string asks{}, answers{}, about{};  // as fp_message_fields has them; may be empty
  Duration on_its_way{};                   // until it arrives, also on a perfect radio; of a lost one: zero

  SimTime arrives() const { return kStart + delivery.sent + on_its_way; }  // requires: it is not lost
  // Lost, or later than the air takes, or twice.
  bool is_adverse() const { return delivery.lost || delivery.copied || delivery.delay > Duration::zero(); }
};

// Keeps the deliveries of all messages of a run, in the order in which they were sent.
class DeliveryKeeper final : public TraceSink {
 public:
  explicit DeliveryKeeper(const Scenario& scenario) : radio_(scenario.radio) {}
  void record(const TraceRecord& record, std::string_view text) override;
  const std::vector<MessageDelivery>& deliveries() const { return deliveries_; }

 private:
  void decided(const TraceRecord& record);

  RadioSetup radio_;
  std::vector<MessageDelivery> deliveries_;
  std::map<std::uint32_t, std::size_t> first_of_;  // by message number: its first delivery
  std::map<std::uint64_t, std::string> texts_;     // what a message is, by its hash
  std::string text_;
  std::size_t bytes_ = 0;  // of the message that was sent last
};

}  // namespace fleetproof
