#include "storage/table_pages.hpp"

#include <SQLiteCpp/Database.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "storage/opened_file.hpp"
#include "storage/schema.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kPage = kPageSize, kFileHeader = 100, kMostLevels = 20;
// How much of a record stands in the page itself, at most and at least.
constexpr std::uint64_t kMostLocal = (kPage - 12) * 64 / 255 - 23, kLeastLocal = (kPage - 12) * 32 / 255 - 23;

// Requires: they are in the page.
std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::vector<std::string> words_of(const std::string& columns) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < columns.size();) {
    const std::size_t end = std::min(columns.find(", ", at), columns.size());
    words.push_back(columns.substr(at, end - at));
    at = end + 2;
  }
  return words;
}

// Where the record of a row has these columns. Nothing if it has others, or if the key is not in front.
std::optional<std::vector<std::size_t>> places_of(SQLite::Database& db, const std::string& table,
                                                  const std::string& columns) {
  std::vector<std::string> stored;
  Query info(db, "SELECT name, pk FROM pragma_table_info(?) ORDER BY cid");
  info.bind(1, table);
  bool key_is_in_front = true;
  while (info.step()) {
    stored.emplace_back(info.bytes(0));
    const auto key = static_cast<std::size_t>(info.number(1));
    key_is_in_front = key_is_in_front && (key == 0 || key == stored.size());
  }
  std::vector<std::size_t> places;
  for (const std::string& word : words_of(columns)) {
    const auto found = std::ranges::find(stored, word);
    if (found == stored.end()) return std::nullopt;
    places.push_back(static_cast<std::size_t>(found - stored.begin()));
  }
  return key_is_in_front && places.size() == stored.size() ? std::optional(places) : std::nullopt;
}

}  // namespace

// A page, and what of it has been visited.
struct TablePages::Level {
  std::string bytes;
  std::size_t header = 0;  // of the tree page
  std::size_t cells = 0, next = 0;
  bool is_leaf = true, was_below = false;

  std::size_t cell_list() const { return header + (is_leaf ? 8 : 12); }
};

TablePages::TablePages(SQLite::Database& db, std::string path, std::vector<std::size_t> places)
    : db_(db), path_(std::move(path)), places_(std::move(places)), values_(places_.size()) {}
TablePages::~TablePages() = default;

std::unique_ptr<TablePages> TablePages::open(SQLite::Database& db, const std::string& path, const std::string& table,
                                             const std::string& columns) {
  Query found(db, "SELECT rootpage, sql FROM main.sqlite_schema WHERE type = 'table' AND name = ?");
  found.bind(1, table);
  if (!found.step() || !found.bytes(1).ends_with("WITHOUT ROWID")) return nullptr;
  auto places = places_of(db, table, columns);
  if (!places) return nullptr;
  std::unique_ptr<TablePages> pages(new TablePages(db, path, std::move(*places)));
  constexpr std::size_t kPageSizeAt = 16, kReservedAt = 20, kPageCountAt = 28;
  std::string head(kFileHeader, '\0');
  pages->read(head, 0);
  if (big_endian(head, kPageSizeAt, 2) != kPage || big_endian(head, kReservedAt, 1) != 0) return nullptr;
  pages->unread_ = big_endian(head, kPageCountAt, 4);
  pages->descend(static_cast<std::uint32_t>(found.number(0)));
  return pages;
}

void TablePages::broken(const std::string& what) const { throw_damaged(path_, "a page of a table " + what); }

// Through SQLite's own descriptor: if this process closed another one, SQLite would lose its locks.
void TablePages::read(std::string& bytes, std::int64_t at) const {
  sqlite3_file* file = nullptr;
  sqlite3_file_control(db_.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &file);
  const int code = file->pMethods->xRead(file, bytes.data(), static_cast<int>(bytes.size()), at);
  if (code == SQLITE_IOERR_SHORT_READ) broken("is beyond the end of the file");
  if (code != SQLITE_OK)
    throw MachineError(fmt::format("{}: the disk refused to read; look at the disk (SQLite {})", path_, code));
}

