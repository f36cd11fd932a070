#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace YAML {
class Node;
}

namespace fleetproof {

// Reads values from YAML. Its errors contain file and line.
class YamlText {
 public:
  // Requires: the name outlives the object.
  explicit YamlText(std::string_view source) : source_(source) {}

  std::string_view source() const { return source_; }
  std::string place(const YAML::Node& node) const;  // "file:line"
  [[noreturn]] void refuse(const YAML::Node& node, std::string_view sentence) const;

  // `what` names the list, number or index in an error.
  YAML::Node item(const YAML::Node& list, std::size_t index, std::string_view what) const;
  YAML::Node list(const YAML::Node& map, const char* key, std::string_view what) const;
  // Refuses a key that the map has twice: YAML forbids it, and each program reads another one of the two.
  void refuse_second_keys(const YAML::Node& map) const;
  double number(const YAML::Node& node, std::string_view what) const;
  bool truth(const YAML::Node& node, std::string_view what) const;
  std::size_t index_below(std::size_t count, const YAML::Node& node, std::string_view what) const;

 private:
  std::string_view source_;
};

// Words for true and false as files have them: true, yes, on, 1 and their opposites, in small letters, in capitals or
// with one capital. None for every other text.
std::optional<bool> said_truth(std::string_view text);

// A value as an error prints it.
std::string shown(const YAML::Node& node);

}  // namespace fleetproof
