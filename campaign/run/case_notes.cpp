#include "campaign/run/case_notes.hpp"

#include <tuple>

namespace fleetproof {
namespace {

// Of each key the last one, in the order of the keys.
template <class Note, class KeyOf>
void keep_last(std::vector<Note>& kept, const Note& note, KeyOf key_of) {
  for (Note& other : kept) {
    if (key_of(other) == key_of(note)) {
      other = note;
      return;
    }
  }
  kept.push_back(note);
}

constexpr std::size_t kShortestDeclared = 4 + 4 + 8, kShortestHeard = 3 * 4 + 2 * 4 + 2 * 8,
                      kShortestBelieved = 2 * 4 + 3 * 4 + 8;

}  // namespace

void NoteKeeper::record(const TraceRecord& record, std::string_view text) {
  switch (record.kind) {
    case TraceKind::AgentState:
    case TraceKind::Probe:
      if (!text.empty()) declared_.push_back({record.entity, std::string(text), record.at});
      return;
    case TraceKind::Described:
      texts_[read<traced::Described>(record).message_hash] = text;
      return;
    case TraceKind::Sent: {
      const auto sent = read<traced::Sent>(record);
      const auto text_of = texts_.find(sent.message_hash);
      messages_[sent.number] = {text_of == texts_.end() ? "" : text_of->second, record.at};
      return;
    }
    case TraceKind::Received: {
      const auto received = read<traced::Reception>(record);
      const Message& message = messages_[received.number];
      const auto [kind, content, asks, answers, about] = message_words(message.text);
      heard_.push_back({record.entity, received.sender, received.number, std::string(kind), std::string(content),
                        message.sent, record.at});
      return;
    }
    case TraceKind::Belief: {
      const auto belief = read<traced::Belief>(record);
      believed_.push_back({record.at, {record.entity, belief.about, belief.where, at_ns(belief.as_of_ns)}});
      return;
    }
    default:
      return;
  }
}

CaseNotes NoteKeeper::until(SimTime t) const {
  CaseNotes notes;
  for (const Declared& note : declared_) {
    if (note.at <= t) keep_last(notes.declared, note, [](const Declared& d) { return std::tie(d.agv, d.word); });
  }
  for (const Heard& note : heard_) {
    if (note.received <= t) keep_last(notes.heard, note, [](const Heard& h) { return std::tie(h.by, h.of); });
  }
  for (const auto& [at, note] : believed_) {
    if (at <= t) keep_last(notes.believed, note, [](const Believed& b) { return std::tie(b.by, b.about); });
  }
  return notes;
}

void put(ByteSink& sink, const std::vector<Declared>& all) {
  sink.u32(static_cast<std::uint32_t>(all.size()));
  for (const auto& [agv, word, at] : all) {
    sink.u32(agv.value);
    sink.text(word);
    sink.i64(to_ns(at));
  }
}

std::vector<Declared> take_declared(ByteSource& source) {
  std::vector<Declared> all(source.count(kShortestDeclared));
  for (auto& [agv, word, at] : all) {
    agv.value = source.u32();
    word = source.text();
    at = at_ns(source.i64());
  }
  return all;
}

void put(ByteSink& sink, const CaseNotes& notes) {
  const auto count = [&](const auto& list) { sink.u32(static_cast<std::uint32_t>(list.size())); };
  put(sink, notes.declared);
  count(notes.heard);
  for (const auto& [by, of, number, kind, content, sent, received] : notes.heard) {
    for (const std::uint32_t value : {by.value, of.value, number}) sink.u32(value);
    sink.text(kind);
    sink.text(content);
    for (const SimTime time : {sent, received}) sink.i64(to_ns(time));
  }
  count(notes.believed);
  for (const auto& [by, about, where, as_of] : notes.believed) {
    for (const std::uint32_t value : {by.value, about.value}) sink.u32(value);
    for (const std::int32_t place : {where.x_mm, where.y_mm}) sink.u32(static_cast<std::uint32_t>(place));
    sink.u32(std::uint32_t{static_cast<std::uint16_t>(where.heading_x)} << 16 |
             static_cast<std::uint16_t>(where.heading_y));
    sink.i64(to_ns(as_of));
  }
}

CaseNotes take_notes(ByteSource& source) {
  CaseNotes notes;
  notes.declared = take_declared(source);
  notes.heard.resize(source.count(kShortestHeard));
  for (auto& [by, of, number, kind, content, sent, received] : notes.heard) {
    for (std::uint32_t* value : {&by.value, &of.value, &number}) *value = source.u32();
    kind = source.text();
    content = source.text();
    for (SimTime* time : {&sent, &received}) *time = at_ns(source.i64());
  }
  notes.believed.resize(source.count(kShortestBelieved));
  for (auto& [by, about, where, as_of] : notes.believed) {
    for (std::uint32_t* value : {&by.value, &about.value}) *value = source.u32();
    for (std::int32_t* place : {&where.x_mm, &where.y_mm}) *place = static_cast<std::int32_t>(source.u32());
    const std::uint32_t heading = source.u32();
    where.heading_x = static_cast<std::int16_t>(heading >> 16);
    where.heading_y = static_cast<std::int16_t>(heading);
    as_of = at_ns(source.i64());
  }
  return notes;
}

}  // namespace fleetproof
