#include "generators/text/json_writer.hpp"

#include <charconv>
#include <cmath>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

template <class Number>
void append_number(std::string& text, Number number) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number);
  text.append(buffer, end.ptr);
}

}  // namespace

void JsonWriter::open(char opening, char closing, Style style) {
  separate();
  text_ += opening;
  const bool inherited = !levels_.empty() && levels_.back().style == Style::Line;
  levels_.push_back({closing, inherited ? Style::Line : style});
}

void JsonWriter::close() {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.style == Style::Spread && !level.empty) new_line();
  text_ += level.closing;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  string(name);
  text_ += ": ";
  after_key_ = true;
  return *this;
}

void JsonWriter::value(double number) {
  ensure(std::isfinite(number), "only finite numbers are written to JSON");
  separate();
  append_number(text_, number + 0.0);  // -0 would come back as the whole number 0
}

void JsonWriter::value(std::int64_t number) {
  separate();
  append_number(text_, number);
}

void JsonWriter::value(std::uint64_t number) {
  separate();
  append_number(text_, number);
}

void JsonWriter::value(bool flag) {
  separate();
  text_ += flag ? "true" : "false";
}

void JsonWriter::value(std::string_view text) {
  separate();
  string(text);
}

void JsonWriter::value(const Vec2& vector) {
  open_array(Style::Line);
  value(vector.x());
  value(vector.y());
  close();
}

std::string JsonWriter::take() { return std::move(text_) + "\n"; }

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) text_ += ',';
  if (level.style == Style::Spread) {
    new_line();
  } else if (!level.empty) {
    text_ += ' ';
  }
  level.empty = false;
}

void JsonWriter::new_line() {
  text_ += '\n';
  text_.append(2 * levels_.size(), ' ');
}

void JsonWriter::string(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  text_ += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (byte < 0x20) {
      text_ += "\\u00";
      text_ += kHex[byte >> 4];
      text_ += kHex[byte & 15];
    } else {
      text_ += c;
    }
  }
  text_ += '"';
}

}  // namespace fleetproof
