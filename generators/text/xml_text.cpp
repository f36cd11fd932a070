#include "generators/text/xml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::string_view kConverted[] = {"utf-16", "utf-32", "iso-8859-1", "latin1", "windows-1252"};

// Where the text is not UTF-8 for the first time; its size if it is UTF-8.
std::size_t end_of_utf8(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kSpace, begin), text.size());
    if (!is_plain_utf8(text.substr(begin, end - begin))) return begin;
    begin = end + 1;
  }
  return text.size();
}

// As the first line of the file declares it, in small letters; empty if it declares none.
std::string declared_encoding(std::string_view text) {
  const auto line = text.substr(0, text.find("?>"));
  const auto key = line.starts_with("<?xml") ? line.find("encoding=") : std::string_view::npos;
  if (key == std::string_view::npos || key + 10 >= line.size()) return {};
  const auto rest = line.substr(key + 10);
  std::string encoding(rest.substr(0, rest.find(line[key + 9])));
  std::ranges::transform(encoding, encoding.begin(), [](unsigned char c) { return std::tolower(c); });
  return encoding;
}

// pugixml would take all but those that it converts for UTF-8.
void refuse_other_encodings(std::string_view text, std::string_view source) {
  const bool wide = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
                    text.substr(0, 4).find('\0') != std::string_view::npos;
  const auto encoding = declared_encoding(text);
  const bool converted = std::ranges::any_of(kConverted, [&](auto known) { return encoding.starts_with(known); });
  if (wide || converted) return;
  const std::size_t end = end_of_utf8(text);
  if (end == text.size()) return;
  throw InputError(
      at_line(source, position_in(text, end).line),
      encoding.empty() || encoding == "utf-8"
          ? "the file is not UTF-8 here, as XML is unless it says otherwise; save it as UTF-8"
          : fmt::format("the file is in {}, which is not read here; save it as UTF-8", in_quotes(encoding)));
}

// Stops at an element that has an attribute twice: pugixml takes the first.
struct SecondAttribute : pugi::xml_tree_walker {
  pugi::xml_node found;
  std::string name;

  bool for_each(pugi::xml_node& node) override {
    std::vector<std::string_view> names;
    for (const auto attribute : node.attributes()) names.emplace_back(attribute.name());
    std::ranges::sort(names);
    const auto second = std::ranges::adjacent_find(names);
    if (second == names.end()) return true;
    found = node;
    name = *second;
    return false;
  }
};

}  // namespace

XmlText::XmlText(std::string_view text, std::string_view source) : text_(text), source_(source) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') line_ends_.push_back(i);
  }
}

void XmlText::load(pugi::xml_document& document) const {
  refuse_other_encodings(text_, source_);
  if (const auto entity = text_.find("<!ENTITY"); entity != std::string_view::npos) {
    const auto at = position_in(text_, entity);
    throw InputError(fmt::format("{}:{}:{}", source_, at.line, at.column),
                     "declares an entity, which is not read; write its text where it is used");
  }
  // Letters are the same in both.
  const bool latin1 = declared_encoding(text_) == "windows-1252";
  const auto result = document.load_buffer(text_.data(), text_.size(), pugi::parse_default,
                                           latin1 ? pugi::encoding_latin1 : pugi::encoding_auto);
  if (result) return refuse_second_attributes(document);
  const auto at = position_in(text_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
  throw InputError(
      fmt::format("{}:{}:{}", source_, at.line, at.column),
      fmt::format("not well-formed XML ({}); is the file complete, and a plant model?", result.description()));
}

void XmlText::refuse_second_attributes(pugi::xml_document& document) const {
  SecondAttribute walk;
  if (document.traverse(walk)) return;
  refuse(walk.found, fmt::format("<{}> has {} twice, which is not well-formed XML; remove one",
                                 printable(walk.found.name()), in_quotes(walk.name)));
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
  return *node.attribute(attribute).value() != '\0';
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
  const std::string_view word = has(node, attribute) ? node.attribute(attribute).value() : "false";
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
