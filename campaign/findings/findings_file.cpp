#include "campaign/findings/findings_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <utility>

#include "campaign/findings/ingredients.hpp"
#include "campaign/plan/plan_fields.hpp"
#include "campaign/plan/toml_table.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/regular_file.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "laws/laws.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kFindings = "finding", kRefuted = "refuted";
const std::string kNoFile = "findings";  // what errors call a text that is not read from a file

// In the quotes of TOML's basic strings.
std::string toml_text(std::string_view text) {
  std::string written = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') written += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      written += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      written += c;
    }
  }
  return written + "\"";
}

std::string list_of(const std::vector<std::string>& texts) {
  std::vector<std::string> items;
  for (const std::string& text : texts) items.push_back(toml_text(text));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

// A day of the calendar, as "2027-01-31".
bool is_day(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  const auto number = [&](std::size_t from, std::size_t digits) {
    unsigned value = 0;
    const char* const end = text.data() + from + digits;
    return std::from_chars(text.data() + from, end, value).ptr == end ? value : 0U;
  };
  using namespace std::chrono;
  return year_month_day(year(static_cast<int>(number(0, 4))), month(number(5, 2)), day(number(8, 2))).ok();
}

std::string needed(TomlTable& table, std::string_view key) {
  std::string value;
  table.get(key, value);
  if (value.empty()) throw InputError(table.place(key), fmt::format("a finding needs \"{}\"", key));
  return value;
}

std::string text_in(const TomlTable::Given& given) {
  const auto* text = std::get_if<std::string>(&given.value);
  if (text == nullptr) given.refuse("expected a text");
  return *text;
}

double number_in(const TomlTable::Given& given) {
  double value = 0.0;
  const auto sentence =
      take(Field{.key = "", .text = "", .lenient = kDecidesNothing, .low = 0.0, .high = kNever_s}, given.value, value);
  if (!sentence.empty()) given.refuse(sentence);
  return value;
}

std::vector<std::string> texts(TomlTable& table, std::string_view key) {
  std::vector<std::string> texts;
  const auto items = table.array(key);
  if (items) std::ranges::transform(*items, std::back_inserter(texts), text_in);
  return texts;
}

std::vector<std::vector<std::string>> lists(TomlTable& table, std::string_view key) {
  std::vector<std::vector<std::string>> lists;
  for (const TomlTable::Row& row : table.arrays(key))
    std::ranges::transform(row.items, std::back_inserter(lists.emplace_back()), text_in);
  return lists;
}

void read_ends(TomlTable& table, std::string_view key, NeighbourCounts& counts) {
  auto ends = table.table(key);
  if (!ends) return;
  for (const std::string& end : ends->keys()) {
    std::uint64_t count = 0;
    ends->get(end, count);
    counts.otherwise[end] = count;
  }
  ends->finish();
}

void read_circumstances(TomlTable& table, std::string_view key, std::vector<Circumstances>& worlds) {
  for (TomlTable& figures : table.tables(key)) {
    Circumstances& circumstances = worlds.emplace_back();
    for (const std::string& figure : figures.keys()) {
      const auto values = figures.array(figure);
      if (!values || values->size() != kCircumstanceValues)
        throw InputError(figures.place(figure), fmt::format("expected {} numbers", kCircumstanceValues));
      std::ranges::transform(*values, std::back_inserter(circumstances[figure]), number_in);
    }
    figures.finish();
  }
}

void read_whole_runs(TomlTable& table, KnownIssue& finding) {
  std::uint64_t of = 0, alike = 0;
  table.get("whole_runs", of);
  table.get("whole_runs_failing", alike);
  if (alike > of) throw InputError(table.place("whole_runs_failing"), "more runs failed than were tried");
  finding.whole.counts.of = of;
  finding.whole.counts.alike = alike;
  finding.whole.counts.said.always = texts(table, "whole_runs_always_said");
  finding.whole.counts.said.usually = texts(table, "whole_runs_usually_said");
  finding.whole.counts.said.ever = texts(table, "whole_runs_ever_said");
  read_ends(table, "whole_runs_otherwise", finding.whole.counts);
  finding.whole.others_need = lists(table, "others_need");
  read_circumstances(table, "whole_runs_circumstances", finding.whole.counts.circumstances);
}

void read_neighbours(TomlTable& table, NeighbourCounts& counts) {
  std::uint64_t of = 0, alike = 0;
  table.get("neighbours", of);
  table.get("neighbours_failing", alike);
  counts.of = of;
  counts.alike = alike;
  std::uint64_t of_world = 0, alike_of_world = 0;
  table.get("world_neighbours", of_world);
  table.get("world_neighbours_failing", alike_of_world);
  counts.of_world = of_world;
  counts.alike_of_world = alike_of_world;
  table.get("neighbours_driven_m", counts.driven_m);
  table.get("driven_elsewhere_m", counts.driven_elsewhere_m);
  counts.said.always = texts(table, "always_said");
  counts.said.usually = texts(table, "usually_said");
  counts.said.ever = texts(table, "ever_said");
  if (counts.alike > counts.of || counts.alike_of_world > counts.of_world)
    throw InputError(table.place("neighbours_failing"), "more neighbours failed than were tried");
  read_ends(table, "neighbours_otherwise", counts);
  read_circumstances(table, "circumstances", counts.circumstances);
}

std::string text_of_ends(std::string_view key, const NeighbourCounts& counts) {
  if (counts.otherwise.empty()) return {};
  std::vector<std::string> ends;
  for (const auto& [end, count] : counts.otherwise) ends.push_back(toml_text(end) + fmt::format(" = {}", count));
  return fmt::format("{} = {{ {} }}\n", key, fmt::join(ends, ", "));
}

std::string text_of_circumstances(std::string_view key, const std::vector<Circumstances>& worlds) {
  std::vector<std::string> tables;
  for (const Circumstances& circumstances : worlds) {
    std::vector<std::string> figures;
    for (const auto& [figure, values] : circumstances)
      figures.push_back(fmt::format("{} = [{}]", toml_text(figure), fmt::join(values, ", ")));
    tables.push_back(fmt::format("  {{ {} }},\n", fmt::join(figures, ", ")));
  }
  return tables.empty() ? std::string() : fmt::format("{} = [\n{}]\n", key, fmt::join(tables, ""));
}

std::string text_of_words(std::string_view prefix, const NeighbourCounts& counts) {
  std::string text;
  const auto put = [&](const char* key, const std::vector<std::string>& words) {
    if (!words.empty()) text += fmt::format("{}{} = {}\n", prefix, key, list_of(words));
  };
  put("always_said", counts.said.always);
  put("usually_said", counts.said.usually);
  put("ever_said", counts.said.ever);
  return text;
}

// What decides how its runs are judged, beside the scenario.
void read_judge(TomlTable& table, KnownIssue& finding) {
  finding.laws_left_out = texts(table, "laws_left_out");
  for (const std::string& name : finding.laws_left_out) {
    if (const std::string why_not = why_not_left_out(name); !why_not.empty())
      throw InputError(table.place("laws_left_out"), "laws_left_out " + why_not);
  }
  visit_fields(finding.limits, [&](const Field& field, auto& value) {
    const auto given = table.given(field.key);
    if (!given) return;
    if (const auto sentence = take(field, given->value, value); !sentence.empty()) given->refuse(sentence);
  });
}

std::string text_of_judge(const KnownIssue& finding) {
  std::string text;
  if (!finding.laws_left_out.empty()) text += fmt::format("laws_left_out = {}\n", list_of(finding.laws_left_out));
  const LimitSetup usual;
  if (finding.limits.memory_mb != usual.memory_mb) text += fmt::format("memory_mb = {}\n", finding.limits.memory_mb);
  if (finding.limits.cpu_s != usual.cpu_s) text += fmt::format("cpu_s = {}\n", finding.limits.cpu_s);
  return text;
}

std::string lists_of(const std::vector<std::vector<std::string>>& lists) {
  std::vector<std::string> items;
  for (const auto& list : lists) items.push_back(list_of(list));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string text_of_whole_runs(const KnownIssue& finding) {
  if (finding.whole.files.empty()) return {};
  std::string text = fmt::format("runs = {}\nwhole_runs = {}\nwhole_runs_failing = {}\n", list_of(finding.whole.files),
                                 finding.whole.counts.of, finding.whole.counts.alike);
  if (!finding.whole.others_need.empty())
    text += fmt::format("others_need = {}\n", lists_of(finding.whole.others_need));
  text += text_of_words("whole_runs_", finding.whole.counts);
  return text + text_of_ends("whole_runs_otherwise", finding.whole.counts) +
         text_of_circumstances("whole_runs_circumstances", finding.whole.counts.circumstances);
}

// Which failure of a run it is, if another one leads.
FailureChoice read_choice(TomlTable& table) {
  FailureChoice choice;
  for (const std::string& word : texts(table, "looked_for")) {
    const auto end_point = value_of<EndPoint>(word);
    if (!end_point || *end_point == EndPoint::Throughput)
      throw InputError(table.place("looked_for"), fmt::format("{} is no failure of a run", in_quotes(word)));
    choice.end_points |= bit_of(*end_point);
  }
  return choice;
}

std::string text_of_choice(FailureChoice choice) {
  std::vector<std::string> words;
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if ((choice.end_points & bit_of(end_point)) != 0) words.emplace_back(name_of(end_point));
  }
  return words.empty() ? std::string() : fmt::format("looked_for = {}\n", list_of(words));
}

KnownIssue read_finding(TomlTable& table) {
  KnownIssue finding;
  finding.id = needed(table, "id");
  finding.mechanism = needed(table, "mechanism");
  if (const auto given = table.given("status")) {
    const auto sentence =
        take(Field{.key = "status", .text = "", .lenient = kDecidesNothing}, given->value, finding.status);
    if (!sentence.empty()) given->refuse(sentence);
  }
  table.get("until", finding.until);
  table.get("reason", finding.reason);
  if (finding.status == IssueStatus::Waived && (!is_day(finding.until) || finding.reason.empty()))
    throw InputError(
        table.place("status"),
        "a waiver has a last day, one of the calendar, and a reason: until = \"2027-01-31\" and reason = \"...\"");
  finding.end = needed(table, "end");
  finding.choice = read_choice(table);
  finding.refuted = texts(table, kRefuted);
  finding.ways = lists(table, "ways");
  finding.doings = texts(table, "doings");
  finding.says = texts(table, "says");
  finding.found_in = needed(table, "found_in");
  finding.smallest = needed(table, "case");
  finding.world = needed(table, "world");
  finding.other_worlds = texts(table, "other_worlds");
  finding.whole.files = texts(table, "runs");
  read_judge(table, finding);
  read_neighbours(table, finding.neighbours);
  read_whole_runs(table, finding);
  table.finish();
  return finding;
}

std::vector<KnownIssue> read_findings(TomlTable root) {
  std::vector<KnownIssue> findings;
  for (TomlTable& table : root.tables(kFindings)) {
    KnownIssue finding = read_finding(table);
    if (std::ranges::count(findings, finding.id, &KnownIssue::id) > 0)
      throw InputError(table.place("id"), fmt::format("{} stands in the file twice", toml_text(finding.id)));
    findings.push_back(std::move(finding));
  }
  root.finish();
  return findings;
}

// A failure that needs less is this one, too.
KeptFailure struck_failure(const KnownIssue& finding) {
  KeptFailure kept{.end = finding.end, .ways = finding.ways, .doings = finding.doings, .says = finding.says};
  for (const std::vector<std::string>& way : finding.ways) {
    std::vector<std::string> left = way;
    std::erase_if(left, [&](const std::string& need) { return names_all(finding.refuted, {need}); });
    if (std::ranges::count(kept.ways, left) == 0) kept.ways.push_back(std::move(left));
  }
  std::erase_if(kept.doings, [&](const std::string& doing) { return names_all(finding.refuted, {doing}); });
  return kept;
}

}  // namespace

