#include "generators/text/xml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "core/base/error.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

}  // namespace

XmlText::XmlText(std::string_view text, std::string_view source) : text_(text), source_(source) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') line_ends_.push_back(i);
  }
}

void XmlText::load(pugi::xml_document& document) const {
  const auto result = document.load_buffer(text_.data(), text_.size());
  if (result) return;
  const auto at = position_in(text_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
  throw InputError(
      fmt::format("{}:{}:{}", source_, at.line, at.column),
      fmt::format("not well-formed XML ({}); is the file complete, and a plant model?", result.description()));
}

std::string XmlText::place(const pugi::xml_node& node) const {
  const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
  const auto before = std::ranges::lower_bound(line_ends_, offset) - line_ends_.begin();
  return at_line(source_, static_cast<std::size_t>(before) + 1);
}

void XmlText::refuse(const pugi::xml_node& node, std::string_view sentence) const {
  throw InputError(place(node), sentence);
}

bool XmlText::has(const pugi::xml_node& node, const char* attribute) const {
  return !node.attribute(attribute).empty();
}

std::string XmlText::text(const pugi::xml_node& node, const char* attribute) const {
  const auto found = node.attribute(attribute);
  if (found.empty()) refuse(node, fmt::format("<{}> has no attribute \"{}\"; add it", node.name(), attribute));
  return found.value();
}

double XmlText::number(const pugi::xml_node& node, const char* attribute) const {
  const auto word = text(node, attribute);
  double value = 0.0;
  if (!read_number(word, value))
    refuse(node, fmt::format("{} of <{}> is {}; expected a finite number", attribute, node.name(), in_quotes(word)));
  return value;
}

bool XmlText::truth(const pugi::xml_node& node, const char* attribute) const {
  const std::string_view word = node.attribute(attribute).as_string("false");
  if (word != "true" && word != "1" && word != "false" && word != "0")
    refuse(node, fmt::format("{} of <{}> is {}; expected true or false", attribute, node.name(), in_quotes(word)));
  return word == "true" || word == "1";
}

bool read_number(std::string_view text, double& value) {
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return false;
  text = text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(value);
}

}  // namespace fleetproof
