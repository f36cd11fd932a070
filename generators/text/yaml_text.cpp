#include "generators/text/yaml_text.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <set>
#include <utility>

#include "core/base/error.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {

std::string YamlText::place(const YAML::Node& node) const {
  const auto line = node.Mark().line;
  return line < 0 ? std::string(source_) : at_line(source_, static_cast<std::size_t>(line) + 1);
}

void YamlText::refuse(const YAML::Node& node, std::string_view sentence) const {
  throw InputError(place(node), sentence);
}

YAML::Node YamlText::item(const YAML::Node& list, std::size_t index, std::string_view what) const {
  if (!list.IsSequence() || list.size() <= index)
    refuse(list, fmt::format("{} is {} of {} items; expected more", what, shown(list), list.size()));
  return list[index];
}

YAML::Node YamlText::list(const YAML::Node& map, const char* key, std::string_view what) const {
  const auto found = map[key];
  if (!found.IsDefined()) refuse(map, fmt::format("{} has no \"{}\"; add them", what, key));
  if (!found.IsSequence()) refuse(found, fmt::format("{} is {}; expected a list", key, shown(found)));
  return found;
}

void YamlText::refuse_second_keys(const YAML::Node& map) const {
  if (!map.IsMap()) return;
  std::set<std::string> keys;
  for (const auto entry : map) {
    if (entry.first.IsScalar() && !keys.insert(entry.first.Scalar()).second)
      refuse(entry.first, fmt::format("the key {} is there twice; remove one of them", shown(entry.first)));
  }
}

double YamlText::number(const YAML::Node& node, std::string_view what) const {
  double value = 0.0;
  if (!node.IsScalar() || !read_number(node.Scalar(), value))
    refuse(node, fmt::format("{} is {}; expected a finite number", what, shown(node)));
  return value;
}

bool YamlText::truth(const YAML::Node& node, std::string_view what) const {
  const auto said = node.IsScalar() ? said_truth(node.Scalar()) : std::nullopt;
  if (!said) refuse(node, fmt::format("{} is {}; expected true or false", what, shown(node)));
  return *said;
}

std::size_t YamlText::index_below(std::size_t count, const YAML::Node& node, std::string_view what) const {
  std::size_t index = 0;
  const auto text = node.IsScalar() ? node.Scalar() : std::string();
  const auto read = std::from_chars(text.data(), text.data() + text.size(), index);
  if (read.ec == std::errc() && read.ptr == text.data() + text.size() && index < count) return index;
  refuse(node, fmt::format("{} {}; there are 0 to {}", what, shown(node), count - 1));
}

std::optional<bool> said_truth(std::string_view text) {
  for (const auto& [yes, no] : {std::pair<std::string_view, std::string_view>{"true", "false"},
                                {"True", "False"},
                                {"TRUE", "FALSE"},
                                {"yes", "no"},
                                {"Yes", "No"},
                                {"YES", "NO"},
                                {"on", "off"},
                                {"On", "Off"},
                                {"ON", "OFF"},
                                {"1", "0"}}) {
    if (text == yes) return true;
    if (text == no) return false;
  }
  return std::nullopt;
}

std::string shown(const YAML::Node& node) {
  return node.IsScalar() ? in_quotes(node.Scalar()) : node.IsMap() ? "a map" : node.IsSequence() ? "a list" : "nothing";
}

}  // namespace fleetproof
