#include "generators/text/json_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kDeepest = 32, kMostKeys = 1000;

// Reads the text for nlohmann's lexer and counts the lines. There is no other way to learn the line of a value.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    auto before = *this;
    ++*this;
    return before;
  }
  friend bool operator!=(const CountingIterator& a, const CountingIterator& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  const char** reached_;
};

// Builds the tree from nlohmann's events.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, std::string_view source, const char** reached)
      : text_(text), source_(source), counted_(text.data()), reached_(reached) {
    open_.push_back(&root_);
  }

  JsonValue take() { return root_.items.empty() ? JsonValue{} : std::move(root_.items[0]); }

  bool null() override { return add({}); }
  bool boolean(bool value) override { return add(scalar(value)); }
  bool number_integer(std::int64_t value) override { return add(scalar(value), 1); }
  bool number_unsigned(std::uint64_t value) override { return add(scalar(value), 1); }
  bool number_float(double value, const std::string&) override { return add(scalar(value), 1); }
  bool string(std::string& value) override { return add(scalar(std::move(value))); }
  bool binary(nlohmann::json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonValue::Shape::Object); }
  bool start_array(std::size_t) override { return open(JsonValue::Shape::Array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& value) override {
    auto& keys = open_.back()->keys;
    if (std::ranges::find(keys, value) != keys.end()) {
      throw InputError(at_line(source_, line_here(0)),
                       fmt::format("key {} appears twice in one object; keep one", in_quotes(value)));
    }
    if (keys.size() == kMostKeys)
      throw InputError(at_line(source_, line_here(0)),
                       "one object has more than 1000 keys, more than any file that is read here has");
    keys.push_back(value);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    const auto at = position_in(text_, position > 0 ? position - 1 : 0);
    std::string_view reason = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ...": the place is printed in the
    // way of this program.
    for (const std::string_view skip : {"] ", "column "}) {
      if (const auto found = reason.find(skip); found != std::string_view::npos)
        reason.remove_prefix(found + skip.size());
    }
    reason.remove_prefix(std::min(reason.find_first_not_of("0123456789: "), reason.size()));
    throw InputError(fmt::format("{}:{}:{}", source_, at.line, at.column), "not JSON: " + std::string(reason));
  }

 private:
  template <class T>
  static JsonValue scalar(T&& value) {
    JsonValue made;
    made.scalar = std::forward<T>(value);
    return made;
  }

  // The lexer reads one character beyond a number. That character may already be on the next line.
  std::size_t line_here(std::size_t read_ahead) {
    const char* here = *reached_ - read_ahead;
    if (here > counted_) {
      line_ += static_cast<std::size_t>(std::count(counted_, here, '\n'));
      counted_ = here;
    }
    return line_;
  }

  bool add(JsonValue value, std::size_t read_ahead = 0) {
    value.line = line_here(read_ahead);
    open_.back()->items.push_back(std::move(value));
    return true;
  }

  bool open(JsonValue::Shape shape) {
    if (open_.size() > kDeepest)
      throw InputError(at_line(source_, line_here(0)),
                       "values are nested deeper than 32 levels, deeper than in any file that is read here");
    JsonValue value;
    value.shape = shape;
    add(std::move(value));
    // Stable until this container is closed: its parent gets no further item before.
    open_.push_back(&open_.back()->items.back());
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_, source_;
  const char* counted_;
  const char** reached_;
  std::size_t line_ = 1;
  JsonValue root_;
  std::vector<JsonValue*> open_;
};

struct ScalarText {
  std::string operator()(std::nullptr_t) const { return "null"; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return in_quotes(value); }
  template <class Number>
  std::string operator()(Number value) const {
    return fmt::format("{}", value);
  }
};

std::string shown(const JsonValue& value) {
  if (value.shape == JsonValue::Shape::Scalar) return std::visit(ScalarText{}, value.scalar);
  const bool is_array = value.shape == JsonValue::Shape::Array;
  std::string text = is_array ? "[" : "{";
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    if (text.size() > 60) return text + (is_array ? ", ...]" : ", ...}");
    if (i > 0) text += ", ";
    text += is_array ? shown(value.items[i]) : in_quotes(value.keys[i]);
  }
  return text + (is_array ? "]" : "}");
}

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

JsonValue parse_json(std::string_view text, std::string_view source) {
  if (text.empty()) throw InputError(source, "is empty; expected a JSON object");
  require_utf8(text, source);
  // The parser would take it for the end of the text.
  if (const auto zero = text.find('\0'); zero != text.npos)
    throw InputError(at_line(source, position_in(text, zero).line), "has a byte 0, as no text has; save it as UTF-8");
  const char* reached = text.data();
  TreeBuilder builder(text, source, &reached);
  nlohmann::json::sax_parse(CountingIterator(text.data(), &reached),
                            CountingIterator(text.data() + text.size(), &reached), &builder);
  return builder.take();
}

