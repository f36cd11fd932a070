#include "campaign/cli/waived.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <compare>
#include <limits>
#include <utility>

#include "campaign/plan/default_gates.hpp"
#include "campaign/plan/plan_fields.hpp"
#include "campaign/plan/plan_text.hpp"
#include "core/base/error.hpp"
#include "core/outcome/probe_names.hpp"

namespace fleetproof::cli {
namespace {

// What a plan says of one field: a number to compare, or a word.
struct Amount {
  double number = 0.0;
  std::string word, text;  // text: as a file gives it
};

struct Stated {
  std::string path;
  Lenient lenient;
  std::vector<Amount> amounts;  // of a field of a list of tables, one for each of them; of factors, each value
};

// Of a list of tables without one.
enum class EmptyLists : bool { SayNothing, SayDefaults };

// All fields of a plan with what it says of them, in the order of campaign files.
class StatedFields {
 public:
  StatedFields(const CampaignPlan& plan, EmptyLists empty) : plan_(plan), empty_(empty) { walk("", plan); }
  const std::vector<Stated>& all() const { return all_; }

 private:
  template <HasFields Setup>
  void walk(const std::string& prefix, const Setup& setup) {
    visit_fields(setup, [&](const Field& field, const auto& value) {
      if (field.home == FieldHome::Both) state(prefix, field, value);
    });
  }

  template <class Value>
  void state(const std::string& prefix, const Field& field, const Value& value) {
    const std::string path = prefix + std::string(field.key);
    if constexpr (HasFields<Value>) {
      walk(path + ".", value);
    } else {
      amounts(path, field, value);
    }
  }

  template <class Item>
  void amounts(const std::string& path, const Field& field, const std::vector<Item>& items) {
    if constexpr (HasFields<Item>) {
      for (const Item& item : items) walk(path + ".", item);
      if (items.empty() && empty_ == EmptyLists::SayDefaults) walk(path + ".", Item{});
    } else if constexpr (PlainValue<Item> && !std::is_same_v<Item, std::string>) {
      for (const Item& item : items) add(path, field, amount_of(field, item));
    } else if constexpr (std::is_same_v<Item, FactorSpan>) {
      for (const FactorSpan& span : items) {
        add(path, field, amount_of(field, span.from));
        if (span.is_drawn()) add(path, field, amount_of(field, span.to));
      }
    } else if constexpr (std::is_same_v<Item, std::string>) {
      add(path, field, {static_cast<double>(items.size()), "", fmt::format("[{}]", fmt::join(items, ", "))});
    } else {
      add(path, field, count_of(items.size(), "given"));
    }
  }
  // A gate is easy on a parked fleet if none of its agent's gates has a floor.
  void amounts(const std::string& path, const Field&, const std::vector<GateRecord>& gates) {
    for (GateRecord gate : gates) {
      for (const GateRecord& other : gates) {
        if (other.agent == gate.agent)
          gate.min_transports_per_agv_hour =
              std::max(gate.min_transports_per_agv_hour, other.min_transports_per_agv_hour);
      }
      walk(path + ".", gate);
    }
  }
  // A list that is left out asks for what the kind of campaign asks for. Whatever else one asks for, nobody has to be
  // met without an encounter.
  void amounts(const std::string& path, const Field& field, const std::optional<std::vector<std::string>>&) {
    const std::vector<std::string> probes = plan_.probes_to_meet();
    const bool asks_for_others = std::ranges::find(probes, kEncounterProbe) != probes.end();
    add(path, field,
        {asks_for_others ? static_cast<double>(probes.size()) : 0.0, "", fmt::format("[{}]", fmt::join(probes, ", "))});
  }
  template <class Value>
  void amounts(const std::string& path, const Field& field, const Value& value) {
    if constexpr (PlainValue<Value>) {
      add(path, field, amount_of(field, value));
    } else if constexpr (requires { value == nullptr; }) {
      add(path, field, count_of(value == nullptr ? 0 : 1, "given"));
    }
  }

