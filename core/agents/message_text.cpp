#include "core/agents/message_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace fleetproof::agents {
namespace {

// Names that differ often do so at their end, so the end of a name is what remains of it.
constexpr std::string_view kCut = "\u2026", kTo = " to ";
constexpr std::size_t kLeastOfName = 7;
// There are more numbers than have room.
constexpr char kMore[] = ", ...";
constexpr std::size_t kMoreBytes = sizeof kMore - 1, kToAsk = sizeof ", asks nobody with 12.3 of boot 1";
constexpr std::uint32_t kAnswersNamed = 2;

// Where a text ends and how far it may go. Everything below takes a pen and returns it as it is after writing: a
// compiler keeps it in registers.
struct Pen {
  char *at, *end;

  std::size_t room() const { return at < end ? static_cast<std::size_t>(end - at) : 0; }
};

template <std::size_t kSize>
Pen put(Pen pen, const char (&text)[kSize]) {
  std::memcpy(pen.at, text, kSize - 1);
  return {pen.at + kSize - 1, pen.end};
}
Pen put(Pen pen, std::string_view text) {
  std::memcpy(pen.at, text.data(), text.size());
  return {pen.at + text.size(), pen.end};
}
Pen put(Pen pen, std::uint32_t number) {
  constexpr std::size_t kDigits = 10;
  return {std::to_chars(pen.at, pen.at + kDigits, number).ptr, pen.end};
}

Pen put_epoch(Pen pen, Epoch epoch) {
  const auto request = static_cast<std::uint32_t>(number_of(epoch) / kAttempts);
  const auto attempt = static_cast<std::uint32_t>(number_of(epoch) % kAttempts);
  if (epoch < 10 * kAttempts && attempt < 10) {  // most are
    pen.at[0] = static_cast<char>('0' + request);
    pen.at[1] = '.';
    pen.at[2] = static_cast<char>('0' + attempt);
    return {pen.at + 3, pen.end};
  }
  pen = put(put(put(pen, request), "."), attempt);
  return boot_of(epoch) == 0 ? pen : put(put(pen, " of boot "), boot_of(epoch));
}

// Null if there is no room: a number that is cut would be another number.
Pen put_next(Pen pen, bool is_first, Epoch epoch, std::size_t reserved) {
  const Pen after = put_epoch(is_first ? pen : put(pen, ", "), epoch);
  return after.room() < reserved ? Pen{nullptr, nullptr} : after;
}

// Cut between characters, of whatever script.
Pen put_end_of(Pen pen, std::string_view name, std::size_t most) {
  if (name.size() <= most) return put(pen, name);
  std::size_t at = name.size() - (most - kCut.size());
  while (at < name.size() && (static_cast<unsigned char>(name[at]) & 0xC0U) == 0x80U) ++at;
  return put(put(pen, kCut), name.substr(at));
}

// Null if the names have no room even if they are cut.
Pen put_cut(Pen pen, std::string_view from, std::string_view to) {
  const std::string_view between = to.empty() ? "" : kTo;
  const std::size_t all = pen.room() - std::min(pen.room(), between.size());
  if (std::min(from.size(), kLeastOfName) + std::min(to.size(), kLeastOfName) > all) return {nullptr, nullptr};
  pen = put_end_of(pen, from, std::max(all / 2, all - std::min(all, to.size())));
  pen = put(pen, between);
  return put_end_of(pen, to, pen.room());
}

Pen put_way(Pen pen, const Path& path, const MapView& map) {
  const std::uint32_t last = path.empty() ? path.station : map.lane(path.lane_ids[path.count - 1]).to;
  const ShortName &from = map.short_name(path.station), &to = map.short_name(last);
  if (from.size + kTo.size() + to.size > pen.room())
    return put_cut(pen, station_name(map, path.station), path.empty() ? "" : station_name(map, last));
  std::memcpy(pen.at, from.text.data(), from.text.size());
  pen.at += from.size;
  if (path.empty()) return pen;
  std::memcpy(pen.at, kTo.data(), kTo.size());
  std::memcpy(pen.at + kTo.size(), to.text.data(), to.text.size());
  return {pen.at + kTo.size() + to.size, pen.end};
}

// The attempts with which it asks, each once.
Pen put_attempts(Pen pen, Epoch request, const Asked& asked) {
  for (std::uint32_t i = 0; i < asked.count; ++i) {
    const auto same = [&](const Asked::Entry& entry) { return entry.attempt == asked.list[i].attempt; };
    if (i > 0 && std::ranges::any_of(asked.all().first(i), same)) continue;
    const Pen after = put_next(pen, i == 0, request + asked.list[i].attempt, kMoreBytes);
    if (after.at == nullptr) return put(pen, kMore);
    pen = after;
  }
  return pen;
}

// Each part ends with a comma.
Pen put_asked(Pen pen, const Message& message, const MapView& map) {
  const Asked& asked = message.asked;
  const Epoch request = request_of(message.status.epoch);
  pen = asked.count == 0 ? put_epoch(put(pen, "asks nobody with "), request)
                         : put_attempts(put(pen, "asks with "), request, asked);
  const Pen named = put_way(put(pen, " for "), message.request, map);
  return put(named.at == nullptr ? pen : named, ", ");
}

Pen put_answers(Pen pen, const Answers& answers, bool asks) {
  pen = put(pen, "answers ");
  for (std::uint32_t i = 0; i < answers.count; ++i) {
    const Pen after = i == kAnswersNamed
                          ? Pen{nullptr, nullptr}
                          : put_next(pen, i == 0, answers.list[i].echo, kMoreBytes + (asks ? kToAsk : 0));
    if (after.at == nullptr) {
      pen = i == 0 ? put(pen, "...") : put(pen, kMore);
      break;
    }
    pen = after;
  }
  return put(pen, ", ");
}

Pen put_held(Pen pen, const Path& held, const MapView& map) {
  const Pen named = put_way(put(pen, "holds "), held, map);
  return named.at == nullptr ? pen : put(named, ", ");
}

// What it asks for begins where the held path ends: then its beginning is enough, if it has room.
Pen put_held_from(Pen pen, const Path& held, const MapView& map) {
  if (held.empty()) return pen;
  const Pen after = put(pen, "holds from ");
  const std::string_view from = station_name(map, held.station);
  return from.size() > after.room() ? pen : put(put(after, from), ", ");
}

}  // namespace

