#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pugi {
class xml_node;
class xml_document;
}  // namespace pugi

namespace fleetproof {

// An XML text with a name. It reads attributes; its errors contain "file:line".
class XmlText {
 public:
  // Requires: text and name outlive the object.
  XmlText(std::string_view text, std::string_view source);

  // Throws InputError with its line if the text is not well-formed.
  void load(pugi::xml_document& document) const;

  std::string place(const pugi::xml_node& node) const;  // "file:line"
  [[noreturn]] void refuse(const pugi::xml_node& node, std::string_view sentence) const;

  // An attribute without a text is none.
  bool has(const pugi::xml_node& node, const char* attribute) const;
  // Throws InputError if the attribute is missing or, for a number, not finite.
  std::string text(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute) const;
  // A boolean of XML: true, 1, false or 0. False if there is no such attribute. Throws InputError for other values.
  bool truth(const pugi::xml_node& node, const char* attribute) const;

 private:
  void refuse_second_attributes(pugi::xml_document& document) const;

  std::string_view text_, source_;
  std::vector<std::size_t> line_ends_;
};

// Whether the whole `text` is a finite decimal number. If so, `value` is set to it.
bool read_number(std::string_view text, double& value);

}  // namespace fleetproof
