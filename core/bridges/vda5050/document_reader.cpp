#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bridges/vda5050/document_fields.hpp"

namespace fleetproof::bridges::vda5050 {
namespace {

using Json = nlohmann::json;

// Where a value stands in a document: "nodes[2].actions[0].actionId".
struct Place {
  const Place* outer = nullptr;
  std::string_view key;
  std::size_t index = 0;  // if there is no key

  std::string text() const {
    if (outer == nullptr) return {};
    const std::string before = outer->text();
    if (key.empty()) return before + '[' + std::to_string(index) + ']';
    return before.empty() ? std::string(key) : before + '.' + std::string(key);
  }
};

std::string printable(std::string_view text) {
  constexpr std::size_t kMost = 200;
  std::string shown(text.substr(0, kMost));
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

// Walks over the text before a tree is made of it: no key twice in an object, and no deep nesting.
class TextCheck : public nlohmann::json_sax<Json> {
 public:
  std::string why;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return go_deeper(); }
  bool start_array(std::size_t) override { return go_deeper(); }
  bool end_object() override { return go_back(); }
  bool end_array() override { return go_back(); }
  bool key(string_t& key) override {
    return keys_.back().insert(key).second ||
           refuse("the key \"" + key.substr(0, 40) + "\" stands twice in one object");
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    const std::string_view text = error.what();  // "[json.exception.parse_error.101] parse error at ..."
    return refuse("this is no JSON: " + std::string(text.substr(std::min(text.size(), text.find(']') + 2))));
  }

 private:
  bool go_deeper() {
    keys_.emplace_back();
    return keys_.size() <= kMostNesting || refuse("more than 32 objects and arrays within each other");
  }
  bool go_back() {
    keys_.pop_back();
    return true;
  }
  bool refuse(const std::string& reason) {
    why = printable(reason);
    return false;
  }

  std::vector<std::set<std::string>> keys_;
};

bool all_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// "+01:00"
bool is_zone(std::string_view text) {
  return text == "Z" || (text.size() == 6 && (text[0] == '+' || text[0] == '-') && all_digits(text.substr(1, 2)) &&
                         text[3] == ':' && all_digits(text.substr(4)));
}

// A date-time of RFC 3339, with any number of digits behind the second.
bool is_instant(std::string_view text) {
  constexpr std::string_view kShape = "dddd-dd-ddTdd:dd:dd";
  if (text.size() <= kShape.size()) return false;
  for (std::size_t i = 0; i < kShape.size(); ++i) {
    if (kShape[i] == 'd' ? !all_digits(text.substr(i, 1)) : text[i] != kShape[i]) return false;
  }
  std::string_view rest = text.substr(kShape.size());
  if (rest[0] == '.') {
    const std::size_t end = std::min(rest.find_first_not_of("0123456789", 1), rest.size());
    if (end == 1) return false;
    rest.remove_prefix(end);
  }
  return is_zone(rest);
}

// Reads the fields of one object; keeps the first reason why one cannot be read, and reads no more then.
class FieldReader {
 public:
  FieldReader(const Json& object, const Place& place, const Version& version, std::string& why)
      : object_(object), place_(place), version_(version), why_(why) {}

  template <class T>
  void operator()(std::string_view key, T& to) {
    if (const Json* found = required(key)) read(*found, at(key), to);
  }
  template <class T>
  void operator()(std::string_view key, std::optional<T>& to) {
    if (const Json* found = present(key)) read(*found, at(key), to.emplace());
  }
  void instant(std::string_view key, std::string& to) {
    (*this)(key, to);
    if (why_.empty() && !is_instant(to)) refuse(at(key), "must be an instant of ISO 8601 in UTC");
  }
  template <class T>
  void within(std::string_view key, T& to, double least, double most) {
    (*this)(key, to);
    if (why_.empty() && !is_within(to, least, most)) refuse(at(key), "is out of its range");
  }
  template <class T>
  void varying(std::string_view field, T& to) {
    if (version_.has(field)) (*this)(field.substr(field.find('.') + 1), to);
  }
  template <class T>
  void may_be_missing(std::string_view key, std::vector<T>& to) {
    if (const Json* found = present(key)) read(*found, at(key), to);
  }
  void any_value(std::string_view key, ActionParameter& to) {
    const Json* found = required(key);
    if (found == nullptr) return;
    if (found->is_null()) return refuse(at(key), "must not be null");
    to.is_string = found->is_string();
    to.value = to.is_string ? found->get_ref<const std::string&>() : found->dump();
  }

 private:
  Place at(std::string_view key) const { return {&place_, key}; }

