#include "campaign/plan/field_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/plan/plan_fields.hpp"
#include "generators/formats/purpose_words.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kExpected = "expected ";

std::string without_expected(std::string sentence) {
  return sentence.starts_with(kExpected) ? sentence.substr(kExpected.size()) : sentence;
}

template <class Value>
inline constexpr bool kIsList = false;
template <class Item>
inline constexpr bool kIsList<std::vector<Item>> = true;

// Walks the lists of fields of default setups.
class RowWriter {
 public:
  RowWriter(std::string file, std::vector<FieldRow>& rows) : file_(std::move(file)), rows_(rows) {}

  template <HasFields Setup>
  void fields(const std::string& prefix, const Setup& setup) {
    visit_fields(setup, [&](const Field& field, const auto& value) {
      const bool here = file_ == "scenario" || field.home == FieldHome::Both;
      if (here) walk(prefix + key_of(field), field, value);
    });
  }

 private:
  // Campaign files have flat keys where scenario files have groups.
  std::string key_of(const Field& field) const {
    if (file_ != "scenario") return std::string(field.key);
    std::string key(field.scenario_place());
    if (const auto slash = key.find('/'); slash != std::string::npos) key[slash] = '.';
    return key;
  }

  template <class Value>
  void walk(const std::string& key, const Field& field, const Value& value) {
    if constexpr (HasFields<Value>) {
      add(key, field, "", "a table");
      fields(key + ".", value);
    } else if constexpr (kIsList<Value>) {
      list(key, field, value);
    } else {
      add(key, field, fallback_of(value), expected_of(field, value));
    }
  }

  template <class Item>
  void list(const std::string& key, const Field& field, const std::vector<Item>& items) {
    if constexpr (HasFields<Item>) {
      add(key, field, "", "a list of tables");
      fields(key + "[].", Item{});
    } else {
      std::vector<std::string> texts;
      for (const Item& item : items) texts.push_back(fallback_of(item));
      add(key, field, texts.empty() ? "" : fmt::format("[{}]", fmt::join(texts, ", ")),
          "a list: " + expected_of(field, Item{}));
    }
  }

  void add(const std::string& key, const Field& field, std::string fallback, std::string expected) {
    if (field.needed) fallback.clear();
    rows_.push_back({file_, key, std::move(fallback), std::move(expected), std::string(unit_of(field.key)),
                     field.lenient.text(), std::string(field.text)});
  }

  template <class Value>
  static std::string fallback_of(const Value& value) {
    if constexpr (std::is_same_v<Value, Stream>) {
      return name_of(value);
    } else if constexpr (HasWords<Value>) {
      return fmt::format("\"{}\"", name_of(value));
    } else if constexpr (std::is_same_v<Value, std::string>) {
      return value.empty() ? "" : fmt::format("\"{}\"", value);
    } else if constexpr (std::is_same_v<Value, Duration>) {
      return value == kLongestDuration ? "" : fmt::format("{}", static_cast<double>(value.count()) / 1e9);
    } else if constexpr (std::is_same_v<Value, FactorSpan>) {
      return fmt::format("{}", value.from);
    } else if constexpr (NumberValue<Value> || std::is_same_v<Value, bool>) {
      return fmt::format("{}", value);
    } else {
      return "";
    }
  }

  template <class Value>
  static std::string expected_of(const Field& field, const Value& value) {
    if constexpr (std::is_same_v<Value, Stream>) {
      return "names of streams";
    } else if constexpr (HasWords<Value>) {
      return without_expected(expected_word({}, kWordsOf<Value>));
    } else if constexpr (std::is_same_v<Value, std::uint32_t> || std::is_same_v<Value, std::uint64_t>) {
      return without_expected(expected_whole(field));
    } else if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, Duration>) {
      return without_expected(expected_number(field));
    } else if constexpr (std::is_same_v<Value, FactorSpan>) {
      return without_expected(expected_number(field)) + "; or bounds { from = ..., to = ... }";
    } else if constexpr (std::is_same_v<Value, bool>) {
      return "true or false";
    } else if constexpr (std::is_same_v<Value, std::string>) {
      return "a text";
    } else if constexpr (OptionalPlain<Value>) {
      return expected_of(field, typename Value::value_type{});
    } else {
      return special(value);
    }
  }
  static std::string special(const Vec2&) { return "[x, y] in metres"; }
  static std::string special(const std::optional<Vec2>&) { return special(Vec2()); }
  template <class Vector>
  static std::string special(const Direction<Vector>&) {
    return "[x, y], of any length but 0";
  }
  template <class Index>
  static std::string special(const TypeIndex<Index>&) {
    return "a name";
  }
  template <class Tag>
  static std::string special(const StrongId<Tag>&) {
    return "a name";
  }
  static std::string special(const std::optional<std::vector<std::string>>&) { return "a list of texts"; }
  static std::string special(const StreamSeed&) { return "seeds by names of streams"; }
  static std::string special(Purposes) { return "a list: " + without_expected(expected_word({}, kPurposeNames)); }
  static std::string special(const ExemptPair&) { return "[name, name]"; }
  static std::string special(const AgentFactor&) { return "a name, a file or a table"; }
  static std::string special(const LayoutFactor&) { return "a family, a file or a table"; }
  template <class Shared>
  static std::string special(const std::shared_ptr<const Shared>&) {
    if (std::is_same_v<Shared, LogicalMap>) return "a table";
    return std::is_same_v<Shared, RadioTrace> ? "a recording or the name of a file" : "the name of a file";
  }

  std::string file_;
  std::vector<FieldRow>& rows_;
};

}  // namespace

std::vector<FieldRow> field_rows() {
  std::vector<FieldRow> rows;
  RowWriter("campaign", rows).fields("", CampaignPlan{});
  RowWriter("scenario", rows).fields("", Scenario{});
  return rows;
}

}  // namespace fleetproof
