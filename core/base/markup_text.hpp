#pragma once

#include <string>
#include <string_view>

namespace fleetproof {

// A text as content or attribute value of HTML, SVG or XML: & < > " and ' are written as references, so that no text
// is read as markup. Characters that XML forbids stay; give it printable text.
std::string escaped_for_markup(std::string_view text);

}  // namespace fleetproof