  void refuse(const Place& place, std::string_view what) {
    if (why_.empty()) why_ = printable(place.text() + ' ' + std::string(what));
  }

  const Json* present(std::string_view key) const {
    if (!why_.empty()) return nullptr;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  const Json* required(std::string_view key) {
    const Json* found = present(key);
    if (found == nullptr) refuse(at(key), "is missing");
    return found;
  }

  static bool is_within(double value, double least, double most) { return value >= least && value <= most; }
  static bool is_within(const std::optional<double>& value, double least, double most) {
    return !value || is_within(*value, least, most);
  }
  static bool is_within(const std::vector<double>& values, double least, double most) {
    return std::ranges::all_of(values, [&](double value) { return is_within(value, least, most); });
  }

  void read(const Json& json, const Place& place, std::string& to) {
    if (!json.is_string()) return refuse(place, "must be a string");
    to = json.get_ref<const std::string&>();
  }
  void read(const Json& json, const Place& place, bool& to) {
    if (!json.is_boolean()) return refuse(place, "must be true or false");
    to = json.get<bool>();
  }
  void read(const Json& json, const Place& place, double& to) {
    if (!json.is_number()) return refuse(place, "must be a number");
    to = json.get<double>();
  }
  // 3.0 is the same number as 3.
  void read(const Json& json, const Place& place, std::uint32_t& to) {
    const double number = json.is_number() ? json.get<double>() : -1.0;
    if (number < 0.0 || number > 4294967295.0 || std::floor(number) != number)
      return refuse(place, "must be a whole number from 0 to 4294967295");
    to = static_cast<std::uint32_t>(number);
  }
  template <class E>
  requires std::is_enum_v<E>
  void read(const Json& json, const Place& place, E& to) {
    const auto& words = kWordsOf<E>;
    const auto found = json.is_string() ? std::ranges::find(words, json.get_ref<const std::string&>()) : words.end();
    if (found != words.end()) {
      to = static_cast<E>(found - words.begin());
      return;
    }
    std::string must = "must be";
    for (const char* word : words) must.append(word == words.front() ? " \"" : " or \"").append(word).append("\"");
    refuse(place, must);
  }
  template <class T>
  void read(const Json& json, const Place& place, std::vector<T>& to) {
    if (!json.is_array()) return refuse(place, "must be an array");
    to.clear();
    to.reserve(json.size());
    for (std::size_t i = 0; i < json.size() && why_.empty(); ++i)
      read(json[i], Place{&place, {}, i}, to.emplace_back());
  }
  template <class T>
  requires std::is_class_v<T>
  void read(const Json& json, const Place& place, T& to) {
    if (!json.is_object()) return refuse(place, "must be an object");
    FieldReader fields(json, place, version_, why_);
    list_fields(fields, to);
  }

  const Json& object_;
  const Place& place_;
  const Version& version_;
  std::string& why_;
};

template <class Document>
bool read_whole(std::string_view bytes, const Version& version, Document& to, std::string& why) {
  to = {};
  why.clear();
  TextCheck check;
  if (bytes.size() > kMostDocumentBytes) {
    why = "the message has more than " + std::to_string(kMostDocumentBytes) + " bytes";
  } else if (!Json::sax_parse(bytes, &check)) {
    why = check.why;
  } else if (const Json json = Json::parse(bytes, nullptr, false); !json.is_object()) {
    why = "the message must be an object";
  } else {
    const Place whole;
    FieldReader fields(json, whole, version, why);
    list_fields(fields, to);
  }
  return why.empty();
}

}  // namespace

const ActionParameter* Action::parameter(std::string_view key) const {
  if (!action_parameters) return nullptr;
  const auto found = std::ranges::find(*action_parameters, key, &ActionParameter::key);
  return found == action_parameters->end() ? nullptr : &*found;
}

bool read_document(std::string_view bytes, const Version& version, Order& to, std::string& why) {
  return read_whole(bytes, version, to, why);
}
bool read_document(std::string_view bytes, const Version& version, InstantActions& to, std::string& why) {
  return read_whole(bytes, version, to, why);
}
bool read_document(std::string_view bytes, const Version& version, State& to, std::string& why) {
  return read_whole(bytes, version, to, why);
}
bool read_document(std::string_view bytes, const Version& version, Connection& to, std::string& why) {
  return read_whole(bytes, version, to, why);
}
bool read_document(std::string_view bytes, const Version& version, Factsheet& to, std::string& why) {
  return read_whole(bytes, version, to, why);
}

}  // namespace fleetproof::bridges::vda5050
