#include "reports/markup/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/markup_text.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof::html {

namespace {

bool is_of_ids(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; }

}  // namespace

std::string Attribute::number_text(double value) {
  ensure(std::isfinite(value), "a number on a page is finite");
  const double tenths = std::round(value * 10.0) / 10.0;
  return fmt::format("{}", tenths == 0.0 ? 0.0 : tenths);
}

Element::Element(Word name, std::initializer_list<Attribute> attributes) : name_(name) {
  for (const Attribute& attribute : attributes)
    attributes_ += fmt::format(" {}=\"{}\"", attribute.name.text(), escaped_for_markup(printable(attribute.value)));
}

Element& Element::text(std::string_view text) {
  content_ += escaped_for_markup(printable(text));
  return *this;
}

Element& Element::lines(std::string_view text) {
  content_ += escaped_for_markup(printable_lines(text));
  return *this;
}

Element& Element::add(const Element& child) {
  content_ += child.str();
  return *this;
}

Element& Element::literal(Literal text) {
  content_ += text.text();
  return *this;
}

Element& Element::listed_as(std::string title) {
  title_ = std::move(title);
  return *this;
}

Element Element::link_to(std::string_view id, std::string_view text) {
  ensure(!id.empty() && std::ranges::all_of(id, is_of_ids), "an id consists of letters, digits and hyphens");
  Element link("a");
  link.attributes_ = fmt::format(" href=\"#{}\"", id);
  return link.text(text);
}

Element Element::link_to_page(std::string_view page, std::string_view place, std::string_view text) {
  const auto is_of_pages = [](char c) { return is_of_ids(c) || c == '.' || c == '='; };
  ensure(!page.empty() && std::ranges::all_of(page, is_of_pages) && std::ranges::all_of(place, is_of_pages),
         "the name of a page consists of letters, digits, hyphens and points");
  Element link("a");
  link.attributes_ = fmt::format(" href=\"{}{}{}\"", page, place.empty() ? "" : "#", place);
  return link.text(text);
}

bool Element::is_void() const { return name_.text() == "meta" || name_.text() == "br"; }

std::string Element::str() const {
  if (is_void()) return fmt::format("<{}{}/>", name_.text(), attributes_);
  return fmt::format("<{0}{1}>{2}</{0}>", name_.text(), attributes_, content_);
}

Element text_element(Word name, std::string_view text, std::initializer_list<Attribute> attributes) {
  Element element(name, attributes);
  element.text(text);
  return element;
}

}  // namespace fleetproof::html
