#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fleetproof {

// One table of a TOML file, read key by key. Every error names file, line, column and the key; keys that nobody asked
// for are errors too. A thin view: toml++ stays in toml_table.cpp.
class TomlTable {
 public:
  // Parses the file. Throws InputError: no such file, or a syntax error with its line and column.
  static TomlTable read(const std::string& path);
  static TomlTable parse(std::string_view text, const std::string& path);  // `path` is what errors call it
  ~TomlTable();
  TomlTable(TomlTable&&) noexcept;
  TomlTable& operator=(TomlTable&&) = delete;

  // Absent keys leave the value as it is.
  void get(std::string_view key, std::string& value);
  void get(std::string_view key, double& value);
  void get(std::string_view key, bool& value);
  void get(std::string_view key, std::uint64_t& value);
  void get(std::string_view key, std::vector<double>& value);
  void get(std::string_view key, std::vector<std::uint32_t>& value);
  void get(std::string_view key, std::vector<std::string>& value);

  struct Item;
  // An array of strings and tables, as in ["a", { file = "b" }]. Empty if the key is absent.
  std::vector<Item> words_or_tables(std::string_view key);

  // An array of arrays of two strings, as in [["a", "b"]]. Empty if the key is absent.
  std::vector<std::pair<std::string, std::string>> pairs(std::string_view key);

  bool has(std::string_view key) const;
  bool is_table(std::string_view key) const;             // written [key], not [[key]]
  std::optional<TomlTable> table(std::string_view key);  // [key]
  std::vector<TomlTable> tables(std::string_view key);   // [[key]]
  void finish() const;                                   // throws InputError if a key is left that was never asked for
  std::string place(std::string_view key) const;         // "file:line:column" of a key, or of the table

 private:
  struct Impl;
  explicit TomlTable(Impl* impl);
  Impl* impl_;
};

struct TomlTable::Item {
  std::string word;
  std::optional<TomlTable> table;  // instead of a word
};

}  // namespace fleetproof
