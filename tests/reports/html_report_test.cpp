#include "reports/campaign_page/html_report.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <pugixml.hpp>
#include <set>

#include "reports/page/wording.hpp"
#include "storage/archive_writer.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::html_report_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using testing::HasSubstr;
using testing::Not;

// An archive of all planned replicates in a folder of its own, and its page.
class Archive {
 public:
  Archive(const CampaignRecord& campaign, const std::vector<CellRecord>& cells, const std::vector<GateRecord>& gates,
          std::uint64_t runs, const samples::Change& change = {}) {
    ArchiveWriter writer(path(), {campaign, cells, gates});
    for (std::uint64_t i = 0; i < runs; ++i) {
      auto run = samples::clean_run(i, cells.size());
      run.factors = cells[run.cell].lowest;
      run.outcome.digest = i + 1;
      if (change) change(run);
      writer.add(run);
    }
    writer.publish(runs);
  }
  std::string path() const { return folder_ / "night.fp"; }
  std::string page() const { return render_html(read_html_input(ArchiveReader(path()), "night.fp")); }

 private:
  samples::TemporaryFolder folder_;
};

// Every tag is closed, and every attribute stands in quotes. Nothing is loaded, and nothing carries a style or a
// handler of its own.
void expect_sound(const std::string& page) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(page.data(), page.size(), pugi::parse_full);
  ASSERT_TRUE(parsed) << parsed.description() << " at " << page.substr(static_cast<std::size_t>(parsed.offset), 200);
  const std::function<void(const pugi::xml_node&)> visit = [&](const pugi::xml_node& node) {
    static const std::set<std::string> loading = {"link", "iframe", "img", "object", "embed", "base", "form"};
    EXPECT_FALSE(loading.contains(node.name())) << node.name();
    for (const auto& attribute : node.attributes()) {
      const std::string name = attribute.name();
      EXPECT_FALSE(name == "style" || name == "src" || name.starts_with("on")) << name;
      EXPECT_TRUE(name != "href" || attribute.value()[0] == '#') << "a link leaves the page";
    }
    if (std::string(node.name()) == "tbody") {
      EXPECT_LE(std::distance(node.begin(), node.end()), 500);
    }
    for (const auto& child : node.children()) visit(child);
  };
  visit(document);
  EXPECT_STREQ(document.document_element().name(), "html");
}

std::vector<GateRecord> gates() { return {gate_of("sound", GateKind::Rate, Region::Contract, 1e-2)}; }

TEST(HtmlReport, is_whole_for_every_size_of_campaign) {
  const auto campaign = campaign_of("claim", 1);
  expect_sound(Archive(campaign, grid({"sound"}, {0.4}, {2.0}), gates(), 0).page());
  expect_sound(Archive(campaign, grid({"sound"}, {0.4}, {2.0}), gates(), 1).page());
  expect_sound(Archive(campaign, grid({"sound"}, {0.4}, {2.0}), {}, 1).page());
  expect_sound(Archive(campaign_of("search", 1), grid({"sound"}, {0.4}, {2.0}), {}, 1).page());
  std::vector<double> losses, delays_s;
  for (int i = 0; i < 20; ++i) {
    losses.push_back(i * 0.04);
    delays_s.push_back(i * 0.2);
  }
  const auto large = Archive(campaign, grid({"sound"}, losses, delays_s), gates(), 400).page();
  expect_sound(large);
  EXPECT_LT(large.size(), 2'000'000u);
}

TEST(HtmlReport, its_contents_link_to_every_section) {
  const auto page =
      Archive(campaign_of("claim", 4), grid({"sound", "odd"}, {0.4, 0.8}, {2.0}, {"ring", "cross"}), gates(), 32,
              [](RunRecord& run) {
                if (run.run_index == 3) samples::violate(run);
              })
          .page();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  std::vector<std::pair<std::string, std::string>> links;
  std::vector<std::string> sections;
  for (const auto& each : document.select_nodes("//nav//a"))
    links.emplace_back(each.node().attribute("href").value(), each.node().text().get());
  std::set<std::string> ids;
  for (const auto& each : document.select_nodes("//section")) {
    const std::string id = each.node().attribute("id").value();
    EXPECT_TRUE(ids.insert(id).second) << id << " twice";
    sections.push_back("#" + id);
  }
  ASSERT_EQ(links.size(), sections.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    EXPECT_EQ(links[i].first, sections[i]);
    EXPECT_LT(links[i].second.size(), 16U) << "all of them have room on one line of a screen";
  }
  EXPECT_THAT(links, testing::Contains(testing::Pair("#would-more-runs-tell-more", "More runs?")));
  EXPECT_LT(page.find("<nav"), page.find("class=\"headline")) << "it stays at the top from the first screen on";
}

