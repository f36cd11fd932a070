#include <fmt/format.h>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/plan/field_rows.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/families/mutated_import.hpp"
#include "generators/formats/importer.hpp"
#include "laws/laws.hpp"
#include "reports/formats/report_formats.hpp"
#include "reports/formats/report_schema.hpp"

namespace fleetproof::cli {
namespace {

struct Row {
  std::string name, description;
};

template <class Entries>
std::vector<Row> rows_of(const Entries& entries) {
  std::vector<Row> rows;
  for (const auto& entry : entries) rows.push_back({std::string(entry.name), std::string(entry.description)});
  return rows;
}

std::vector<Row> agent_rows() {
  const AgentPrograms programs;
  std::vector<Row> rows;
  for (const AgentProgram& agent : programs.all()) rows.push_back({agent.name, agent.description});
  return rows;
}

std::vector<Row> generator_rows() {
  auto rows = rows_of(layout_families());
  rows.push_back({std::string(kMutatedImport),
                  "a layout file of yours with segments left out or turned round, stations moved and all of it scaled; "
                  "see generate --from"});
  return rows;
}

struct Listed {
  std::string_view name;
  std::vector<Row> (*rows)();
};

constexpr std::array kinds = {
    Listed{"agents", agent_rows},
    Listed{"laws", [] { return rows_of(laws()); }},
    Listed{"generators", generator_rows},
    Listed{"importers", [] { return rows_of(importers()); }},
    Listed{"reports", [] { return rows_of(report_formats()); }},
};

// Every key of campaign files and scenario files.
int list_fields(bool json) {
  std::string text;
  Json all = Json::array();
  for (const FieldRow& row : field_rows()) {
    if (json) {
      all.push_back({{"name", row.key},
                     {"file", row.file},
                     {"default", row.fallback},
                     {"expected", row.expected},
                     {"unit", row.unit},
                     {"named_at_head", row.named},
                     {"description", row.text}});
    } else {
      text += fmt::format("{} {}{}: {}\n    {}\n", row.file, row.key, row.fallback.empty() ? "" : " = " + row.fallback,
                          row.expected, row.text);
    }
  }
  if (json) text = json_text({{"schema_version", 1}, {"fields", all}}, 2) + "\n";
  put_text(text);
  return kDemonstrated;
}

int list(const std::string& what, bool json) {
  constexpr std::string_view kFields = "fields", kSchema = "report-schema";
  if (what == kFields) return list_fields(json);
  if (what == kSchema) {
    put_text(std::string(report_schema()));
    return kDemonstrated;
  }
  std::vector<std::string_view> names{kFields, kSchema};
  for (const Listed& kind : kinds) {
    names.push_back(kind.name);
    if (kind.name != what) continue;
    std::string text;
    Json all = Json::array();
    for (const Row& row : kind.rows()) {
      if (json) {
        all.push_back({{"name", row.name}, {"description", row.description}});
      } else {
        text += fmt::format("{:<18} {}\n", row.name, row.description);
      }
    }
    if (json) text = json_text({{"schema_version", 1}, {what, all}}, 2) + "\n";
    put_text(text);
    return kDemonstrated;
  }
  throw InputError("list", fmt::format("\"{}\" is not a catalogue{}", what, name_hint(what, names)));
}

}  // namespace

Action prepare_list(Options& options) {
  struct Words {
    std::string what;
    bool json = false;
  };
  auto words = std::make_shared<Words>();
  options.positional("WHAT", words->what, "agents, laws, generators, importers, reports, fields or report-schema");
  options.flag("--json", words->json, "print JSON");
  return [words] { return list(words->what, words->json); };
}

}  // namespace fleetproof::cli
