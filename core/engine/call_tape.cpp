#include "core/engine/call_tape.hpp"

#include <array>
#include <new>
#include <utility>

namespace fleetproof {

CallTape::CallTape(std::size_t longest_bytes, HandOn hand_on)
    : longest_bytes_(longest_bytes), hand_on_(std::move(hand_on)) {
  const char version = kTapeVersion;
  append({&version, 1});
}

std::string CallTape::take() { return std::exchange(bytes_, {}); }

// ---- calls into agents

void CallTape::call_begins(AgvId agv, std::uint32_t event) {
  calls_ = services_ = notes_ = 0;
  put(agv.value);
  put(event);
}

void CallTape::call_failed(bool hang, std::string_view message) {
  call_ends(hang ? TapeItem::Hung : TapeItem::Crashed);
  put(message);
}

void CallTape::call_ends(TapeItem how) {
  put_services();
  if (calls_ > kCallsMax) {
    put(TapeItem::OverLimit);
    put_number(calls_ - kCallsMax);
  }
  if (notes_ > kNotesMax) {
    put(TapeItem::NotesLeftOut);
    put_number(notes_ - kNotesMax);
  }
  put(how);
}

// ---- controller calls

// Beyond the limit only numbers matter, and in what order the calls come does not: the tape stays bounded.
bool CallTape::admits() {
  if (++calls_ > kCallsMax) return false;
  put_services();
  return true;
}

void CallTape::put_services() {
  if (services_ == 0) return;
  put(TapeItem::Services);
  put_number(std::exchange(services_, 0));
}

// ---- bytes

void CallTape::put(TapeItem item) {
  const char byte = static_cast<char>(item);
  append({&byte, 1});
}

void CallTape::put(std::int64_t time_ns) {
  const auto bits = static_cast<std::uint64_t>(time_ns);
  put_number(time_ns < 0 ? (~bits << 1U | 1U) : bits << 1U);
}

void CallTape::put(std::string_view text) {
  put_number(text.size());
  append(text);
}

void CallTape::put_number(std::uint64_t number) {
  std::array<char, 10> bytes{};
  std::size_t size = 0;
  for (; number >= 0x80; number >>= 7U) bytes[size++] = static_cast<char>(number | 0x80U);
  bytes[size++] = static_cast<char>(number);
  append({bytes.data(), size});
}

void CallTape::append(std::string_view bytes) {
  if (!is_complete() || bytes.empty()) return;
  complete_ = bytes.size() <= longest_bytes_ - handed_on_ - bytes_.size();
  try {
    // Before the bytes come: so the last piece is never empty.
    if (complete_ && hand_on_ && bytes_.size() >= kTapePiece) {
      handed_on_ += bytes_.size();
      hand_on_(std::exchange(bytes_, {}));
    }
    if (complete_) bytes_.append(bytes);
  } catch (const std::bad_alloc&) {
    complete_ = false;  // no reason to end the run
  }
  if (!is_complete()) std::string().swap(bytes_);
}

}  // namespace fleetproof