// Verdict, gates and failing runs are open; what is long below them is a line until one asks for it.
TEST(HtmlReport, long_tables_stand_folded_below_what_one_reads_first) {
  const auto page =
      Archive(campaign_of("claim", 4), grid({"sound", "odd"}, {0.0, 0.2, 0.4, 0.6, 0.8}, {1.0, 2.0}), gates(), 80,
              [](RunRecord& run) {
                if (run.run_index % 9 == 3) samples::violate(run);
              })
          .page();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  std::size_t folded = 0;
  for (const auto& table : document.select_nodes("//table[count(tbody/tr) > 8]")) {
    const auto details = table.node().select_node("ancestor::details").node();
    const std::string title = table.node().select_node("ancestor::section").node().child("h2").text().get();
    EXPECT_TRUE(details) << title;
    EXPECT_FALSE(details.attribute("open"));
    EXPECT_STRNE(details.child("summary").text().get(), "");
    folded += details ? 1 : 0;
  }
  EXPECT_GT(folded, 0U);
  for (const char* open : {"//div[contains(@class, 'headline')]", "//section[h2='Gates (acceptance criteria)']//table",
                           "//section[starts-with(h2, 'Runs in which')]//table", "//div[@class='case']"})
    EXPECT_FALSE(document.select_node(open).node().select_node("ancestor::details")) << open;
  EXPECT_TRUE(document.select_node("//main/nav")) << "the bar stays at the top of all that is in its parent";
}

TEST(HtmlReport, a_worst_run_outside_the_contract_is_called_so) {
  const auto page_at = [](double loss) {
    return Archive(campaign_of("claim", 4), grid({"sound"}, {loss}, {2.0}), gates(), 4,
                   [](RunRecord& run) { samples::violate(run); })
        .page();
  };
  EXPECT_THAT(page_at(0.8), HasSubstr("(outside the contract)</p>"));
  EXPECT_THAT(page_at(0.4), Not(HasSubstr("(outside the contract)</p>")));
}

TEST(HtmlReport, a_clearance_that_was_not_measured_is_not_called_large) {
  const auto page = Archive(campaign_of("claim", 4), grid({"sound"}, {0.4}, {2.0}), gates(), 4, [](RunRecord& run) {
                      run.outcome.engine_error = run.run_index == 2;
                    }).page();
  EXPECT_THAT(page, HasSubstr("Agent sound, contract: 4 runs, 3 never closer than 0.5 m, 1 not measured<"));
}

// Texts of the fields of the map with this label, without the names of its axes.
std::vector<std::string> field_texts(const pugi::xml_document& page, const std::string& label) {
  std::vector<std::string> texts;
  const auto map = page.select_node(("//svg[@aria-label=\"" + label + "\"]").c_str()).node();
  EXPECT_TRUE(map) << label;
  for (const auto& text : map.children("text")) {
    if (std::string(text.attribute("fill").value()).starts_with("#")) texts.emplace_back(text.text().get());
  }
  return texts;
}

