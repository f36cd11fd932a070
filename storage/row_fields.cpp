#include "storage/row_fields.hpp"

#include <bit>
#include <cstring>

#include "core/base/error.hpp"
#include "storage/row_source.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

std::uint32_t in_range(std::int64_t value) {
  if (value < 0 || value > 0xffffffffLL) throw EngineError("a row holds a number out of range");
  return static_cast<std::uint32_t>(value);
}

}  // namespace

Binder& Binder::operator<<(std::int64_t value) { return insert_.bind(next_++, value), *this; }
Binder& Binder::operator<<(std::uint64_t value) { return *this << std::bit_cast<std::int64_t>(value); }
Binder& Binder::operator<<(double value) { return insert_.bind(next_++, value), *this; }
Binder& Binder::operator<<(const std::string& value) { return insert_.bind_text(next_++, value), *this; }
Binder& Binder::operator<<(std::string&& value) {
  return insert_.bind_text(next_++, value, Insert::Kept::AsCopy), *this;
}
Binder& Binder::operator<<(const char* value) { return insert_.bind_text(next_++, value), *this; }
Binder& Binder::null() { return insert_.bind_null(next_++), *this; }

void Binder::bytes(const std::string& value) { insert_.bind_bytes(next_++, value); }

Binder& Binder::operator<<(const std::vector<std::uint64_t>& digests) {
  if constexpr (std::endian::native == std::endian::little) {  // the memory holds what is stored
    insert_.bind_bytes(next_++, {reinterpret_cast<const char*>(digests.data()), digests.size() * sizeof(digests[0])});
    return *this;
  }
  std::string bytes;
  for (const auto digest : digests) {
    for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(digest >> (8 * i))));
  }
  insert_.bind_bytes(next_++, bytes, Insert::Kept::AsCopy);
  return *this;
}

std::int64_t Taker::i64() { return row_.number(next_++); }
std::uint64_t Taker::u64() { return std::bit_cast<std::uint64_t>(i64()); }
std::uint32_t Taker::u32() { return in_range(i64()); }

void Taker::numbers(std::span<std::int64_t> into) {
  row_.numbers(next_, into);
  next_ += static_cast<int>(into.size());
}

bool Taker::flag() {
  const auto value = i64();
  if (value != 0 && value != 1) throw EngineError("a row holds a yes-or-no field with neither");
  return value == 1;
}

double Taker::real() { return row_.real(next_++); }

FactorValues Taker::factors() {
  FactorValues factors;
  for (double& value : factors.values) value = real();
  return factors;
}

PerFactor<std::optional<double>> Taker::named_factors() {
  PerFactor<std::optional<double>> named;
  for (auto& value : named.values) value = maybe_real();
  return named;
}

std::string Taker::text() { return std::string(row_.bytes(next_++)); }
void Taker::text(std::string& into) { into = row_.bytes(next_++); }

std::optional<std::int64_t> Taker::maybe_i64() {
  const int column = next_++;
  return row_.is_null(column) ? std::nullopt : std::optional<std::int64_t>(row_.number(column));
}

std::optional<double> Taker::maybe_real() {
  const int column = next_++;
  return row_.is_null(column) ? std::nullopt : std::optional(row_.real(column));
}

std::optional<std::uint32_t> Taker::maybe_u32() {
  const auto value = maybe_i64();
  return value ? std::optional(in_range(*value)) : std::nullopt;
}

EntityId Taker::entity() {
  const auto value = maybe_u32();
  return value ? EntityId{*value} : EntityId{};
}

void Taker::digests(std::vector<std::uint64_t>& into) {
  const std::string_view bytes = row_.bytes(next_++);
  if (bytes.size() % 8 != 0) throw EngineError("a row holds running digests of a broken length");
  into.assign(bytes.size() / 8, 0);
  if constexpr (std::endian::native == std::endian::little) {  // the memory holds what is stored
    if (!bytes.empty()) std::memcpy(into.data(), bytes.data(), bytes.size());
    return;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i)
    into[i / 8] |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * (i % 8));
}

}  // namespace fleetproof
