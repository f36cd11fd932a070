#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

namespace fleetproof::html {

// The name of an element: letters and digits of the source itself, never text from outside.
class Word {
 public:
  consteval Word(const char* text) : text_(text) {
    if (text_.empty()) throw "a word has letters";
    for (const char c : text_) {
      const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
      if (!allowed) throw "a word consists of letters, digits and hyphens";
    }
  }
  std::string_view text() const { return text_; }

 private:
  std::string_view text_;
};

// The name of an attribute. Those that style something, run something or fetch something do not compile: a strict
// viewer would drop them.
class AttributeName : public Word {
 public:
  consteval AttributeName(const char* text) : Word(text) {
    const std::string_view name(text);
    if (name == "style" || name.starts_with("on") || name == "href" || name == "src")
      throw "this attribute has no place in a page";
  }
};

// A text of the source itself that needs no escaping, such as a style sheet.
class Literal {
 public:
  consteval Literal(const char* text) : text_(text) {
    for (const char c : text_) {
      if (c == '<' || c == '&') throw "a literal has no character that starts markup";
    }
  }
  std::string_view text() const { return text_; }

 private:
  std::string_view text_;
};

struct Attribute {
  Attribute(AttributeName of, std::string_view text) : name(of), value(text) {}
  Attribute(AttributeName of, const char* text) : name(of), value(text) {}
  Attribute(AttributeName of, const std::string& text) : name(of), value(text) {}
  template <class Number>
  requires std::is_arithmetic_v<Number> Attribute(AttributeName of, Number number)
      : name(of), value(number_text(static_cast<double>(number))) {}

  AttributeName name;
  std::string value;

 private:
  static std::string number_text(double value);  // with at most one decimal: pixels
};

// An element of HTML or SVG with all that is in it. Text and values are made printable and escaped on their way in, so
// a caller cannot forget it. What comes out is well-formed XML, too.
class Element {
 public:
  explicit Element(Word name, std::initializer_list<Attribute> attributes = {});

  Element& text(std::string_view text);   // in one line
  Element& lines(std::string_view text);  // line feeds stay
  Element& add(const Element& child);
  Element& literal(Literal text);
  // The title under which a table of contents lists this element. Without one it is not listed.
  Element& listed_as(std::string title);
  const std::string& title() const { return title_; }
  std::string str() const;

  // A link to the element of this page that has the id. Requires: an id of letters, digits and hyphens.
  static Element link_to(std::string_view id, std::string_view text);
  // A link to a page beside this one, "case-7.html", and to a place in it, "t=12.3"; that may be empty. Requires: both
  // of letters, digits, hyphens, points and equals signs.
  static Element link_to_page(std::string_view page, std::string_view place, std::string_view text);

 private:
  bool is_void() const;

  Word name_;
  std::string attributes_, content_, title_;
};

// An element that has nothing but a text in it.
Element text_element(Word name, std::string_view text, std::initializer_list<Attribute> attributes = {});

}  // namespace fleetproof::html