void TablePages::read_page(std::uint32_t page, std::string& bytes) {
  if (page == 0 || unread_ == 0) broken("leads to no page of the table");
  --unread_;
  bytes.resize(kPage);
  read(bytes, (std::int64_t{page} - 1) * kPageSize);
}

void TablePages::descend(std::uint32_t page) {
  constexpr std::uint32_t kInterior = 2, kLeaf = 10;
  if (depth_ == kMostLevels) broken("is too far from the root");
  if (depth_ == levels_.size()) levels_.push_back(std::make_unique<Level>());
  Level& level = *levels_[depth_++];
  read_page(page, level.bytes);
  level.header = page == 1 ? kFileHeader : 0;
  const std::uint32_t kind = big_endian(level.bytes, level.header, 1);
  if (kind != kInterior && kind != kLeaf) broken("is of another kind");
  level.is_leaf = kind == kLeaf;
  level.cells = big_endian(level.bytes, level.header + 3, 2);
  level.next = 0;
  level.was_below = false;
  if (level.cell_list() + 2 * level.cells > kPage) broken("has more rows than fit");
}

// Where the next cell begins: its page below, if it has one, then its record.
std::size_t TablePages::next_cell(const Level& level) const {
  const std::size_t at = big_endian(level.bytes, level.cell_list() + 2 * level.next, 2);
  if (at + 4 >= kPage) broken("has a row beyond its end");
  return at;
}

// In the order of the key: the pages below a cell, the cell; at last the pages below the end.
bool TablePages::step() {
  while (depth_ > 0) {
    Level& level = *levels_[depth_ - 1];
    if (!level.is_leaf && !level.was_below) {
      level.was_below = true;
      descend(big_endian(level.bytes, level.next < level.cells ? next_cell(level) : level.header + 8, 4));
      continue;
    }
    level.was_below = false;
    if (level.next == level.cells) {
      --depth_;
      continue;
    }
    take_cell(level);
    ++level.next;
    return true;
  }
  return false;
}

void TablePages::take_cell(const Level& level) {
  std::string_view rest = std::string_view(level.bytes).substr(next_cell(level) + (level.is_leaf ? 0 : 4));
  try {
    const std::uint64_t size = take_varint(rest);
    if (size <= kMostLocal) return take_record(rest.substr(0, size));
    const std::uint64_t fitting = kLeastLocal + (size - kLeastLocal) % (kPage - 4);
    const std::uint64_t local = fitting <= kMostLocal ? fitting : kLeastLocal;
    if (local + 4 > rest.size()) broken("has a row beyond its end");
    gather(rest.substr(0, local), big_endian(rest, local, 4), size);
    take_record(long_record_);
  } catch (const BrokenRecord& e) {
    throw_damaged(path_, e.what());
  }
}

void TablePages::take_record(std::string_view record) {
  read_record(record, values_);
  if (values_.front().kind != StoredValue::Kind::Number) throw BrokenRecord("a row has no key");
}

// The rest of the record is on a list of pages.
void TablePages::gather(std::string_view local, std::uint32_t page, std::uint64_t size) {
  long_record_ = local;
  while (long_record_.size() < size) {
    read_page(page, overflow_);
    page = big_endian(overflow_, 0, 4);
    long_record_.append(overflow_, 4, static_cast<std::size_t>(size - long_record_.size()));
  }
}

std::int64_t TablePages::number(int column) const {
  const StoredValue& found = value(column);
  if (found.kind != StoredValue::Kind::Number) throw BrokenRecord("a row holds something else than a number");
  return found.number;
}

void TablePages::numbers(int column, std::span<std::int64_t> into) const {
  for (std::int64_t& number : into) number = TablePages::number(column++);
}

// A real number without a fraction is stored as a whole one.
double TablePages::real(int column) const {
  const StoredValue& found = value(column);
  return found.kind == StoredValue::Kind::Real ? found.real : static_cast<double>(number(column));
}

std::string_view TablePages::bytes(int column) const {
  const StoredValue& found = value(column);
  if (found.kind != StoredValue::Kind::Bytes) throw BrokenRecord("a row holds something else than bytes");
  return found.bytes;
}

}  // namespace fleetproof
