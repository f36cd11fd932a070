#include "generators/formats/rmf_words.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "generators/text/yaml_text.hpp"

namespace fleetproof {

YAML::Node parameter(const YAML::Node& words, const char* word) {
  if (!words.IsDefined() || !words.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  const auto found = words[word];
  return found.IsDefined() && found.IsSequence() && found.size() == 2 ? found[1] : found;
}

std::string text_of(const YAML::Node& words, const char* word) {
  const auto value = parameter(words, word);
  return value.IsDefined() && value.IsScalar() ? value.Scalar() : "";
}

bool names_something(const YAML::Node& words, const char* word) {
  const auto value = parameter(words, word);
  if (!value.IsDefined() || value.IsNull()) return false;
  return !value.IsScalar() || (!value.Scalar().empty() && said_truth(value.Scalar()).value_or(true));
}

YAML::Node attributes_of(const YamlText& yaml, const YAML::Node& list, std::size_t most, std::string_view what) {
  if (!list.IsSequence() || list.size() <= 2) return YAML::Node(YAML::NodeType::Undefined);
  const std::size_t last = list.size() - 1;
  for (std::size_t i = 2; i <= last; ++i) {
    if (list[i].IsMap() ? i == last : i + 1 < most || (i + 1 == most && list[i].IsNull())) continue;
    const std::size_t wrong = list[i].IsMap() ? i + 1 : i;
    yaml.refuse(list, fmt::format("item {} is {}; expected {}, and nothing else", wrong + 1, shown(list[wrong]), what));
  }
  yaml.refuse_second_keys(list[last]);
  return list[last];
}

std::string given_name(const YAML::Node& vertex, bool is_nav_graph) {
  if (!vertex.IsSequence() || vertex.size() < 3) return "";
  if (is_nav_graph) return text_of(vertex[vertex.size() - 1], "name");
  return vertex.size() > 3 && vertex[3].IsScalar() ? vertex[3].Scalar() : "";
}

}  // namespace fleetproof