// The oracle asks the stored rows and counts by itself.
TEST(HtmlReport, every_number_of_the_maps_is_that_of_a_query) {
  const std::vector<double> losses = {0.0, 0.4, 0.6}, delays_s = {0.0, 2.0};
  const auto cells = grid({"sound", "odd"}, losses, delays_s, {"ring", "cross"});
  const Archive archive(campaign_of("claim", 40), cells, gates(), 40 * cells.size() + 5, [](RunRecord& run) {
    if (run.run_index % 7 == 3 || run.run_index % 10 == 1) samples::violate(run);
    if (run.run_index % 31 == 2) run.outcome.crash = true;
    if (run.run_index % 37 == 4) run.outcome.indeterminate = true;
    run.outcome.counters.transports_done = run.run_index % 13;
    run.outcome.counters.safe_mode_ns = run.run_index % 11 * 60'000'000'000;
  });
  const std::string page = archive.page();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  SQLite::Database database(archive.path());
  for (const std::string agent : {"sound", "odd"}) {
    std::vector<std::string> counts, rates, shares;
    for (const double loss : losses) {
      for (const double delay_s : delays_s) {
        SQLite::Statement query(database, R"sql(
WITH runs AS (SELECT * FROM v1_runs WHERE agent = ? AND loss = ? AND delay_s = ? AND replicate < 40),
worlds AS (SELECT max(violation OR contact OR crash OR hang OR indeterminate OR engine_error) AS failed
           FROM runs GROUP BY replicate)
SELECT (SELECT sum(failed) FROM worlds), (SELECT count(*) FROM worlds),
       sum(transports_done) / sum(simulated_ns * 1e-9 * agv_count / 3600.0),
       sum(safe_mode_ns * 1.0) / sum(simulated_ns * agv_count) FROM runs)sql");
        query.bind(1, agent);
        query.bind(2, loss);
        query.bind(3, delay_s);
        ASSERT_TRUE(query.executeStep());
        counts.push_back(fmt::format("{}/{}", query.getColumn(0).getInt64(), query.getColumn(1).getInt64()));
        rates.push_back(fmt::format("{:.2f}", query.getColumn(2).getDouble()));
        shares.push_back(percent(query.getColumn(3).getDouble()));
      }
    }
    std::vector<std::string> shown;
    for (const auto& text : field_texts(document, "Upper bound of the failure rate. Agent " + agent)) {
      if (text.find('/') != std::string::npos) shown.push_back(text);
    }
    EXPECT_EQ(shown, counts);
    EXPECT_EQ(field_texts(document, "Transports per AGV-hour. Agent " + agent), rates);
    EXPECT_EQ(field_texts(document, "Share of time in safe mode. Agent " + agent), shares);
  }
}

TEST(HtmlReport, a_field_without_evidence_is_hatched) {
  const auto page = Archive(campaign_of("claim", 2), grid({"sound"}, {0.4}, {2.0}), gates(), 0).page();
  EXPECT_THAT(page, HasSubstr("fill=\"url(#hatch)\""));
  const auto filled = Archive(campaign_of("claim", 2), grid({"sound"}, {0.4}, {2.0}), gates(), 2).page();
  EXPECT_THAT(filled, Not(HasSubstr("fill=\"url(#hatch)\"")));
}

