#include "reports/campaign_page/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/contract.hpp"
#include "reports/campaign_page/campaign_charts.hpp"
#include "reports/campaign_page/look.hpp"
#include "reports/markup/section_tables.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/failure_section.hpp"
#include "reports/sections/page_builder.hpp"
#include "reports/sections/plan_conditions.hpp"

namespace fleetproof {
namespace {

using html::Element;
using html::paragraph;
using html::text_element;
using html::titled;

constexpr std::size_t kMostPageRows = 300, kMostFailureGroups = 50, kMostPlanBytes = 100'000;
constexpr std::size_t kMostInHead = 6;      // groups of failing runs at the top of the page
constexpr std::size_t kStripsUnfolded = 3;  // of the first groups of failing runs

// What the bar at the top calls a section, by the beginning of its title; others have their title there.
constexpr std::pair<std::string_view, std::string_view> kShortTitles[] = {{"Gates", "Gates"},
                                                                          {kFailuresTitle, "Failing runs"},
                                                                          {"Failures, throughput", "Maps"},
                                                                          {"How close", "Clearances"},
                                                                          {"Would more runs", "More runs?"},
                                                                          {"What the runs met", "Met"},
                                                                          {"What the other laws", "Other laws"},
                                                                          {"Which planted faults", "Planted faults"},
                                                                          {"How to read the tables", "Columns"},
                                                                          {"Worst case", "Worst case"},
                                                                          {"Contract region", "Contract"},
                                                                          {"Outside the contract", "Outside"},
                                                                          {"Can the runs", "Repeated?"},
                                                                          {"Weak points", "Weak points"},
                                                                          {"Attempts", "Attempts"},
                                                                          {"How to read this", "Method"},
                                                                          {"Assumptions", "Model"},
                                                                          {"What this page", "Limits"}};

Element head_of(const Page& page) {
  Element head("head");
  head.add(Element("meta", {{"charset", "utf-8"}}));
  head.add(Element("meta", {{"http-equiv", "Content-Security-Policy"},
                            {"content",
                             "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src "
                             "data:"}}));
  head.add(Element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}));
  head.add(Element("meta", {{"name", "generator"}, {"content", "fleetproof report"}}));
  head.add(text_element("title", page.title));
  return head.add(Element("style").literal(html::part_styles()).literal(html::style_sheet()));
}

Element facts_of(const std::vector<Fact>& facts) {
  Element body("tbody");
  for (const auto& [name, value] : facts) {
    Element row("tr");
    row.add(text_element("th", name, {{"scope", "row"}, {"align", "left"}}));
    body.add(row.add(text_element("td", value)));
  }
  return Element("table", {{"class", "facts"}, {"cellpadding", "4"}}).add(body);
}

Element words_part() {
  return html::fold("Words of this page")
      .add(text_element(
          "p",
          "Words of this page. Run: one simulation of one agent, the control software under test. Cell (test "
          "condition): "
          "one "
          "combination of agent, layout, fleet size and radio quality. World (replicate): one draw of all that is "
          "random, "
          "run in every cell. Law (monitor): watches each run and files what must not happen. Gate (acceptance "
          "criterion): "
          "a requirement that was fixed before the first run. Transport (order): a load to be brought from one station "
          "(node) to another. Hull (envelope): the floor that an AGV locks before it drives; agents such as hull-lock "
          "are "
          "named after it.",
          {{"class", "words"}}));
}

Element listed(std::initializer_list<const char*> items) {
  Element list("ul");
  for (const char* item : items) list.add(text_element("li", item));
  return list;
}

static_assert(kContractLoss == 0.4 && kContractDelay_s == 2.0, "the last sentence says it in words");

Element limits_part() {
  return titled("What this page does not say")
      .add(listed(
          {"That the software is safe, or that no collision is possible. A claim says how rare failures are under the "
           "conditions above, with a stated confidence. A search only counts them.",
           "A performance level, a safety integrity level, a rate of dangerous failures of a safety function, or "
           "conformity with a standard such as ISO 3691-4.",
           "Anything about other layouts, fleets, loads or radio than those sampled, about another version of "
           "the software, about hardware faults that were not injected, or about attacks.",
           "Anything about real vehicles beyond what the simulator was validated for. It does not look at the "
           "safety of people.",
           "That the release is safe with 95 % probability: 95 % is how often this procedure is right in the "
           "long run. Very small rates, such as one in a billion hours, are out of reach of testing alone.",
           "What a typical site will see: 40 % loss and 2 s delay are stress, not typical radio."}));
}