// The last comma, or the colon, goes.
MessageText::MessageText(const Message& message, const MapView& map) {
  const bool asks = message.has_request();
  Pen pen{text_.data(), text_.data() + kBytes};
  switch (message.kind) {
    case MessageKind::State:
      pen = put(pen, "STATE: ");
      if (message.answers.count > 0) pen = put_answers(pen, message.answers, asks);
      break;
    case MessageKind::Request:
      pen = put(pen, "REQUEST: ");
      break;
    case MessageKind::Grant:
      pen = put(put_epoch(put(pen, "GRANT: answers "), message.echo), ", ");
      break;
    case MessageKind::Defer:
      pen = put(put_epoch(put(pen, "DEFER: answers "), message.echo), ", ");
      break;
    case MessageKind::Join:
      pen = put(pen, "JOIN: ");
      break;
    case MessageKind::Roll:
      pen = put(pen, "ROLL: ");
      break;
  }
  pen = asks ? put_held_from(put_asked(pen, message, map), message.status.held, map)
             : put_held(pen, message.status.held, map);
  pen.at[-2] = '\0';
}

namespace {

Pen put_request(Pen pen, std::uint32_t agv, Epoch epoch) {
  pen = put(put(put(pen, agv), "/"), static_cast<std::uint32_t>(number_of(epoch) / kAttempts));
  return boot_of(epoch) == 0 ? pen : put(put(pen, " of boot "), boot_of(epoch));
}

}  // namespace

RequestNames::RequestNames(const Message& message, std::uint32_t self, std::uint32_t receiver) {
  constexpr std::size_t kLongest = sizeof ",4294967295/4294967295 of boot 4294967295";
  Pen pen{asks_.data(), asks_.data() + asks_.size()};
  if (message.has_request()) pen = put_request(pen, self, message.status.epoch);
  *pen.at = '\0';
  pen = {answers_.data(), answers_.data() + answers_.size()};
  const bool is_answer = message.kind == MessageKind::Grant || message.kind == MessageKind::Defer;
  if (is_answer && receiver != FP_NONE) pen = put_request(pen, receiver, message.echo);
  if (message.kind == MessageKind::State) {
    for (std::uint32_t i = 0; i < message.answers.count && pen.room() > kLongest; ++i) {
      if (i > 0) pen = put(pen, ",");
      pen = put_request(pen, message.answers.list[i].agv, message.answers.list[i].echo);
    }
  }
  *pen.at = '\0';
}

}  // namespace fleetproof::agents
