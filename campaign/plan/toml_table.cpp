#include "campaign/plan/toml_table.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <filesystem>
#include <memory>

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
    default:
      return "something else";
  }
}

[[noreturn]] void wrong_type(const std::string& file, const toml::node& node, const std::string& key,
                             const char* wanted) {
  throw InputError(at(file, node.source()), fmt::format("{} is {}; it must be {}", key, kind_of(node), wanted));
}

double number(const std::string& file, const toml::node& node, const std::string& key) {
  if (!node.is_number()) wrong_type(file, node, key, "a number");
  const double value = *node.value<double>();
  if (!(value > -1e300 && value < 1e300))
    throw InputError(at(file, node.source()), fmt::format("{} is not a finite number", key));
  return value;
}

std::uint64_t whole(const std::string& file, const toml::node& node, const std::string& key, std::uint64_t most) {
  if (!node.is_integer()) wrong_type(file, node, key, "a whole number");
  const std::int64_t value = *node.value<std::int64_t>();
  if (value < 0 || static_cast<std::uint64_t>(value) > most) {
    throw InputError(at(file, node.source()),
                     fmt::format("{} is {}; it must be a whole number from 0 to {}", key, value, most));
  }
  return static_cast<std::uint64_t>(value);
}

// toml++ bounds the depth of values, but not that of keys such as a.b.c, each part of which is a table within the one
// before: the destructors of a million of them overflow the stack. Dots in a string count too, as long as no other sign
// of TOML stands between them.
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

}  // namespace

TomlTable::TomlTable(Impl* impl) : impl_(impl) {}
TomlTable::~TomlTable() { delete impl_; }
TomlTable::TomlTable(TomlTable&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}

TomlTable TomlTable::read(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path, "there is no such file; check the path of the campaign file");
  return parse(read_text_file(path), path);
}

TomlTable TomlTable::parse(std::string_view text, const std::string& path) {
  refuse_deep_keys(text, path);
  try {
    auto root = std::make_shared<toml::table>(toml::parse(text, std::string_view(path)));
    const toml::table* table = root.get();
    return TomlTable(new Impl{path, "", std::move(root), table, {}});
  } catch (const toml::parse_error& error) {
    throw InputError(at(path, error.source()), fmt::format("not valid TOML: {}", error.description()));
  }
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

template <class T, class Read>
void read_array(const std::string& file, const toml::node& node, const std::string& key, std::vector<T>& value,
                Read read) {
  const toml::array* array = node.as_array();
  if (array == nullptr) wrong_type(file, node, key, "an array, as in [1, 2]");
  value.clear();
  for (const toml::node& element : *array) value.push_back(read(element));
}

}  // namespace

void TomlTable::get(std::string_view key, std::string& value) {
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    if (!node.is_string()) wrong_type(impl_->file, node, impl_->path_in_file + std::string(key), "a string in quotes");
    value = *node.value<std::string>();
  });
}

void TomlTable::get(std::string_view key, double& value) {
  with(*impl_->table, impl_->known, key,
       [&](const toml::node& node) { value = number(impl_->file, node, impl_->path_in_file + std::string(key)); });
}

void TomlTable::get(std::string_view key, bool& value) {
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    if (!node.is_boolean()) wrong_type(impl_->file, node, impl_->path_in_file + std::string(key), "true or false");
    value = *node.value<bool>();
  });
}

void TomlTable::get(std::string_view key, std::uint64_t& value) {
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    value = whole(impl_->file, node, impl_->path_in_file + std::string(key), std::numeric_limits<std::int64_t>::max());
  });
}

void TomlTable::get(std::string_view key, std::vector<double>& value) {
  const std::string name = impl_->path_in_file + std::string(key);
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    read_array(impl_->file, node, name, value,
               [&](const toml::node& element) { return number(impl_->file, element, name); });
  });
}

void TomlTable::get(std::string_view key, std::vector<std::uint32_t>& value) {
  const std::string name = impl_->path_in_file + std::string(key);
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    read_array(impl_->file, node, name, value, [&](const toml::node& element) {
      return static_cast<std::uint32_t>(whole(impl_->file, element, name, 1'000'000));
    });
  });
}

void TomlTable::get(std::string_view key, std::vector<std::string>& value) {
  const std::string name = impl_->path_in_file + std::string(key);
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    read_array(impl_->file, node, name, value, [&](const toml::node& element) {
      if (!element.is_string()) wrong_type(impl_->file, element, name, "an array of strings");
      return *element.value<std::string>();
    });
  });
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
        items.push_back({*element.value<std::string>(), std::nullopt});
      } else if (element.is_table()) {
        items.push_back({"", TomlTable(new Impl{impl_->file, name + ".", impl_->root, element.as_table(), {}})});
      } else {
        wrong_type(impl_->file, element, name, "an array of strings and tables");
      }
    }
  });
  return items;
}

std::vector<std::pair<std::string, std::string>> TomlTable::pairs(std::string_view key) {
  constexpr const char* kWanted = "an array of pairs, as in [[\"a\", \"b\"]]";
  std::vector<std::pair<std::string, std::string>> pairs;
  const std::string name = impl_->path_in_file + std::string(key);
  with(*impl_->table, impl_->known, key, [&](const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(impl_->file, node, name, kWanted);
    for (const toml::node& element : *array) {
      const toml::array* pair = element.as_array();
      if (pair == nullptr || pair->size() != 2 || !pair->get(0)->is_string() || !pair->get(1)->is_string())
        wrong_type(impl_->file, element, name, kWanted);
      pairs.emplace_back(*pair->get(0)->value<std::string>(), *pair->get(1)->value<std::string>());
    }
  });
  return pairs;
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
