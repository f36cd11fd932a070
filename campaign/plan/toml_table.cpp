#include "campaign/plan/toml_table.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <memory>
#include <set>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {

struct TomlTable::Impl {
  std::string file, path_in_file;     // path_in_file: "radio." or ""
  std::shared_ptr<toml::table> root;  // keeps the nodes alive for every view of a part
  const toml::table* table = nullptr;
  std::set<std::string, std::less<>> known;
};

namespace {

std::string at(const std::string& file, const toml::source_region& source) {
  return fmt::format("{}:{}:{}", file, source.begin.line, source.begin.column);
}

const char* kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      return "a date or a time";
    default:
      return "something else";
  }
}

[[noreturn]] void wrong_type(const std::string& file, const toml::node& node, const std::string& key,
                             const char* wanted) {
  throw InputError(at(file, node.source()), fmt::format("{} is {}; it must be {}", key, kind_of(node), wanted));
}

GivenValue value_of(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return flag->get();
  if (const auto* whole = node.as_integer()) return std::int64_t{whole->get()};
  if (const auto* real = node.as_floating_point()) return real->get();
  if (const auto* text = node.as_string()) return text->get();
  return std::monostate{};
}

TomlTable::Given given_by(const std::string& file, const toml::node& node, std::string path) {
  const GivenValue value = value_of(node);
  const bool plain = !std::holds_alternative<std::monostate>(value);
  return {value, at(file, node.source()), std::move(path), plain ? text_of(value) : kind_of(node)};
}

void add_places(const std::string& file, const toml::node& node, const std::string& path,
                std::map<std::string, std::string, std::less<>>& places) {
  if (!path.empty()) places.emplace(path, at(file, node.source()));
  const std::string prefix = path.empty() ? "" : path + ".";
  if (const auto* table = node.as_table()) {
    for (const auto& [key, inner] : *table) add_places(file, inner, prefix + std::string(key.str()), places);
  } else if (const auto* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i)
      add_places(file, *array->get(i), fmt::format("{}{}", prefix, i), places);
  }
}

// toml++ limits the depth of values, but not the depth of keys such as a.b.c. Each part of such a key is a table in the
// table before it, and the destructors of a million tables overflow the stack. Dots in a string count too, if no other
// sign of TOML stands between them.
void refuse_deep_keys(std::string_view text, const std::string& file) {
  constexpr std::size_t kMostDots = 32;
  const bool remarks = text.find("\"\"\"") == std::string_view::npos &&
                       text.find("'''") == std::string_view::npos;  // else a # may stand in a string
  std::size_t number = 0;
  while (!text.empty()) {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    if (const auto first = line.find_first_not_of(" \t");
        remarks && first != std::string_view::npos && line[first] == '#')
      continue;
    std::size_t dots = 0;
    for (const char c : line) {
      if (c == '.' && ++dots > kMostDots) {
        throw InputError(fmt::format("{}:{}", file, number), "more than 32 dots in a key; no key has more than one");
      }
      if (std::string_view("=,[]{}").find(c) != std::string_view::npos) dots = 0;
    }
  }
}

toml::table parsed(std::string_view text, const std::string& path) {
  refuse_deep_keys(text, path);
  try {
    return toml::parse(text, std::string_view(path));
  } catch (const toml::parse_error& error) {
    throw InputError(at(path, error.source()), fmt::format("not valid TOML: {}", error.description()));
  }
}

// toml++ counts columns in code points.
std::size_t byte_at(std::string_view text, toml::source_position position) {
  std::size_t byte = 0;
  for (toml::source_index line = 1; line < position.line; ++line) byte = text.find('\n', byte) + 1;
  const auto is_inside_code_point = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
  for (toml::source_index column = 1; column < position.column && byte < text.size(); ++column) {
    do ++byte;
    while (byte < text.size() && is_inside_code_point(text[byte]));
  }
  return byte;
}

}  // namespace

TomlTable::TomlTable(Impl* impl) : impl_(impl) {}
TomlTable::~TomlTable() { delete impl_; }
TomlTable::TomlTable(TomlTable&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}

TomlTable TomlTable::read(const std::string& path) { return parse(read_text_file(path), path); }

TomlTable TomlTable::parse(std::string_view text, const std::string& path) {
  auto root = std::make_shared<toml::table>(parsed(text, path));
  const toml::table* table = root.get();
  return TomlTable(new Impl{path, "", std::move(root), table, {}});
}

std::string with_value(std::string text, const std::string& path, std::string_view tables, std::size_t index,
                       std::string_view key, std::string_view value, std::string_view after) {
  const toml::table root = parsed(text, path);
  const auto& item = *root.get(tables)->as_array()->get(index)->as_table();
  if (const toml::node* old = item.get(key)) {
    const std::size_t begin = byte_at(text, old->source().begin), end = byte_at(text, old->source().end);
    return text.replace(begin, end - begin, value);
  }
  const std::size_t line = std::min(text.find('\n', byte_at(text, item.get(after)->source().end)), text.size());
  return text.insert(line, fmt::format("\n{} = {}", key, value));
}

