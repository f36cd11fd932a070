#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// What a column of a public view holds. The unit is "none" for words and for counts of things.
struct ColumnMeaning {
  std::string view, column, unit, meaning;
};

// All columns of all public views, in their order. The archive shows them as v1_dictionary, and exported tables take
// the words of equal columns from here.
const std::vector<ColumnMeaning>& column_meanings();

// Requires: the view has the column.
const ColumnMeaning& meaning_of(std::string_view view, std::string_view column);

}  // namespace fleetproof