Element assumptions_part() {
  const std::initializer_list<const char*> items = {
      "Vehicles, loads and obstacles are rigid shapes in a plane. Height, tilt and wheel slip are not "
      "modelled.",
      "Motion follows the speed and acceleration of the vehicle type exactly, apart from the deviations "
      "that the plan draws. Sideways travel, doors and lifts are not modelled.",
      "Clearances are computed to a micrometre and rounded down. Curves are followed as the layout defines them. What "
      "is built to the safety distance keeps it: a micrometre less is allowed, and ten more for each of the two "
      "vehicles that drives a curve.",
      "The radio loses and delays messages by the models that the plan names. They stand for walls, racks and "
      "other senders; no propagation of waves is computed.",
      "Position and battery are known to the agent without error unless the plan says otherwise.",
      "People are not modelled. Without the safety scanner, only the software keeps the distance."};
  Element fold = html::fold(count_text(items.size(), "sentence"));
  return titled("Assumptions and known gaps of the model").add(fold.add(listed(items)));
}

std::string place_of_group(std::size_t number) { return fmt::format("group-{}", number + 1); }

// To the page of the run, else to where this page says more of its group.
Element link_to_run(const HtmlInput& input, std::uint64_t run_index, std::size_t group, const std::string& text) {
  if (input.cases.contains(run_index)) return Element::link_to_page(case_page_name(run_index), "", text);
  return Element::link_to(place_of_group(group), text);
}

std::vector<std::uint64_t> other_cases(const HtmlInput& input, const FailureGroup& group) {
  std::vector<std::uint64_t> runs;
  for (const FailingRun& run : group.first) {
    if (run.run_index != group.worst.run_index && input.cases.contains(run.run_index)) runs.push_back(run.run_index);
  }
  return runs;
}

// The worst run of each group, in a line each.
Element failing_list(const HtmlInput& input, const std::vector<FailureGroup>& groups) {
  Element block("div", {{"class", "failing"}});
  block.add(paragraph("Runs in which something went wrong, of each kind the worst:"));
  Element list("ul");
  for (std::size_t i = 0; i < std::min(groups.size(), kMostInHead); ++i) {
    const FailureGroup& group = groups[i];
    Element item("li");
    item.add(link_to_run(input, group.worst.run_index, i, fmt::format("run {}", group.worst.run_index)));
    item.text(fmt::format(": {}, {}{}", printable(group.agent, 40), printable(group.first_cause, 80),
                          group.runs > 1 ? fmt::format(" (one of {} runs)", group.runs) : ""));
    for (const std::uint64_t run : other_cases(input, group))
      item.text(", ").add(link_to_run(input, run, i, fmt::format("run {}", run)));
    list.add(item);
  }
  if (groups.size() > kMostInHead) {
    Element more("li");
    list.add(
        more.add(Element::link_to(html::id_of(kFailuresTitle), count_text(groups.size() - kMostInHead, "more kind"))));
  }
  return block.add(list);
}

Element worst_of_group(const HtmlInput& input, const FailureGroup& group, std::size_t number) {
  Element block("div", {{"class", "case"}, {"id", place_of_group(number)}});
  block.add(text_element("h3", fmt::format("{}: {}; leading failure: {}; before it: {}", printable(group.agent, 40),
                                           group.end_point, printable(group.first_cause, 80), name_of(group.before))));
  const Remark remark = worst_of(input.report, group);
  block.add(paragraph(remark.text));
  if (!remark.command.empty()) block.add(Element("pre").add(text_element("code", remark.command)));
  if (input.cases.contains(group.worst.run_index)) {
    Element links("p");
    links.add(link_to_run(input, group.worst.run_index, number, "The page of this run"));
    for (const std::uint64_t run : other_cases(input, group))
      links.text(", ").add(link_to_run(input, run, number, fmt::format("run {}", run)));
    block.add(links);
  }
  if (const auto strip = input.strips.find(group.worst.run_index); strip != input.strips.end())
    block.add(number < kStripsUnfolded ? html::draw(strip->second)
                                       : html::fold("Film strip").add(html::draw(strip->second)));
  return block;
}