FindingsFile::FindingsFile(std::string path) : path_(std::move(path)) {
  if (is_name_taken(path_)) findings_ = read_findings(TomlTable::read(path_));
}

const KnownIssue* FindingsFile::find(std::string_view id) const {
  const auto found = std::ranges::find(findings_, id, &KnownIssue::id);
  return found == findings_.end() ? nullptr : &*found;
}

std::string FindingsFile::path_beside(const std::string& name) const {
  return (std::filesystem::path(path_).parent_path() / name).string();
}

KeptFailure FindingsFile::failure(const KnownIssue& finding) const {
  KeptFailure kept = struck_failure(finding);
  kept.smallest = read_scenario(path_beside(finding.smallest));
  kept.world = read_scenario(path_beside(finding.world));
  for (const std::string& world : finding.other_worlds) kept.other_worlds.push_back(read_scenario(path_beside(world)));
  for (const std::string& run : finding.whole.files) kept.runs.push_back(read_scenario(path_beside(run)));
  return kept;
}

KnownRuns FindingsFile::known_runs(const KnownIssue& finding) const {
  KnownRuns known{finding.whole.counts, {}};
  if (!finding.whole.others_need.empty())
    known.others.push_back({{.end = finding.end, .ways = finding.whole.others_need, .doings = {}, .says = {}},
                            finding.whole.counts.said.always,
                            finding.whole.counts.said.usually});
  for (const KnownIssue& other : findings_) {
    if (other.found_in != finding.found_in || other.id == finding.id) continue;
    known.others.push_back({struck_failure(other), other.neighbours.said.always, other.neighbours.said.usually,
                            other.whole.counts.circumstances});
  }
  return known;
}

