#include "campaign/run/message_deliveries.hpp"

namespace fleetproof {

// The records of a message come in this order: what it is, that it was sent, its delivery at each receiver.
void DeliveryKeeper::record(const TraceRecord& record, std::string_view text) {
  if (record.kind == TraceKind::Described) {
    texts_[read<traced::Described>(record).message_hash] = text;
  } else if (record.kind == TraceKind::Sent) {
    const auto sent = read<traced::Sent>(record);
    const auto described = texts_.find(sent.message_hash);
    text_ = described == texts_.end() ? "" : described->second;
    bytes_ = sent.bytes;
  } else if (record.kind == TraceKind::DeliveryDecided) {
    decided(record);
  } else if (record.kind == TraceKind::LostByInterference) {
    const auto lost = read<traced::Reception>(record);
    const auto first = first_of_.find(lost.number);
    if (first == first_of_.end()) return;
    for (std::size_t i = first->second; i < deliveries_.size() && deliveries_[i].number == lost.number; ++i) {
      if (deliveries_[i].delivery.receiver == record.entity) deliveries_[i].delivery.lost = true;
    }
  }
}

void DeliveryKeeper::decided(const TraceRecord& record) {
  const auto [sender, ordinal, lost, due_after, number, is_copy] = read<traced::DeliveryDecided>(record);
  const Duration delay = due_after <= radio_.air_time(bytes_) ? Duration::zero() : due_after;
  if (is_copy) {
    deliveries_.back().delivery.copied = true;
    deliveries_.back().delivery.copy_delay = delay;
    return;
  }
  MessageDelivery message;
  message.delivery.sender = sender;
  message.delivery.receiver = record.entity;
  message.delivery.sent = record.at - kStart;
  message.delivery.ordinal = ordinal;
  message.delivery.lost = lost;
  if (!lost) {
    message.delivery.delay = delay;
    message.on_its_way = due_after;
  }
  const MessageWords words = message_words(text_);
  message.kind = words.kind;
  message.content = words.content;
  message.asks = words.asks;
  message.answers = words.answers;
  message.about = words.about;
  message.number = number;
  first_of_.emplace(number, deliveries_.size());
  deliveries_.push_back(std::move(message));
}

}  // namespace fleetproof
