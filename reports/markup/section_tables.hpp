#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/markup/markup.hpp"
#include "reports/page/page.hpp"

namespace fleetproof::html {

// The id of a part: its title in small letters, with a hyphen for all between letters and digits.
std::string id_of(std::string_view title);
// A part of the page with a heading, an id made of the heading, and a place in the table of contents.
Element titled(const std::string& title);
Element paragraph(const std::string& text);

Element table_of(const Table& table);
// A remark as an item of a list: its sentence, and its command as a line to copy.
Element item_of(const Remark& remark);
Element section_of(const Section& section);
// A fold: `summary` shows, a click on it shows what is added to it.
Element fold(const std::string& summary);
// The same as section_of, but a section with more than a few rows or remarks stands folded away below its title.
Element part_of(const Section& section);
// As section_of, with more than a few remarks folded away under `summary`.
Element folded_section_of(const Section& section, const std::string& summary);
// `inside`: what stands between the sentence of the headline and its details, if anything does.
Element headline_of(const Headline& headline, const Element* inside = nullptr);

}  // namespace fleetproof::html