std::string toml_of(const KnownIssue& finding) {
  std::string text = fmt::format("\n[[finding]]\nid = {}\nmechanism = {}\nstatus = \"{}\"\n", toml_text(finding.id),
                                 toml_text(finding.mechanism), name_of(finding.status));
  if (!finding.refuted.empty()) text += fmt::format("{} = {}\n", kRefuted, list_of(finding.refuted));
  text += text_of_choice(finding.choice);
  if (!finding.doings.empty()) text += fmt::format("doings = {}\n", list_of(finding.doings));
  if (!finding.says.empty()) text += fmt::format("says = {}\n", list_of(finding.says));
  text += fmt::format("end = {}\nways = {}\nfound_in = {}\ncase = {}\nworld = {}\n", toml_text(finding.end),
                      lists_of(finding.ways), toml_text(finding.found_in), toml_text(finding.smallest),
                      toml_text(finding.world));
  if (!finding.other_worlds.empty()) text += fmt::format("other_worlds = {}\n", list_of(finding.other_worlds));
  text += text_of_judge(finding);
  text += fmt::format("neighbours = {}\nneighbours_failing = {}\n", finding.neighbours.of, finding.neighbours.alike);
  text += fmt::format(
      "world_neighbours = {}\nworld_neighbours_failing = {}\nneighbours_driven_m = {}\n"
      "driven_elsewhere_m = {}\n",
      finding.neighbours.of_world, finding.neighbours.alike_of_world, finding.neighbours.driven_m,
      finding.neighbours.driven_elsewhere_m);
  return text + text_of_words("", finding.neighbours) + text_of_ends("neighbours_otherwise", finding.neighbours) +
         text_of_circumstances("circumstances", finding.neighbours.circumstances) + text_of_whole_runs(finding);
}

