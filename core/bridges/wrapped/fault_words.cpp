#include "core/bridges/wrapped/fault_words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace fleetproof::wrapped {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::uint32_t kMostMessages = 1'000'000;
constexpr double kMostSeconds = 86'400.0;

// {n}: of messages, as in "5th"; {d} and {p}: seconds.
struct FaultRow {
  FaultKind kind;
  std::string_view words, example, what_it_does;
  double least_s;  // of {d} and {p}
};
constexpr std::array<FaultRow, 6> kRows = {{
    {FaultKind::Drop, "drop every {n} message", "drop every 5th message", "does not hear every {n} message", 0.0},
    {FaultKind::Repeat, "repeat every {n} message", "repeat every 3rd message", "hears every {n} message twice", 0.0},
    {FaultKind::Stall, "stall {d} s every {p} s", "stall 3 s every 60 s", "hears nothing for {d} s in every {p} s",
     0.001},
    {FaultKind::Forget, "forget memory every {p} s", "forget memory every 60 s",
     "begins again every {p} s, with its disk, and nobody is told", 0.1},
    {FaultKind::OldPosition, "position {d} s old", "position 5 s old", "perceives where it was {d} s ago", 0.1},
    {FaultKind::ClockOff, "clock {d} s off", "clock 5 s off",
     "has clocks that are ahead, each by another part of {d} s", 0.001},
}};

const FaultRow& row_of(FaultKind kind) { return kRows[static_cast<std::size_t>(kind)]; }

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

std::string quoted(std::string_view words) {
  constexpr std::size_t kLongest = 80;
  return '"' + std::string(words.substr(0, kLongest)) + (words.size() > kLongest ? "...\"" : "\"");
}

std::vector<std::string_view> tokens_of(std::string_view words) {
  std::vector<std::string_view> tokens;
  for (std::size_t at = 0; (at = words.find_first_not_of(' ', at)) != std::string_view::npos;) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    tokens.push_back(words.substr(at, end - at));
    at = end;
  }
  return tokens;
}

std::string ordinal(std::uint32_t n) {
  const std::uint32_t last = n % 10;
  const bool is_teen = n / 10 % 10 == 1;
  return std::to_string(n) + (is_teen || last == 0 || last > 3 ? "th" : last == 1 ? "st" : last == 2 ? "nd" : "rd");
}

// Without zeros at the end: "2.5".
std::string seconds_text(std::int64_t ns) {
  std::string text = std::to_string(ns / kNsPerSecond);
  std::string rest = std::to_string(ns % kNsPerSecond + kNsPerSecond).substr(1);
  rest.erase(rest.find_last_not_of('0') + 1);
  return rest.empty() ? text : text + "." + rest;
}

std::uint32_t count_of(std::string_view token, const FaultRow& row) {
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), count);
  const std::string_view suffix = token.substr(static_cast<std::size_t>(end - token.data()));
  const bool is_ordinal = suffix == "st" || suffix == "nd" || suffix == "rd" || suffix == "th";
  if (error != std::errc{} || !is_ordinal || count < 1 || count > kMostMessages)
    refuse(quoted(token) + " says which message in \"" + std::string(row.example) + "\"; it goes from 1st to " +
           ordinal(kMostMessages));
  return count;
}

std::int64_t nanoseconds_of(std::string_view token, const FaultRow& row) {
  double seconds = 0.0;
  const auto [end, error] =
      std::from_chars(token.data(), token.data() + token.size(), seconds, std::chars_format::fixed);
  const bool is_number = error == std::errc{} && end == token.data() + token.size();
  if (!is_number || !(seconds >= row.least_s) || seconds > kMostSeconds)
    refuse(quoted(token) + " is a number of seconds in \"" + std::string(row.example) + "\"; it goes from " +
           seconds_text(std::llround(row.least_s * 1e9)) + " to 86400");
  return std::llround(seconds * 1e9);
}

std::string filled_in(std::string_view pattern, const Fault& fault) {
  std::string text;
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    if (pattern[at] != '{') {
      text.push_back(pattern[at]);
      continue;
    }
    const char which = pattern[at + 1];
    text += which == 'n'   ? ordinal(fault.every)
            : which == 'd' ? seconds_text(fault.length_ns)
                           : seconds_text(fault.period_ns);
    at += 2;
  }
  return text;
}

}  // namespace

Fault parse_fault(std::string_view words) {
  const auto tokens = tokens_of(words);
  for (const FaultRow& row : kRows) {
    const auto pattern = tokens_of(row.words);
    if (tokens.empty() || tokens.front() != pattern.front()) continue;
    const auto misfit = [&] { refuse(quoted(words) + " is written as in \"" + std::string(row.example) + "\""); };
    if (tokens.size() != pattern.size()) misfit();
    Fault fault{row.kind};
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      if (pattern[i] == "{n}") {
        fault.every = count_of(tokens[i], row);
      } else if (pattern[i] == "{d}" || pattern[i] == "{p}") {
        (pattern[i] == "{d}" ? fault.length_ns : fault.period_ns) = nanoseconds_of(tokens[i], row);
      } else if (tokens[i] != pattern[i]) {
        misfit();
      }
    }
    if (row.kind == FaultKind::Stall && fault.length_ns >= fault.period_ns)
      refuse("a stall of " + seconds_text(fault.length_ns) + " s every " + seconds_text(fault.period_ns) +
             " s never ends; let it be shorter than its period");
    return fault;
  }
  std::string known;
  for (const FaultRow& row : kRows) known += (known.empty() ? "\"" : ", \"") + std::string(row.example) + "\"";
  refuse(quoted(words) + " is no fault around a program; these are: " + known);
}

std::string text_of(const Fault& fault) { return filled_in(row_of(fault.kind).words, fault); }

std::string description_of(const Fault& fault) { return filled_in(row_of(fault.kind).what_it_does, fault); }

std::vector<Fault> usual_faults() {
  std::vector<Fault> faults;
  for (const FaultRow& row : kRows) faults.push_back(parse_fault(row.example));
  return faults;
}

WrappedWord split_word(std::string_view word) {
  WrappedWord found{std::string(word), ""};
  for (;;) {
    const std::size_t at = found.bare.rfind(kWith);
    if (at == std::string::npos || at == 0) return found;
    try {
      const Fault fault = parse_fault(std::string_view(found.bare).substr(at + kWith.size()));
      found = {found.bare.substr(0, at), std::string(kWith) + text_of(fault) + found.with};
    } catch (const std::invalid_argument&) {
      return found;
    }
  }
}

WrappedWord split_checked(std::string_view word) {
  WrappedWord found = split_word(word);
  const std::size_t at = found.bare.rfind(kWith);
  if (at == std::string::npos) return found;
  const std::string_view rest = std::string_view(found.bare).substr(at + kWith.size());
  const auto words = tokens_of(rest);
  const bool is_meant = !words.empty() && std::ranges::any_of(kRows, [&](const FaultRow& row) {
    return tokens_of(row.words).front() == words.front();
  });
  if (is_meant) parse_fault(rest);
  return found;
}

std::string with_text(std::string_view faults) {
  std::string text;
  for (std::size_t at = 0; at <= faults.size();) {
    const std::size_t end = std::min(faults.find(kWith, at), faults.size());
    text += std::string(kWith) + text_of(parse_fault(faults.substr(at, end - at)));
    at = end + kWith.size();
  }
  return text;
}

std::string bare_name(std::string_view name) { return split_word(name).bare; }

}  // namespace fleetproof::wrapped
