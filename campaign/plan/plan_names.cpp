#include "campaign/plan/plan_names.hpp"

#include "core/base/outside_text.hpp"

namespace fleetproof {

const char* fault_of_plan_name(std::string_view name) {
  if (!is_plain_utf8(name)) return "a name is UTF-8 without control characters";
  if (name.find_first_not_of(' ') == std::string_view::npos)
    return "a name has at least one character that is no blank";
  return nullptr;
}

void take_name(TomlTable& table, std::string& name) {
  table.get("name", name);
  const auto given = table.given("name");
  const char* fault = given ? fault_of_plan_name(name) : nullptr;
  if (fault != nullptr) given->refuse(fault);
}

}  // namespace fleetproof
