#include "campaign/plan/campaign_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "campaign/plan/campaign_agents.hpp"
#include "campaign/plan/campaign_layouts.hpp"
#include "campaign/plan/plan_fields.hpp"
#include "campaign/plan/toml_table.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "generators/scenario_file/radio_trace.hpp"

namespace fleetproof {
namespace {

constexpr const char* kOnlyComputer = "server";

// An agent that names no computer has a program for the only one. A campaign that lists none has those that its agents
// name.
void name_computers(CampaignPlan& plan, const PlanPlaces& places) {
  const bool are_listed = !plan.computers.empty();
  for (std::size_t i = 0; i < plan.agents.size(); ++i) {
    for (ComputerPart& part : plan.agents[i].computers) {
      if (part.computer.empty() && plan.computers.size() > 1)
        throw InputError(places.of(fmt::format("factors.agents.{}", i)),
                         fmt::format("factors.agents: computer = ... is for a campaign with one computer, and this one "
                                     "has {}; name it: computers = {{ {} = ... }}",
                                     plan.computers.size(), plan.computers[0].setup.name));
      if (part.computer.empty())
        part.computer = plan.computers.size() == 1 ? plan.computers[0].setup.name : kOnlyComputer;
      const bool is_known =
          std::ranges::any_of(plan.computers, [&](const auto& one) { return one.setup.name == part.computer; });
      if (!is_known && !are_listed) plan.computers.push_back({{.name = part.computer}, {}});
    }
  }
}

// A region speaks of loss and delay. A gate that names them itself is not cut by a region that nobody wrote.
bool names_radio(const CellFilter& filter) {
  return filter.factors[Factor::Loss].has_value() || filter.factors[Factor::Delay].has_value();
}

void warn_of_idle_computers(CampaignFile& file) {
  for (const auto& [computer, faults] : file.plan.computers) {
    const bool is_used = std::ranges::any_of(
        file.plan.agents, [&](const AgentFactor& agent) { return agent.part_on(computer.name) != nullptr; });
    if (!is_used)
      file.warnings.push_back(fmt::format("{}: no agent has a program for the computer {}, so that no world has it",
                                          file.places.of("computers"), in_quotes(computer.name)));
  }
}

// Reads a plan by its list of fields. Bounds are checked here, at the place of the value. check_plan() checks the rules
// between fields.
class CampaignReader {
 public:
  CampaignReader(const std::string& path, CampaignFile& file) : path_(path), file_(file) {}

  void read(TomlTable& root) {
    purposes_ = read_purposes(root);
    fields(root, file_.plan);
    root.finish();
    refuse_unheard(purposes_);
    std::ranges::sort(file_.plan.held_streams);
    name_computers(file_.plan, file_.places);
    warn_of_idle_computers(file_);
  }

 private:
  template <HasFields Setup>
  void fields(TomlTable& table, Setup& setup) {
    visit_fields(setup, [&](const Field& field, auto&& target) {
      if (field.home == FieldHome::Both) member(table, field, target);
    });
  }

  static void take_given(const Field& field, const TomlTable::Given& given, auto& target) {
    if (const auto sentence = take(field, given.value, target); !sentence.empty()) given.refuse(sentence);
  }
  static bool is_fresh(const GivenValue& value) {
    const auto* word = std::get_if<std::string>(&value);
    return word != nullptr && *word == "fresh";
  }
  static std::string word_of(const TomlTable::Given& given) {
    std::string word;
    take_given({.key = "", .text = "", .lenient = kDecidesNothing}, given, word);
    return word;
  }

  template <PlainValue Plain>
  void member(TomlTable& table, const Field& field, Plain& target) {
    const auto given = table.given(field.key);
    if (!given) return;
    if (field.is_seed && is_fresh(given->value)) {
      file_.fresh_seed = true;
    } else {
      take_given(field, *given, target);
    }
  }

  // A table that can be switched on is on if the file contains it, unless `on = false` stands in it.
  template <HasFields Setup>
  void member(TomlTable& root, const Field& field, Setup& target) {
    auto table = root.table(field.key);
    if (!table && field.needed)
      throw InputError(path_, fmt::format("has no [{}] table; it holds {}", field.key, field.text));
    if (!table) return;
    if constexpr (requires { target.on; }) target.on = true;
    fields(*table, target);
    table->finish();
  }

  // One [vehicle], or several [[vehicle]] with their shares of the fleet.
  void member(TomlTable& root, const Field& field, std::vector<VehicleShare>& vehicles) {
    if (root.is_table(field.key)) {
      vehicles.assign(1, VehicleShare{});
      return member(root, field, vehicles.front());
    }
    auto tables = root.tables(field.key);
    if (tables.empty() && root.has(field.key))
      throw InputError(root.place(field.key), "vehicle is empty; give a [[vehicle]], or remove the key");
    if (tables.empty()) return;
    vehicles.clear();
    for (TomlTable& table : tables) {
      fields(table, vehicles.emplace_back());
      table.finish();
    }
  }

  template <HasFields Item>
  void member(TomlTable& root, const Field& field, std::vector<Item>& items) {
    for (TomlTable& table : root.tables(field.key)) {
      fields(table, items.emplace_back());
      table.finish();
    }
  }
  void member(TomlTable& table, const Field& field, std::optional<Vec2>& place_m) {
    const auto numbers = table.array(field.key);
    if (!numbers) return;
    if (numbers->size() != 2) throw InputError(table.place(field.key), "a place is [x, y] in metres");
    place_m.emplace();
    for (const Eigen::Index i : {0, 1}) take_given(field, (*numbers)[static_cast<std::size_t>(i)], (*place_m)[i]);
  }

