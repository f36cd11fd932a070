#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof::web {

// What follows a word, or words, in the content of a message; nothing if they do not stand there as whole words.
std::optional<std::string_view> after_word(std::string_view content, std::string_view word);

// The numbers by which contents of messages refer to each other. Of "asks with 3.0, 3.1 for C12 to C14" they are 3.0
// and 3.1; of "answers 1.0 of boot 1, holds C2" it is "1.0 of boot 1".
struct MessageNumbers {
  std::vector<std::string> list;
  bool has_more = false;  // others that the content does not name: "answers 3.0, ...", or "answers all"

  bool contains(const std::string& number) const;
  bool meets(const MessageNumbers& other) const;
  // "3.0 or 3.1".
  std::string text() const;
};
// After the words "asks", "asks with" and "asks nobody with".
MessageNumbers numbers_asked(std::string_view content);
// After the words "answers" and "answers to".
MessageNumbers numbers_answered(std::string_view content);

// 3.0 and 3.1 belong to one request: attempts of it.
bool are_of_one_request(const MessageNumbers& a, const MessageNumbers& b);
// 3.1 is a later attempt than 3.0 of the same request.
bool is_later_attempt(const MessageNumbers& later, const MessageNumbers& first);

// Whether what the content asks for begins where a drive begins: "for C12 to C14" and "C12 to C13". A name of which
// only the end is there, as "for ...12 to C14" with one character for the dots, is compared as far as it is there.
bool asks_from_beginning_of(std::string_view content, std::string_view drive);
// Whether it ends where the drive ends.
bool asks_to_end_of(std::string_view content, std::string_view drive);
// The content names a place for which it asks.
bool names_a_place(std::string_view content);

}  // namespace fleetproof::web
