#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fleetproof::cli {

// Named figures in the order in which they are printed, and rows of them.
class Figures {
 public:
  void add(const std::string& name, double value);  // what is infinite or no number becomes null
  void add(const std::string& name, std::uint64_t value);
  void add(const std::string& name, bool value);
  void add(const std::string& name, const std::optional<std::uint64_t>& value);
  void add(const std::string& name, const std::optional<double>& value);
  void add_row(Figures row) { rows_.push_back(std::move(row)); }

  // For the terminal: a figure per line with ten digits, a row per line. The names are those of the JSON.
  std::string text() const;
  // The same as members of a JSON object, with 17 significant digits. The rows are its array "rows".
  std::string json_members(const std::string& indent) const;

 private:
  struct Figure {
    std::string name, text, json;
  };

  std::vector<Figure> figures_;
  std::vector<Figures> rows_;
};

}  // namespace fleetproof::cli
