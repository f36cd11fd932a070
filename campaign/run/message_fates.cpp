#include "campaign/run/message_fates.hpp"

namespace fleetproof {

// The records of a message come in this order: what it is, that it was sent, its fate at each receiver.
void FateKeeper::record(const TraceRecord& record, std::string_view text) {
  if (record.kind == TraceKind::Described) {
    texts_[read<traced::Described>(record).message_hash] = text;
  } else if (record.kind == TraceKind::Sent) {
    const auto sent = read<traced::Sent>(record);
    const auto described = texts_.find(sent.message_hash);
    text_ = described == texts_.end() ? "" : described->second;
    bytes_ = sent.bytes;
  } else if (record.kind == TraceKind::FateDecided) {
    decided(record);
  } else if (record.kind == TraceKind::LostByInterference) {
    const auto lost = read<traced::Reception>(record);
    const auto first = first_of_.find(lost.number);
    if (first == first_of_.end()) return;
    for (std::size_t i = first->second; i < fates_.size() && fates_[i].number == lost.number; ++i) {
      if (fates_[i].fate.receiver == record.entity) fates_[i].fate.lost = true;
    }
  }
}

void FateKeeper::decided(const TraceRecord& record) {
  const auto [sender, ordinal, lost, due_after, number, is_copy] = read<traced::FateDecided>(record);
  const Duration delay = due_after <= radio_.air_time(bytes_) ? Duration::zero() : due_after;
  if (is_copy) {
    fates_.back().fate.copied = true;
    fates_.back().fate.copy_delay = delay;
    return;
  }
  MessageFate message;
  message.fate.sender = sender;
  message.fate.receiver = record.entity;
  message.fate.sent = record.at - kStart;
  message.fate.ordinal = ordinal;
  message.fate.lost = lost;
  if (!lost) {
    message.fate.delay = delay;
    message.on_its_way = due_after;
  }
  message.kind = message_words(text_).kind;
  message.content = message_words(text_).content;
  message.number = number;
  first_of_.emplace(number, fates_.size());
  fates_.push_back(std::move(message));
}

}  // namespace fleetproof
