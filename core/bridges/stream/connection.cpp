#include "core/bridges/stream/connection.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof::stream {

void Sender::add(Segment::Kind kind, std::span<const std::byte> bytes, std::string text) {
  Segment segment;
  segment.kind = kind;
  segment.number = added_++;
  segment.bytes.assign(bytes.begin(), bytes.end());
  bytes_waiting_ += bytes.size();
  waiting_.push_back({std::move(segment), std::move(text)});
}

void Sender::acknowledge(std::uint32_t expected, std::uint32_t measures, std::int64_t now_ns) {
  if (measures > acknowledged_ && measures <= sent_)
    timeout_.measured(now_ns - waiting_[measures - 1 - acknowledged_].first_sent_ns);
  if (expected <= acknowledged_ || expected > sent_) return;
  for (; acknowledged_ < expected; ++acknowledged_) {
    bytes_waiting_ -= waiting_.front().segment.bytes.size();
    waiting_.pop_front();
  }
  timeout_.answered();
  unanswered_since_ns_ = now_ns;
  is_next_due_ = acknowledged_ < sent_before_timeout_;
  timer_ns_ = acknowledged_ < sent_ ? std::optional(now_ns + timeout_.ns()) : std::nullopt;
}

std::string Sender::flush(std::int64_t now_ns, bool is_open, const Emit& emit) {
  const auto send = [&](Waiting& one) {
    if (one.sends == 0) one.first_sent_ns = now_ns;
    one.segment.is_repeat = one.sends > 0;
    emit(one.segment, one.text, one.sends++);
  };
  if (acknowledged_ < sent_ && now_ns - unanswered_since_ns_ >= settings_.most_silence_ns)
    return "silent for " + std::to_string((now_ns - unanswered_since_ns_) / kSecond_ns) + " s";
  if (timer_ns_ && now_ns >= *timer_ns_) {
    if (waiting_.front().sends > settings_.most_repeats)
      return "no answer to " + std::to_string(settings_.most_repeats) + " repeats";
    timeout_.expired();
    sent_before_timeout_ = sent_;
    is_next_due_ = true;
  }
  if (std::exchange(is_next_due_, false)) {
    send(waiting_.front());
    timer_ns_ = now_ns + timeout_.ns();
  }
  const std::uint32_t end = is_open ? std::min(added_, acknowledged_ + settings_.window) : 1;
  for (; sent_ < end; ++sent_) {
    if (acknowledged_ == sent_) unanswered_since_ns_ = now_ns;
    send(waiting_[sent_ - acknowledged_]);
    if (!timer_ns_) timer_ns_ = now_ns + timeout_.ns();
  }
  return {};
}

std::optional<std::int64_t> Sender::deadline_ns() const {
  if (acknowledged_ == sent_) return std::nullopt;
  return std::min(*timer_ns_, unanswered_since_ns_ + settings_.most_silence_ns);
}

Connection::Connection(const ConnectionId& id, const Settings& settings)
    : id_(id), settings_(settings), sender_(settings) {
  sender_.add(Segment::Kind::Open, {}, {});
}

bool Connection::send(std::span<const std::byte> bytes, std::string_view text) {
  if (is_closing_ || is_over_ || sender_.bytes_waiting() + bytes.size() > settings_.most_waiting) return false;
  const std::size_t parts = (bytes.size() + kMostBytes - 1) / kMostBytes;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::string which = parts == 1 ? "" : ", " + std::to_string(part + 1) + " of " + std::to_string(parts);
    const auto rest = bytes.subspan(part * kMostBytes);
    sender_.add(Segment::Kind::Data, rest.first(std::min(rest.size(), kMostBytes)), std::string(text) + which);
  }
  return true;
}

void Connection::close() {
  if (std::exchange(is_closing_, true) || is_over_) return;
  sender_.add(Segment::Kind::Close, {}, {});
}

void Connection::hear(const Segment& segment, std::int64_t now_ns) {
  if (is_over_) return;
  if (segment.kind == Segment::Kind::Reset) {
    is_closing_ ? end(StreamEvent::Kind::Closed) : end(StreamEvent::Kind::Broken, "reset by the other end");
    return;
  }
  sender_.acknowledge(segment.expected, segment.measures, now_ns);
  if (segment.has_number() && !segment.is_repeat) measures_ = segment.number + 1;
  owes_acknowledgement_ = owes_acknowledgement_ || segment.has_number();
  if (segment.has_number() && segment.number >= expected_ && segment.number - expected_ < settings_.window)
    early_.try_emplace(segment.number, segment);
  deliver();
  if (is_closing_ && sender_.is_done()) end(StreamEvent::Kind::Closed);
}

void Connection::deliver() {
  // Open: each end has heard the opening of the other one, and knows that its own was heard.
  const auto open = [&] {
    if (is_open_ || sender_.acknowledged() == 0 || expected_ == 0) return;
    is_open_ = true;
    events_.push_back({StreamEvent::Kind::Opened});
  };
  open();
  for (auto next = early_.begin(); next != early_.end() && next->first == expected_ && !is_over_;
       next = early_.erase(next)) {
    ++expected_;
    open();
    if (next->second.kind == Segment::Kind::Data)
      events_.push_back({StreamEvent::Kind::Received, std::move(next->second.bytes)});
    if (next->second.kind == Segment::Kind::Close) end(StreamEvent::Kind::Closed);
  }
}

void Connection::end(StreamEvent::Kind kind, std::string reason) {
  if (std::exchange(is_over_, true)) return;
  events_.push_back({kind, {}, std::move(reason)});
}

void Connection::flush(std::int64_t now_ns, const Emit& emit) {
  const auto put = [&](Segment segment, std::string_view text, std::uint32_t repeats) {
    segment.id = id_;
    segment.expected = expected_;
    segment.measures = expected_ > 0 ? std::exchange(measures_, 0) : 0;
    owes_acknowledgement_ = false;
    emit(std::move(segment), text, repeats);
  };
  if (!is_over_) {
    std::string broken = sender_.flush(now_ns, is_open_, put);
    if (!broken.empty()) end(StreamEvent::Kind::Broken, std::move(broken));
  }
  if (owes_acknowledgement_ && expected_ > 0) put({}, {}, 0);
}

std::optional<std::int64_t> Connection::deadline_ns() const { return is_over_ ? std::nullopt : sender_.deadline_ns(); }

}  // namespace fleetproof::stream