bool TomlTable::has(std::string_view key) const { return impl_->table->contains(key); }

bool TomlTable::is_table(std::string_view key) const {
  const toml::node* node = impl_->table->get(key);
  return node != nullptr && node->is_table();
}

std::string TomlTable::place(std::string_view key) const {
  const toml::node* node = impl_->table->get(key);
  return at(impl_->file, node != nullptr ? node->source() : impl_->table->source());
}

namespace {

template <class Take>
void with(const toml::table& table, std::set<std::string, std::less<>>& known, std::string_view key, Take take) {
  known.emplace(key);
  if (const toml::node* node = table.get(key)) take(*node);
}

}  // namespace

void TomlTable::Given::refuse(std::string_view sentence) const {
  throw InputError(place, fmt::format("{}: {} is refused: {}", path, shown, sentence));
}

std::optional<TomlTable::Given> TomlTable::given(std::string_view key) {
  std::optional<Given> found;
  with(*impl_->table, impl_->known, key,
       [&](const toml::node& node) { found = given_by(impl_->file, node, impl_->path_in_file + std::string(key)); });
  return found;
}

std::optional<std::vector<TomlTable::Given>> TomlTable::array(std::string_view key) {
  const auto found = given(key);
  if (!found) return std::nullopt;
  const toml::array* array = impl_->table->get(key)->as_array();
  if (array == nullptr)
    found->refuse(fmt::format("expected an array, as in [{}]",
                              std::holds_alternative<std::monostate>(found->value) ? "1, 2" : found->shown));
  std::vector<Given> items;
  for (const toml::node& item : *array) items.push_back(given_by(impl_->file, item, found->path));
  return items;
}

std::vector<TomlTable::Row> TomlTable::arrays(std::string_view key) {
  constexpr const char* kExpected = "expected an array of arrays, as in [[\"a\", \"b\"]]";
  const auto found = given(key);
  if (!found) return {};
  const toml::array* array = impl_->table->get(key)->as_array();
  if (array == nullptr) found->refuse(kExpected);
  std::vector<Row> rows;
  for (const toml::node& row : *array) {
    const toml::array* items = row.as_array();
    const Given outer = given_by(impl_->file, row, found->path);
    if (items == nullptr) outer.refuse(kExpected);
    rows.push_back({outer, {}});
    for (const toml::node& item : *items) rows.back().items.push_back(given_by(impl_->file, item, found->path));
  }
  return rows;
}

std::map<std::string, std::string, std::less<>> TomlTable::places() const {
  std::map<std::string, std::string, std::less<>> places;
  add_places(impl_->file, *impl_->table, "", places);
  return places;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : *impl_->table) keys.emplace_back(key.str());
  return keys;
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
  std::optional<TomlTable> part;
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    if (!node.is_table()) wrong_type(impl_->file, node, impl_->path_in_file + std::string(key), "a table");
    part.emplace(TomlTable(
        new Impl{impl_->file, impl_->path_in_file + std::string(key) + ".", impl_->root, node.as_table(), {}}));
  });
  return part;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  std::vector<TomlTable> parts;
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr)
      wrong_type(impl_->file, node, impl_->path_in_file + std::string(key), "an array of tables, as in [[gate]]");
    for (const toml::node& element : *array) {
      if (!element.is_table())
        wrong_type(impl_->file, element, impl_->path_in_file + std::string(key), "an array of tables, as in [[gate]]");
      parts.push_back(TomlTable(
          new Impl{impl_->file, impl_->path_in_file + std::string(key) + ".", impl_->root, element.as_table(), {}}));
    }
  });
  return parts;
}

std::vector<TomlTable::Item> TomlTable::words_or_tables(std::string_view key) {
  std::vector<Item> items;
  const std::string name = impl_->path_in_file + std::string(key);
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(impl_->file, node, name, "an array, as in [\"a\", { file = \"b\" }]");
    for (const toml::node& element : *array) {
      if (element.is_string()) {
        items.push_back({*element.value<std::string>(), std::nullopt, at(impl_->file, element.source())});
      } else if (element.is_table()) {
        items.push_back({"", TomlTable(new Impl{impl_->file, name + ".", impl_->root, element.as_table(), {}}),
                         at(impl_->file, element.source())});
      } else {
        wrong_type(impl_->file, element, name, "an array of strings and tables");
      }
    }
  });
  return items;
}

void TomlTable::finish() const {
  const std::vector<std::string_view> known(impl_->known.begin(), impl_->known.end());
  for (const auto& [key, node] : *impl_->table) {
    if (!impl_->known.contains(key.str())) {
      throw InputError(at(impl_->file, key.source()), fmt::format("{}{} is not a known key{}", impl_->path_in_file,
                                                                  key.str(), name_hint(key.str(), known)));
    }
  }
}

}  // namespace fleetproof
