#include "generators/scenario_file/radio_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "core/base/error.hpp"
#include "generators/scenario_file/field_rules.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kHeading = "sender,receiver,t_send_s,t_recv_s";
constexpr std::size_t kMostWholeDigits = 10, kFractionDigits = 9;
constexpr std::int64_t kLatest_s = 9'000'000'000, kNanoseconds = 1'000'000'000;  // beyond, nanoseconds leave 64 bits

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first, last - first + 1);
}

bool all_digits(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

class RecordingReader {
 public:
  RecordingReader(std::string_view text, std::string_view source) : lines_(text), source_(source) {}

  RadioTrace read() {
    bool has_heading = false;
    while (const auto line = lines_.next()) {
      const auto content = trimmed(*line);
      if (content.empty() || content.starts_with('#')) continue;
      if (has_heading) {
        add(content);
      } else if (content == kHeading) {
        has_heading = true;
      } else {
        refuse(fmt::format("{} is no heading; expected the line {}", in_quotes(content), kHeading));
      }
    }
    if (trace_.empty())
      throw InputError(source_,
                       fmt::format("holds no message; expected the line {} and one line for each message", kHeading));
    const Duration epoch = std::ranges::min_element(trace_, {}, &RecordedMessage::sent)->sent;
    for (std::size_t i = 0; i < trace_.size(); ++i) {
      trace_[i].sent -= epoch;
      if (trace_[i].sent > kLongestRadioTime) {
        throw InputError(at_line(source_, numbers_[i]),
                         "t_send_s is more than 1e9 s after the first; leave out what another clock has dated");
      }
    }
    put_in_order(trace_);
    return std::move(trace_);
  }

 private:
  [[noreturn]] void refuse(std::string_view sentence) const {
    throw InputError(at_line(source_, lines_.number()), sentence);
  }
  [[noreturn]] void refuse(std::string_view column, std::string_view value, std::string_view remedy) const {
    refuse(fmt::format("{} is {}; {}", column, in_quotes(value), remedy));
  }

  void add(std::string_view line) {
    std::string_view fields[4];
    const auto count = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
    if (count != std::size(fields)) refuse(fmt::format("has {} fields; expected four: {}", count, kHeading));
    for (auto& field : fields) {
      const auto comma = line.find(',');
      field = trimmed(line.substr(0, comma));
      line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    }
    RecordedMessage message{agv("sender", fields[0]), agv("receiver", fields[1]), time("t_send_s", fields[2]),
                            std::nullopt};
    if (message.sender == message.receiver) refuse("receiver", fields[1], "no AGV sends to itself; give another AGV");
    if (!fields[3].empty() && fields[3] != "lost") {
      message.delay = time("t_recv_s", fields[3]) - message.sent;
      if (*message.delay < Duration::zero())
        refuse("t_recv_s", fields[3], "it is before t_send_s; both clocks must agree");
      if (*message.delay > kLongestRadioTime)
        refuse("t_recv_s", fields[3], "it is more than 1e9 s after t_send_s; both clocks must agree");
    }
    trace_.push_back(message);
    numbers_.push_back(lines_.number());
  }

  AgvId agv(std::string_view column, std::string_view value) const {
    std::uint32_t number = kAgvNumbers;
    const auto read = std::from_chars(value.data(), value.data() + value.size(), number);
    if (read.ec != std::errc() || read.ptr != value.data() + value.size() || number >= kAgvNumbers) {
      refuse(column, value, "an AGV is a whole number from 0 to 65535, in the order of the fleet");
    }
    return AgvId{number};
  }

  // Digit by digit: a double would lose the nanoseconds of an epoch.
  Duration time(std::string_view column, std::string_view value) const {
    const auto point = value.find('.');
    const auto whole = value.substr(0, point);
    const auto fraction = point == std::string_view::npos ? std::string_view{} : value.substr(point + 1);
    if (whole.empty() || whole.size() > kMostWholeDigits || !all_digits(whole) || !all_digits(fraction)) {
      refuse(column, value, "a time is a number of seconds such as 12.0375, from 0 to below 9e9");
    }
    std::int64_t whole_s = 0;
    for (const char c : whole) whole_s = 10 * whole_s + (c - '0');
    if (whole_s >= kLatest_s)
      refuse(column, value, "a time is a number of seconds such as 12.0375, from 0 to below 9e9");
    std::int64_t ns = 0;
    for (std::size_t i = 0; i < kFractionDigits; ++i) ns = 10 * ns + (i < fraction.size() ? fraction[i] - '0' : 0);
    return Duration{whole_s * kNanoseconds + ns};
  }

  TextLines lines_;
  std::string source_;
  RadioTrace trace_;
  std::vector<std::size_t> numbers_;  // of the lines where its messages stand
};

}  // namespace

RadioTrace read_radio_trace(const std::string& path) { return parse_radio_trace(read_text_file(path), path); }

RadioTrace parse_radio_trace(std::string_view text, std::string_view source) {
  return RecordingReader(text, source).read();
}

void put_in_order(RadioTrace& trace) {
  std::ranges::stable_sort(trace, {},
                           [](const RecordedMessage& m) { return std::tuple(m.sender, m.receiver, m.sent); });
}

}  // namespace fleetproof
