#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/field.hpp"

namespace fleetproof {

// One table of a TOML file, read key by key. Every error names file, line, column and the key; a key that was never
// read is an error too. toml++ stays in toml_table.cpp.
class TomlTable {
 public:
  // Parses the file. Throws InputError: no such file, or a syntax error with its line and column.
  static TomlTable read(const std::string& path);
  static TomlTable parse(std::string_view text, const std::string& path);  // `path` is what errors call it
  ~TomlTable();
  TomlTable(TomlTable&&) noexcept;
  TomlTable& operator=(TomlTable&&) = delete;

  // One value of the file, with what errors say about it.
  struct Given {
    GivenValue value;
    std::string place;  // "file:line:column"
    std::string path;   // "law.reaction_s"
    std::string shown;  // the value as errors quote it

    [[noreturn]] void refuse(std::string_view sentence) const;
  };
  std::optional<Given> given(std::string_view key);               // none if the key is absent
  std::optional<std::vector<Given>> array(std::string_view key);  // as in [1, 2]
  struct Row;
  std::vector<Row> arrays(std::string_view key);  // as in [["a", "b"]]; empty if absent

  // A value without a field of its own; absent keys leave it as it is.
  template <PlainValue Value>
  void get(std::string_view key, Value& value) {
    const auto found = given(key);
    if (!found) return;
    const auto sentence = take(Field{.key = key, .text = "", .lenient = kDecidesNothing, .low = -1e300, .high = 1e300},
                               found->value, value);
    if (!sentence.empty()) found->refuse(sentence);
  }

  struct Item;
  // An array of strings and tables, as in ["a", { file = "b" }]. Empty if the key is absent.
  std::vector<Item> words_or_tables(std::string_view key);

  bool has(std::string_view key) const;
  std::vector<std::string> keys() const;                 // of this table, in the order of the alphabet
  bool is_table(std::string_view key) const;             // written [key], not [[key]]
  std::optional<TomlTable> table(std::string_view key);  // [key]
  std::vector<TomlTable> tables(std::string_view key);   // [[key]]
  void finish() const;                                   // throws InputError if a key was never read
  std::string place(std::string_view key) const;         // "file:line:column" of a key, or of the table
  // Of all keys and items below this table: "law.reaction_s", "factors.loss.0".
  std::map<std::string, std::string, std::less<>> places() const;

 private:
  struct Impl;
  explicit TomlTable(Impl* impl);
  Impl* impl_;
};

// The text of a TOML file in which the table number `index` of [[tables]] has `key = value`, with `value` as TOML
// writes it: in the place of the old one, or else on a line of its own behind the value of `after`, a key of that
// table. All else stays as it is. Throws InputError if the text is not valid. `path` is what errors call it.
std::string with_value(std::string text, const std::string& path, std::string_view tables, std::size_t index,
                       std::string_view key, std::string_view value, std::string_view after);

struct TomlTable::Item {
  std::string word;
  std::optional<TomlTable> table;  // instead of a word
  std::string place;
};
struct TomlTable::Row {
  Given whole;
  std::vector<Given> items;
};

}  // namespace fleetproof