TEST(HtmlReport, equal_traces_count_once) {
  const auto cells = grid({"sound"}, {0.4}, {2.0});
  const auto page = Archive(campaign_of("claim", 30), cells, gates(), 30, [](RunRecord& run) {
                      if (run.run_index < 12) samples::violate(run, 70'000, run.run_index == 0);
                      if (run.run_index < 12) run.outcome.digest = run.run_index % 4;
                    }).page();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  std::vector<std::vector<std::string>> rows;
  for (const auto& row : document.select_nodes("//section[starts-with(h2, 'Runs in which something')]//tbody/tr")) {
    rows.emplace_back();
    for (const auto& cell : row.node().children()) rows.back().emplace_back(cell.text().get());
  }
  const std::vector<std::vector<std::string>> expected = {
      {"sound", "contact", "contact, two AGVs", "no injected fault", "1", "1", "0"},
      {"sound", "violation", "safety distance broken, two AGVs", "no injected fault", "11", "4", "1"}};
  EXPECT_EQ(rows, expected);
}

TEST(HtmlReport, hostile_names_stay_text) {
  const std::string hostile = "-\x1b[2J\n</td><script>alert(1)</script>\"'&amp;<b>\xc2\x9b\xe2\x80\xae\xff";
  auto campaign = campaign_of("claim", 3);
  campaign.name = hostile;
  campaign.engine.libraries = hostile;
  campaign.required_probes = {hostile};
  auto gate = gate_of(hostile, GateKind::None, Region::Contract, 1e-3);
  gate.name = hostile;
  gate.method = GateMethod::AnyTime;
  auto input = samples::report_of(campaign, grid({hostile}, {0.4}, {2.0}, {hostile}), {gate}, [&](RunRecord& run) {
    run.outcome.crash = true;
    run.outcome.message = hostile;
    run.outcome.probes = {{ProbeSource::Agent, hostile, 1}};
  });
  input.campaign.plan_json = R"({"factors": {"agents": ["</pre><script>x"], "layouts": [{"name": "<i>"}]}})";
  input.archive_path = hostile + ".fp";
  html::CampaignFigures figures;
  for (std::uint64_t i = 0; i < 3; ++i) {
    auto run = samples::clean_run(i, 1);
    run.outcome.crash = true;
    run.outcome.message = hostile;
    run.outcome.probes = {{ProbeSource::Agent, hostile, 1}};
    figures.add(run, input.evidence);
  }
  figures.finish(input.evidence);
  const auto page = render_html({std::move(input), std::move(figures)});
  expect_sound(page);
  EXPECT_EQ(printable_lines(page), page);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  EXPECT_EQ(document.select_nodes("//script").size(), 1u);
  EXPECT_EQ(document.select_nodes("//b | //i").size(), 0u);
}

// More agents, conditions and causes than the page has room for, with long names everywhere.
TEST(HtmlReport, stays_small_whatever_happens) {
  std::vector<std::string> agents;
  for (int i = 0; i < 14; ++i) agents.push_back(fmt::format("{:<60}{}", "<agent>", i));
  const auto cells = grid(agents, {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9},
                          {0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5}, {std::string(80, '&')});
  const auto change = [](RunRecord& run) {
    run.outcome.message = std::string(500, '<');
    run.outcome.crash = true;
    if (run.run_index % 2 == 0) samples::violate(run, static_cast<std::int64_t>(run.run_index), run.run_index % 3 == 0);
    const auto kinds = incident_kinds();
    Incident incident;
    incident.kind = kinds[run.run_index % kinds.size()].kind;
    file_incidents(run.outcome, {incident});
    file_probes(run.outcome, {{ProbeSource::Agent, fmt::format("{:>80}", run.run_index), 1}});
  };
  auto input = samples::report_of(campaign_of("claim", 2), cells, gates(), change);
  input.campaign.plan_json = "[\"" + std::string(3'000'000, '<') + "\"]";
  html::CampaignFigures figures;
  for (std::uint64_t i = 0; i < 2 * cells.size(); ++i) {
    auto run = samples::clean_run(i, cells.size());
    change(run);
    figures.add(run, input.evidence);
  }
  figures.finish(input.evidence);
  const auto page = render_html({std::move(input), std::move(figures)});
  expect_sound(page);
  EXPECT_LT(page.size(), 2'000'000u);
}

TEST(HtmlReport, the_conditions_come_from_the_plan) {
  auto campaign = campaign_of("claim", 1);
  campaign.plan_json = R"({"factors": {"agents": ["sound"], "layouts": [{"name": "ring"}], "fleet_sizes": [5, 9],
    "loss": [0.0, 0.4], "delay_s": [2.0], "mean_outage_s": [0.0]}, "law": {"safety_distance_m": 0.15, "leave_out":
    ["paper"]}, "faults": {"breakdowns_per_agv_hour": 0.25, "repair_s": 900}, "horizon_s": 450,
    "world": {"transports_per_agv_hour": 30, "placement": "random"}, "vehicles": [], "radio": {}})";
  const auto page = Archive(campaign, grid({"sound"}, {0.4}, {2.0}), gates(), 1).page();
  for (const auto* fact : {">0.15 m<", ">all but paper<", ">5, 9 AGVs<", ">0, 40 %<", ">450 s simulated<",
                           ">breakdowns per agv hour 0.25<", ">0.8 AGV-hours, of all agents and cells<"}) {
    EXPECT_THAT(page, HasSubstr(fact));
  }
}

}  // namespace
}  // namespace fleetproof::html_report_test