std::optional<std::string> with_refuted(const std::string& text, const KnownIssue& finding,
                                        const std::vector<std::string>& refuted) {
  std::vector<KnownIssue> wanted = read_findings(TomlTable::parse(text, kNoFile));
  const auto its = std::ranges::find(wanted, finding.id, &KnownIssue::id);
  if (its == wanted.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(its - wanted.begin());
  std::string changed = with_value(text, kNoFile, kFindings, index, kRefuted, list_of(refuted), "id");
  its->refuted = refuted;
  try {
    const auto texts_of = [](const std::vector<KnownIssue>& findings) {
      std::vector<std::string> texts;
      std::ranges::transform(findings, std::back_inserter(texts), toml_of);
      return texts;
    };
    if (texts_of(read_findings(TomlTable::parse(changed, kNoFile))) == texts_of(wanted)) return changed;
  } catch (const InputError&) {
  }
  return std::nullopt;
}

std::string standing_of(const KnownIssue* kept, std::string_view today) {
  if (kept == nullptr) return "new";
  switch (kept->status) {
    case IssueStatus::Known:
      return "known";
    case IssueStatus::Fixed:
      return "back";
    case IssueStatus::Waived:
      return kept->until >= today ? "waived until " + kept->until : "known (waived until " + kept->until + ")";
  }
  invariant_violated("a finding has a status");
}

bool needs_attention(const KnownIssue* kept, std::string_view today) {
  if (kept == nullptr || kept->status == IssueStatus::Fixed) return true;
  return kept->status == IssueStatus::Waived && kept->until < today;
}

}  // namespace fleetproof