void JsonReader::expect_object(std::span<const std::string_view> keys) const {
  if (value_->shape != JsonValue::Shape::Object) refuse("expected an object { ... }");
  for (std::size_t i = 0; i < value_->keys.size(); ++i) {
    const auto& key = value_->keys[i];
    if (std::ranges::find(keys, key) != keys.end()) continue;
    throw InputError(at_line(source_, value_->items[i].line),
                     fmt::format("{}: unknown key {}{}", pointer_.empty() ? "top level" : pointer_, in_quotes(key),
                                 name_hint(key, keys)));
  }
}

JsonReader JsonReader::at(std::string_view key) const {
  if (auto found = find(key)) return *std::move(found);
  throw InputError(at_line(source_, value_->line),
                   fmt::format("{}: \"{}\" is missing; add it", pointer_.empty() ? "top level" : pointer_, key));
}

std::optional<JsonReader> JsonReader::find(std::string_view key) const {
  const JsonValue* found = value_->find(key);
  if (found == nullptr) return std::nullopt;
  return JsonReader(*found, source_, fmt::format("{}/{}", pointer_, key));
}

std::vector<JsonReader> JsonReader::items() const {
  if (value_->shape != JsonValue::Shape::Array) refuse("expected an array [ ... ]");
  std::vector<JsonReader> readers;
  readers.reserve(value_->items.size());
  for (std::size_t i = 0; i < value_->items.size(); ++i)
    readers.emplace_back(value_->items[i], source_, fmt::format("{}/{}", pointer_, i));
  return readers;
}

std::string JsonReader::text() const {
  const auto* text = std::get_if<std::string>(&value_->scalar);
  if (text == nullptr) refuse("expected a text in double quotes");
  return *text;
}

double JsonReader::number() const {
  if (const auto* real = std::get_if<double>(&value_->scalar)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&value_->scalar)) return static_cast<double>(*whole);
  if (const auto* natural = std::get_if<std::uint64_t>(&value_->scalar)) return static_cast<double>(*natural);
  refuse("expected a number");
}

bool JsonReader::boolean() const {
  const auto* flag = std::get_if<bool>(&value_->scalar);
  if (flag == nullptr) refuse("expected true or false");
  return *flag;
}

std::int64_t JsonReader::integer() const {
  if (const auto* whole = std::get_if<std::int64_t>(&value_->scalar)) return *whole;
  const auto* natural = std::get_if<std::uint64_t>(&value_->scalar);
  if (natural == nullptr || *natural > static_cast<std::uint64_t>(INT64_MAX))
    refuse("expected a whole number within 64 bits");
  return static_cast<std::int64_t>(*natural);
}

std::uint64_t JsonReader::natural() const {
  const auto* natural = std::get_if<std::uint64_t>(&value_->scalar);
  if (natural == nullptr) refuse("expected a whole number, 0 or more, within 64 bits");
  return *natural;
}

Vec2 JsonReader::vector() const {
  if (value_->shape != JsonValue::Shape::Array || value_->items.size() != 2) refuse("expected two numbers [x, y]");
  const auto both = items();
  return {both[0].number(), both[1].number()};
}

// A vector that is a unit vector to the last digits stays as it is: what is written and read again is unchanged.
Vec2 JsonReader::heading() const {
  const Vec2 heading = vector();
  const double norm = heading.norm();
  if (!(norm > kShortestHeading) || !(norm < 1e9)) refuse("a heading is a direction [x, y] other than [0, 0]");
  return std::abs(heading.squaredNorm() - 1.0) <= kUnitVectorToTheLastDigits ? heading : Vec2(heading / norm);
}

void JsonReader::read(std::string_view key, double& target) const {
  if (const auto found = find(key)) target = found->number();
}

void JsonReader::read(std::string_view key, bool& target) const {
  if (const auto found = find(key)) target = found->boolean();
}

void JsonReader::read(std::string_view key, std::string& target) const {
  if (const auto found = find(key)) target = found->text();
}

std::string JsonReader::place() const { return at_line(source_, value_->line); }

void JsonReader::refuse(std::string_view sentence) const {
  throw InputError(
      at_line(source_, value_->line),
      fmt::format("{}: {} is refused: {}", pointer_.empty() ? "top level" : pointer_, shown(*value_), sentence));
}

void JsonReader::refuse_below(std::string_view pointer, std::string_view sentence) const {
  if (pointer.empty()) refuse(sentence);
  const auto step = pointer.substr(1, pointer.find('/', 1) - 1);
  const auto rest = pointer.substr(step.size() + 1);
  std::optional<JsonReader> next;
  if (value_->shape == JsonValue::Shape::Object) {
    next = find(step);
    if (!next && step.ends_with("_ns")) next = find(std::string(step.substr(0, step.size() - 2)) + "s");
  } else if (value_->shape == JsonValue::Shape::Array) {
    std::size_t index = 0;
    for (const char c : step) index = index * 10 + static_cast<std::size_t>(c - '0');
    if (index < value_->items.size()) next = items()[index];
  }
  if (!next) refuse(sentence);
  next->refuse_below(rest, sentence);
}

}  // namespace fleetproof