  template <PlainValue Value>
  static Amount amount_of(const Field& field, const Value& value) {
    const std::string_view unit = unit_of(field.key);
    const std::string ending = unit.empty() ? "" : " " + std::string(unit);
    if constexpr (HasWords<Value>) {
      return {0.0, name_of(value), name_of(value)};
    } else if constexpr (std::is_same_v<Value, std::string>) {
      return {0.0, value, value};
    } else if constexpr (std::is_same_v<Value, Duration>) {
      return {to_seconds(value), "", fmt::format("{}{}", to_seconds(value), ending)};
    } else if constexpr (std::is_same_v<Value, bool>) {
      return {value ? 1.0 : 0.0, "", value ? "true" : "false"};
    } else {
      return {static_cast<double>(value), "", fmt::format("{}{}", static_cast<double>(value), ending)};
    }
  }
  static Amount count_of(std::size_t count, std::string_view text) {
    return {static_cast<double>(count), "", count == 0 ? "" : std::string(text)};
  }

  void add(const std::string& path, const Field& field, Amount amount) {
    if (field.lenient.way() == Lenient::Way::None) return;
    const auto known = std::ranges::find(all_, path, &Stated::path);
    Stated& stated = known != all_.end() ? *known : all_.emplace_back(Stated{path, field.lenient, {}});
    stated.amounts.push_back(std::move(amount));
  }

  const CampaignPlan& plan_;
  EmptyLists empty_;
  std::vector<Stated> all_;
};

// What has nothing to compare with: of plans with gates, one with the gate that says nothing.
CampaignPlan usual_plan(const CampaignPlan& plan) {
  CampaignPlan usual;
  usual.kind = plan.kind;
  usual.gates.emplace_back();
  return usual;
}

bool is_easier(const Lenient& lenient, const Amount& amount, const Amount& usual) {
  return amount.word.empty() ? lenient.names(amount.number, usual.number) : lenient.names(amount.word, usual.word);
}

// How far an easier value is from where it begins to be named, as a factor. What is no number is far.
double distance(const Lenient& lenient, const Amount& amount, const Amount& usual) {
  const double bound = lenient.bound(usual.number);
  const bool is_scaled = amount.word.empty() && lenient.way() != Lenient::Way::Either && bound > 0.0;
  if (!is_scaled || amount.number <= 0.0) return std::numeric_limits<double>::infinity();
  return std::max(amount.number / bound, bound / amount.number);
}

// What is close to its bound comes after all else, so that many small steps hide no large one.
struct Heaviness {
  bool is_far = false;
  Weight weight = Weight::Load;
  double distance = 0.0;
  friend auto operator<=>(const Heaviness&, const Heaviness&) = default;
};
constexpr double kFar = 1.25;

// A field of gates that nobody wrote is no field of the campaign file.
std::string told_field(const CampaignPlan& plan, const std::string& path) {
  return path.starts_with("gate.") && has_default_gates(plan)
             ? path + " of the default gates (not written in the campaign)"
             : path;
}

}  // namespace

std::vector<LenientCondition> waived_conditions(const CampaignPlan& plan) {
  const CampaignPlan usual_one = usual_plan(plan);
  const StatedFields stated(plan, EmptyLists::SayNothing), usual(usual_one, EmptyLists::SayDefaults);
  std::vector<std::pair<Heaviness, LenientCondition>> found;
  for (const Stated& field : stated.all()) {
    const auto other = std::ranges::find(usual.all(), field.path, &Stated::path);
    const Amount normal = other == usual.all().end() ? Amount{} : other->amounts.front();
    std::vector<std::string> easier;
    double farthest = 0.0;
    for (const Amount& amount : field.amounts) {
      if (!is_easier(field.lenient, amount, normal)) continue;
      farthest = std::max(farthest, distance(field.lenient, amount, normal));
      if (std::ranges::find(easier, amount.text) == easier.end()) easier.push_back(amount.text);
    }
    if (!easier.empty())
      found.push_back({{farthest >= kFar, field.lenient.weight(), farthest},
                       {told_field(plan, field.path), fmt::format("{}", fmt::join(easier, ", ")), normal.text}});
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &std::pair<Heaviness, LenientCondition>::first);
  std::vector<LenientCondition> list;
  for (auto& [heaviness, condition] : found) list.push_back(std::move(condition));
  return list;
}

LenientConditions lenient_conditions(const std::string& plan_json) {
  try {
    const CampaignPlan plan = parse_plan(plan_json, PlanCells::MayBeNone);
    return {waived_conditions(plan), has_default_gates(plan) ? default_floor_text(plan) : "", ""};
  } catch (const EngineError& error) {
    return {{}, "", error.what()};
  }
}

}  // namespace fleetproof::cli