// Failing runs by agent, end point and leading failure, at most 50 groups: a table, then the worst run of each group
// with its replay line and its strip, if there is one.
Element failure_part(const HtmlInput& input) {
  Element part = titled(kFailuresTitle);
  auto groups = input.report.failures.list(input.report.evidence.plan());
  if (groups.empty()) return part.add(paragraph("No run failed."));
  const std::size_t all = groups.size();
  groups.resize(std::min(all, kMostFailureGroups));
  part.add(paragraph(std::string(kFailureColumns)));
  part.add(html::table_of(failure_table(groups)));
  part.add(
      paragraph("Below, the worst run of each group with the command that replays it. With --html FILE added, the "
                "command writes a page that shows the run in a browser."));
  if (!input.strips.empty()) {
    part.add(paragraph(
        "A film strip shows the floor from above, in metres, around the worst instant, which has a thick frame. The "
        "AGVs in orange are those that went wrong; the dark wedge points to the front, the dashed line is the safety "
        "distance, lanes are grey."));
  }
  for (std::size_t i = 0; i < groups.size(); ++i) part.add(worst_of_group(input, groups[i], i));
  if (all > kMostFailureGroups)
    part.add(paragraph(fmt::format("{} more groups are left out here.", all - kMostFailureGroups)));
  return part;
}

Element plan_part(const ReportInput& input) {
  Element details("details", {{"class", "plan"}});
  details.add(text_element("summary", "The resolved plan"));
  const auto plan = plan_listing(input.campaign.plan_json, kMostPlanBytes);
  if (plan.empty()) return details.add(paragraph("The results file holds no plan text."));
  return details.add(Element("pre").add(Element("code").lines(plan)));
}

// All below the headlines, in order.
std::vector<Element> parts_of(const HtmlInput& input, const Page& page) {
  std::vector<Element> parts;
  const auto add = [&](std::initializer_list<SectionTopic> topics) {
    for (const SectionTopic topic : topics) {
      for (const Section& section : page.sections) {
        if (section.topic == topic) parts.push_back(html::part_of(section));
      }
    }
  };
  for (const Section& section : page.sections) {
    if (section.topic == SectionTopic::Gates)
      parts.push_back(html::folded_section_of(section, "Figures and reason of each gate (acceptance criterion)"));
  }
  // The worst run of each group stands there: a list of the worst runs would be one failure many times.
  parts.push_back(failure_part(input));
  const auto conditions = campaign_conditions(input.report);
  parts.push_back(
      titled("Conditions").add(html::fold(count_text(conditions.size(), "fact")).add(facts_of(conditions))));
  parts.push_back(html::map_part(input.report, input.figures));
  add({SectionTopic::Groups});
  parts.push_back(html::clearance_part(input.report, input.figures));
  parts.push_back(html::effort_part(input.report, input.figures));
  add({SectionTopic::Comparison, SectionTopic::Coverage, SectionTopic::Sensitivity, SectionTopic::Conditions,
       SectionTopic::Audit, SectionTopic::WeakPoints, SectionTopic::Attempts, SectionTopic::Provenance});
  parts.push_back(plan_part(input.report));
  add({SectionTopic::Method});
  parts.push_back(assumptions_part());
  parts.push_back(limits_part());
  return parts;
}

std::string_view short_title(std::string_view title) {
  const auto known =
      std::ranges::find_if(kShortTitles, [&](const auto& entry) { return title.starts_with(entry.first); });
  return known == std::end(kShortTitles) ? title : known->second;
}

// The bar at the top of the page.
Element contents_of(const std::vector<Element>& parts) {
  Element list("ul");
  for (const Element& part : parts) {
    if (part.title().empty()) continue;
    Element item("li");
    list.add(item.add(Element::link_to(html::id_of(part.title()), short_title(part.title()))));
  }
  return Element("nav", {{"aria-label", "contents"}}).add(list);
}

}  // namespace

HtmlInput read_html_input(const ArchiveReader& archive, std::string archive_path) {
  html::CampaignFigures figures;
  const auto count = [&](const RunRecord& run, const Evidence& evidence) { figures.add(run, evidence); };
  ReportInput report = read_report_input(archive, std::move(archive_path), count);
  figures.finish(report.evidence);
  return {std::move(report), std::move(figures)};
}

std::string case_page_name(std::uint64_t run_index) { return fmt::format("case-{}.html", run_index); }

std::string render_html(const HtmlInput& input) {
  const Page page = build_page(input.report, kMostPageRows);
  Element main("main");
  const std::vector<Element> parts = parts_of(input, page);
  main.add(contents_of(parts)).add(text_element("h1", page.title));
  const auto groups = input.report.failures.list(input.report.evidence.plan());
  const Element failing = failing_list(input, groups);
  for (std::size_t i = 0; i < page.headlines.size(); ++i)
    main.add(html::headline_of(page.headlines[i], i == 0 && !groups.empty() ? &failing : nullptr));
  main.add(words_part());
  for (const Element& part : parts) main.add(part);
  Element root("html", {{"lang", "en"}});
  root.add(head_of(page)).add(Element("body").add(main).add(Element("script").literal(html::script())));
  return "<!DOCTYPE html>\n" + root.str() + "\n";
}

}  // namespace fleetproof
