#include "reports/replay_page/message_numbers.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <initializer_list>

namespace fleetproof::web {
namespace {

constexpr std::string_view kCut = "\u2026", kTo = " to ", kFor = " for ";

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool take(std::string_view& rest, std::string_view text) {
  if (!rest.starts_with(text)) return false;
  rest.remove_prefix(text.size());
  return true;
}

// "3.0", or "3.0 of boot 1"; empty: it begins with no number.
std::string take_number(std::string_view& rest) {
  std::size_t end = 0;
  while (end < rest.size() && (is_digit(rest[end]) || (rest[end] == '.' && end > 0))) ++end;
  while (end > 0 && rest[end - 1] == '.') --end;
  std::string number(rest.substr(0, end));
  rest.remove_prefix(end);
  std::string_view boot = rest;
  if (number.empty() || !take(boot, " of boot ") || boot.empty() || !is_digit(boot.front())) return number;
  std::size_t digits = 0;
  while (digits < boot.size() && is_digit(boot[digits])) ++digits;
  number += " of boot " + std::string(boot.substr(0, digits));
  rest = boot.substr(digits);
  return number;
}

MessageNumbers numbers_after(std::string_view content, std::string_view word,
                             std::initializer_list<std::string_view> fillers) {
  MessageNumbers numbers;
  auto rest = after_word(content, word);
  if (!rest) return numbers;
  for (const std::string_view filler : fillers) take(*rest, filler);
  for (bool goes_on = take(*rest, " "); goes_on; goes_on = take(*rest, ", ")) {
    std::string number = take_number(*rest);
    if (number.empty()) {
      numbers.has_more = numbers.list.empty() || rest->starts_with("...");
      break;
    }
    numbers.list.push_back(std::move(number));
  }
  return numbers;
}

// "3" of "3.1"; "3 of boot 1" of "3.1 of boot 1".
std::string request_of(const std::string& number) {
  const auto dot = number.find('.'), boot = number.find(' ');
  const std::string suffix = boot == number.npos ? "" : number.substr(boot);
  return number.substr(0, std::min(dot, boot)) + suffix;
}

// 1 of "3.1 of boot 1"; 0 of "3".
std::uint64_t attempt_of(const std::string& number) {
  const auto dot = number.find('.');
  std::uint64_t attempt = 0;
  if (dot != number.npos) std::from_chars(number.data() + dot + 1, number.data() + number.size(), attempt);
  return attempt;
}

}  // namespace

std::optional<std::string_view> after_word(std::string_view content, std::string_view word) {
  for (auto at = content.find(word); at != content.npos; at = content.find(word, at + 1)) {
    const bool begins = at == 0 || content[at - 1] == ' ', ends = at + word.size() == content.size();
    if (begins && (ends || content[at + word.size()] == ' ')) return content.substr(at + word.size());
  }
  return std::nullopt;
}

bool MessageNumbers::contains(const std::string& number) const { return std::ranges::find(list, number) != list.end(); }
bool MessageNumbers::meets(const MessageNumbers& other) const {
  return std::ranges::any_of(list, [&](const std::string& number) { return other.contains(number); });
}
std::string MessageNumbers::text() const {
  std::string text;
  for (const std::string& number : list) text += (text.empty() ? "" : " or ") + number;
  return text;
}

MessageNumbers numbers_asked(std::string_view content) { return numbers_after(content, "asks", {" nobody", " with"}); }
MessageNumbers numbers_answered(std::string_view content) { return numbers_after(content, "answers", {" to"}); }

bool are_of_one_request(const MessageNumbers& a, const MessageNumbers& b) {
  return std::ranges::any_of(a.list, [&](const std::string& one) {
    return std::ranges::any_of(b.list, [&](const std::string& other) { return request_of(one) == request_of(other); });
  });
}

bool is_later_attempt(const MessageNumbers& later, const MessageNumbers& first) {
  return std::ranges::any_of(later.list, [&](const std::string& number) {
    return std::ranges::any_of(first.list, [&](const std::string& before) {
      return request_of(number) == request_of(before) && attempt_of(number) > attempt_of(before);
    });
  });
}

bool names_a_place(std::string_view content) { return content.find(kFor) != content.npos; }

namespace {

// "C12 to C14".
std::string_view way_of(std::string_view content) {
  const auto at = content.find(kFor);
  if (at == content.npos) return {};
  const std::string_view way = content.substr(at + kFor.size());
  return way.substr(0, way.find(", holds from "));
}

}  // namespace

bool asks_to_end_of(std::string_view content, std::string_view drive) {
  constexpr std::string_view kBackward = ", backward";
  const std::string_view way = way_of(content);
  if (way.find(kTo) == way.npos) return false;
  std::string_view place = way.substr(way.find(kTo) + kTo.size());
  if (drive.ends_with(kBackward)) drive.remove_suffix(kBackward.size());
  if (!place.starts_with(kCut)) return drive.ends_with(std::string(kTo) + std::string(place));
  place.remove_prefix(kCut.size());
  return !place.empty() && drive.ends_with(place);
}

bool asks_from_beginning_of(std::string_view content, std::string_view drive) {
  std::string_view place = way_of(content);
  if (place.empty()) return false;
  place = place.substr(0, place.find(kTo));
  if (!place.starts_with(kCut)) return drive.starts_with(std::string(place) + std::string(kTo));
  place.remove_prefix(kCut.size());
  return !place.empty() && drive.substr(0, drive.find(kTo)).ends_with(place);
}

}  // namespace fleetproof::web
