#pragma once

#include <vector>

#include "reports/html/markup.hpp"
#include "reports/page.hpp"

namespace fleetproof::html {

// A part of the page with a heading.
Element titled(const std::string& title);
Element paragraph(const std::string& text);

Element table_of(const Table& table);
// A remark as an item of a list: its sentence, and its command as a line to copy.
Element item_of(const Remark& remark);
Element section_of(const Section& section);
// The same, with more than a few remarks folded away under `summary`.
Element folded_section_of(const Section& section, const std::string& summary);
Element headline_of(const Headline& headline);

}  // namespace fleetproof::html
