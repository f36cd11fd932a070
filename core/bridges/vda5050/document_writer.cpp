#include <charconv>
#include <cmath>

#include "core/bridges/vda5050/document_fields.hpp"

namespace fleetproof::bridges::vda5050 {
namespace {

template <class E>
concept Enumeration = std::is_enum_v<E>;

template <Enumeration E>
std::string_view listed_word(E value) {
  return kWordsOf<E>[static_cast<std::size_t>(value)];
}

// Writes the fields of one object, in the order in which they are listed.
class FieldWriter {
 public:
  FieldWriter(std::string& json, const Version& version) : json_(json), version_(version) {}

  template <class T>
  void operator()(std::string_view key, const T& value) {
    begin(key);
    write(value);
  }
  template <class T>
  void operator()(std::string_view key, const std::optional<T>& value) {
    if (value) (*this)(key, *value);
  }
  void instant(std::string_view key, const std::string& value) { (*this)(key, value); }
  void within(std::string_view key, const auto& value, double, double) { (*this)(key, value); }
  void varying(std::string_view field, const auto& value) {
    if (version_.has(field)) (*this)(field.substr(field.find('.') + 1), value);
  }
  template <class T>
  void may_be_missing(std::string_view key, const std::vector<T>& value) {
    if (!value.empty()) (*this)(key, value);
  }
  void any_value(std::string_view key, const ActionParameter& parameter) {
    begin(key);
    if (parameter.is_string) return write(parameter.value);
    json_ += parameter.value;
  }

  template <class T>
  void object(const T& value) {
    json_ += '{';
    is_first_ = true;
    list_fields(*this, value);
    json_ += '}';
    is_first_ = false;
  }

 private:
  void begin(std::string_view key) {
    if (!is_first_) json_ += ',';
    is_first_ = false;
    write(key);
    json_ += ':';
  }

  void write(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    json_ += '"';
    for (const char c : text) {
      const auto code = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\') json_ += '\\';
      if (code >= 0x20) {
        json_ += c;
      } else {
        json_ += "\\u00";
        json_ += kHex[code >> 4];
        json_ += kHex[code & 15];
      }
    }
    json_ += '"';
  }
  void write(const std::string& text) { write(std::string_view(text)); }
  void write(bool value) { json_ += value ? "true" : "false"; }
  void write(double value) {
    write_number(value);
    if (value == 0.0 && std::signbit(value)) json_ += ".0";  // or readers take it for the whole number 0
  }
  void write(std::uint32_t value) { write_number(value); }
  template <Enumeration E>
  void write(E value) {
    write(listed_word(value));
  }
  template <class T>
  void write(const std::vector<T>& values) {
    json_ += '[';
    bool is_first = true;
    for (const T& value : values) {
      if (!is_first) json_ += ',';
      is_first = false;
      write(value);
    }
    json_ += ']';
  }
  template <class T>
  requires std::is_class_v<T>
  void write(const T& value) { object(value); }

  // The shortest digits that read back with the same bits.
  template <class T>
  void write_number(T value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    json_.append(digits.data(), end);
  }

  std::string& json_;
  const Version& version_;
  bool is_first_ = true;
};

template <class Document>
std::string written(const Document& document, const Version& version) {
  std::string json;
  FieldWriter(json, version).object(document);
  return json;
}

}  // namespace

std::string_view word_of(ConnectionState state) { return listed_word(state); }

std::string write_document(const Order& document, const Version& version) { return written(document, version); }
std::string write_document(const InstantActions& document, const Version& version) {
  return written(document, version);
}
std::string write_document(const State& document, const Version& version) { return written(document, version); }
std::string write_document(const Connection& document, const Version& version) { return written(document, version); }
std::string write_document(const Factsheet& document, const Version& version) { return written(document, version); }

}  // namespace fleetproof::bridges::vda5050