  void member(TomlTable& root, const Field& field, std::vector<GateRecord>& gates) {
    for (TomlTable& table : root.tables(field.key)) {
      GateRecord& gate = gates.emplace_back();
      gate.index = static_cast<std::uint32_t>(gates.size() - 1);
      gate.name = fmt::format("gate {}", gates.size());
      fields(table, gate);
      if (gate.agent.empty())
        throw InputError(table.place("agent"),
                         fmt::format("gate \"{}\" names no agent; add agent = \"...\"", gate.name));
      if (names_radio(gate.where) && !table.has("region")) gate.region = Region::All;
      table.finish();
    }
  }
  template <OptionalPlain Maybe>
  void member(TomlTable& table, const Field& field, Maybe& target) {
    const auto given = table.given(field.key);
    if (given) take_given(field, *given, target.emplace());
  }

  void member(TomlTable& table, const Field& field, std::vector<std::string>& words) {
    const auto items = table.array(field.key);
    if (!items) return;
    words.clear();
    for (const auto& item : *items) words.push_back(word_of(item));
  }
  void member(TomlTable& table, const Field& field, std::optional<std::vector<std::string>>& words) {
    std::vector<std::string> given = file_.plan.probes_to_meet();
    member(table, field, given);
    words = std::move(given);
  }
  void member(TomlTable& table, const Field& field, std::vector<std::uint32_t>& numbers) {
    const auto items = table.array(field.key);
    if (!items) return;
    numbers.clear();
    for (const auto& item : *items) take_given(field, item, numbers.emplace_back());
  }

  // An array of values, or { from = 0.0, to = 0.4 }.
  void member(TomlTable& table, const Field& field, std::vector<FactorSpan>& factor) {
    if (table.is_table(field.key)) return bounds(table, field, factor);
    const auto items = table.array(field.key);
    if (!items) return;
    if (items->empty())
      throw InputError(table.place(field.key), fmt::format("factors.{} is empty; it needs at least one value, or is "
                                                           "left out",
                                                           field.key));
    factor.clear();
    for (const auto& item : *items) {
      double value = 0.0;
      take_given(field, item, value);
      factor.emplace_back(value);
    }
  }
  void bounds(TomlTable& table, const Field& field, std::vector<FactorSpan>& factor) {
    auto ends = table.table(field.key);
    FactorSpan span;
    for (const auto& [key, end] : {std::pair{"from", &span.from}, {"to", &span.to}}) {
      if (const auto given = ends->given(key)) take_given(field, *given, *end);
    }
    ends->finish();
    if (!ends->has("from") || !ends->has("to") || !(span.from < span.to)) {
      throw InputError(table.place(field.key),
                       fmt::format("factors.{} needs bounds with from below to, as in {{ from = 0.0, to = 0.4 }}; "
                                   "single values stand in an array",
                                   field.key));
    }
    factor = {span};
  }

  void member(TomlTable& table, const Field& field, std::vector<Stream>& streams) {
    std::vector<std::string_view> known;
    for (const Stream stream : kRunStreams) known.emplace_back(name_of(stream));
    const auto items = table.array(field.key);
    if (!items) return;
    for (const auto& item : *items) {
      const auto stream = stream_of_name(word_of(item));
      if (!stream) item.refuse(expected_word(item.value, known));
      streams.push_back(*stream);
    }
  }
  void member(TomlTable& table, const Field& field, Purposes& purposes) {
    const auto items = table.array(field.key);
    if (!items) return;
    purposes = {};
    for (const auto& item : *items) {
      Purpose purpose{};
      take_given(field, item, purpose);
      purposes = purposes | purpose;
    }
  }
  void member(TomlTable& table, const Field& field, std::vector<ExemptPair>& pairs) {
    for (const auto& [outer, names] : table.arrays(field.key)) {
      if (const auto fault = fault_of_pair_size(names.size()); !fault.empty()) outer.refuse(fault);
      pairs.push_back({word_of(names[0]), word_of(names[1])});
    }
  }

  void member(TomlTable& table, const Field& field, std::vector<AgentFactor>& agents) {
    read_agents(table, field.key, path_, agents, file_.agent_files);
  }
  void member(TomlTable& table, const Field& field, std::vector<LayoutFactor>& layouts) {
    read_layouts(table, field.key, path_, purposes_, layouts, {file_.warnings, file_.notes});
  }
  void member(TomlTable& table, const Field& field, std::shared_ptr<const OrderList>& orders) {
    const auto given = table.given(field.key);
    if (given) orders = std::make_shared<const OrderList>(read_order_list(beside(path_, word_of(*given))));
  }
  void member(TomlTable& table, const Field& field, std::shared_ptr<const RadioTrace>& trace) {
    const auto given = table.given(field.key);
    if (given) trace = std::make_shared<const RadioTrace>(read_radio_trace(beside(path_, word_of(*given))));
  }
  void member(TomlTable&, const Field&, std::vector<RadioSource>&) {}  // drawn: DrawnSources

  std::string path_;
  CampaignFile& file_;
  PurposeWords purposes_;  // of words in layout files
};

CampaignFile read_root(TomlTable root, const std::string& path) {
  CampaignFile file;
  file.plan.name = std::filesystem::path(path).stem().string();
  file.places = {path, root.places()};
  CampaignReader(path, file).read(root);
  return file;
}

}  // namespace

CampaignFile read_campaign_file(const std::string& path) { return read_root(TomlTable::read(path), path); }

CampaignFile parse_campaign_file(std::string_view text, const std::string& path) {
  return read_root(TomlTable::parse(text, path), path);
}

}  // namespace fleetproof
