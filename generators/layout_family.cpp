#include "generators/layout_family.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "generators/aisle_grid.hpp"
#include "generators/corridor_sidings.hpp"
#include "generators/text_file.hpp"

namespace fleetproof {
namespace {

constexpr Entry<MakeLayout> kFamilies[] = {
    {"aisle-grid", "4-6 aisles between 2-3 cross aisles, one-way or two-way, with storage bays, docks, parking and chargers; 49-83 segments",
     make_aisle_grid},
    {"corridor-sidings", "one two-way lane of 30-60 m with sidings to let others pass, storage spurs at both ends and along it; 17-39 segments",
     make_corridor_sidings},
};

}  // namespace

std::span<const Entry<MakeLayout>> layout_families() { return kFamilies; }

const Entry<MakeLayout>& layout_family(std::string_view name) {
  if (const auto* found = find_entry(layout_families(), name)) return *found;
  throw InputError("layout", fmt::format("there is no layout family {}{}", in_quotes(name), name_hint(name, names_of(layout_families()))));
}

}  // namespace fleetproof
