#include "reports/formats/report_formats.hpp"
#include "reports/sections/report_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "reports/page/wording.hpp"
#include "storage/archive_writer.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::report_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;
using testing::Not;

std::string render(const std::string& format, const ReportInput& input) {
  return find_entry(report_formats(), format)->make(input);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ReportInput clean_campaign(std::uint64_t replicates = 200) {
  return report_of(campaign_of("claim", replicates), grid({"sound"}, {0.0, 0.2, 0.4}, {0.0, 0.5, 1.0, 2.0}),
                   {gate_of("sound", GateKind::None, Region::Contract, 1e-3)});
}

ReportInput failing_campaign(GateKind kind = GateKind::Rate) {
  return report_of(campaign_of("claim", 5000), grid({"sound"}, {0.0, 0.4, 0.8}, {2.0}),
                   {gate_of("sound", kind, Region::Contract, 1e-2)}, [](RunRecord& run) {
                     if (run.run_index == 3001) samples::violate(run);  // at 40 %, 2 s
                   });
}

TEST(Report, without_a_violation_the_bound_is_printed_all_the_same) {
  for (const auto* format : {"text", "markdown"}) {
    auto page = render(format, clean_campaign());
    std::ranges::replace(page, '\n', ' ');
    EXPECT_THAT(page, HasSubstr("not demonstrated")) << format;
    EXPECT_THAT(page, HasSubstr("0 of 200 worlds failed")) << format;
    EXPECT_THAT(page, HasSubstr("1.49 %")) << format;
    EXPECT_THAT(page, Not(HasSubstr("0.0149"))) << format << ": one notation for one figure";
    EXPECT_THAT(page, HasSubstr("2995 worlds")) << format;
  }
  EXPECT_THAT(render("markdown", clean_campaign()),
              HasSubstr("With 200 worlds and no failure, the upper bound of a row by itself is 1.49 % (95 %)."));
}

TEST(Report, the_verdict_claims_what_was_sampled) {
  auto page = render("markdown", clean_campaign());
  EXPECT_THAT(page, HasSubstr("200 worlds at these 12 combinations (loss 0 %, 20 %, 40 %; delay 0 s, 0.5 s, 1 s, 2 "
                              "s), layout ring, fleets of 5, 600 s a run"));
  EXPECT_THAT(render("markdown", clean_campaign(3000)), HasSubstr("**demonstrated**"));
}

TEST(Report, one_violation_in_the_contract_region_heads_the_page_even_if_the_rate_is_met) {
  const auto input = failing_campaign();
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated);
  const auto lines = lines_of(render("text", input));
  ASSERT_GT(lines.size(), 3u);
  EXPECT_THAT(lines[2],
              HasSubstr("violation | agent sound broke the safety distance in 1 run within the contract region"));
  const auto page = render("text", input);
  EXPECT_LT(page.find("-> fleetproof replay night.fp 3001"),
            page.find("demonstrated | sound broke the safety distance"));
}

TEST(Report, a_refuted_gate_shows_its_run) {
  const auto page = render("text", failing_campaign(GateKind::None));
  EXPECT_THAT(page, HasSubstr("violated | sound broke the safety distance in 1 of 5000 worlds; the true share is at "
                              "least 0.00102 % (95 %)"));
  EXPECT_THAT(page, HasSubstr("fleetproof replay night.fp 3001"));
}

TEST(Report, sections_stand_in_their_order) {
  const auto page = render("text", failing_campaign());
  std::size_t last = 0;
  for (const auto* title :
       {"demonstrated |", "Gates (acceptance criteria)", "By layout", "By fleet size", "How to read the tables",
        "Worst case of the contract", "Contract region: loss", "Outside the contract\n", "Weak points",
        "Runs in which something went wrong, by the failure that leads", "Attempts, plan and looks", "Provenance",
        "How to read this"}) {
    const auto at = page.find(title, last);
    ASSERT_NE(at, std::string::npos) << title;
    last = at;
  }
}

TEST(Report, a_table_row_has_interval_bound_clearance_and_progress) {
  const auto page = render("text", failing_campaign());
  const auto lines = lines_of(page);
  const auto row = std::ranges::find_if(lines, [](const std::string& line) {
    return line.find("sound") != std::string::npos && line.find("  40 %") != std::string::npos;
  });
  ASSERT_NE(row, lines.end());
  EXPECT_THAT(*row,
              testing::ContainsRegex("1/5000 +0.02 % +\\[0.000506 %, 0.112 %\\] +0.0949 % +0 +0 +0 +0.07 m +12.00"));
}

TEST(Report, outages_are_shown_where_the_campaign_has_them) {
  const auto without = render("text", clean_campaign());
  EXPECT_THAT(without, Not(HasSubstr("outage")));
  auto cells = grid({"sound"}, {0.4}, {0.0, 2.0});
  for (const auto& cell : grid({"sound"}, {0.4}, {0.0, 2.0})) {
    cells.push_back(cell);
    cells.back().index = static_cast<std::uint32_t>(cells.size() - 1);
    cells.back().lowest[Factor::MeanOutage] = cells.back().highest[Factor::MeanOutage] = 0.5;
  }
  const auto input = report_of(campaign_of("claim", 200), cells,
                               {gate_of("sound", GateKind::None, Region::Contract, 1e-3)}, [](RunRecord& run) {
                                 if (run.run_index == 403) samples::violate(run);  // at 40 %, 2 s, outages of 0.5 s
                               });
  auto page = render("text", input);
  const auto lines = lines_of(page);
  const auto head = std::ranges::find_if(lines, [](const std::string& line) {
    return line.find("outage") != std::string::npos && line.find("95 %") != std::string::npos;
  });
  ASSERT_NE(head, lines.end()) << page;
  EXPECT_THAT(page, HasSubstr("40 %    2 s    none"));
  EXPECT_THAT(page, HasSubstr("40 %    2 s   0.5 s"));
  std::ranges::replace(page, '\n', ' ');
  EXPECT_THAT(page, testing::ContainsRegex("loss 40 %, +delay 2 s, outages of 0.5 s"));
  EXPECT_THAT(page, HasSubstr("mean outage 0 s, 0.5 s"));
  EXPECT_THAT(render("json", input), HasSubstr("\"mean_outage_s\": 0.5"));
}

TEST(Report, the_cost_of_a_call_is_shown_where_the_campaign_has_one) {
  EXPECT_THAT(render("text", clean_campaign()), Not(HasSubstr("call cost")));
  auto cells = grid({"sound"}, {0.4, 0.4}, {2.0});
  cells[1].lowest[Factor::CallCost] = cells[1].highest[Factor::CallCost] = 0.0125;
  const auto input = report_of(campaign_of("claim", 200), cells,
                               {gate_of("sound", GateKind::None, Region::Contract, 1e-3)}, [](RunRecord& run) {
                                 if (run.run_index == 3) samples::violate(run);
                               });
  auto page = render("text", input);
  EXPECT_THAT(page, testing::ContainsRegex("loss +delay +call cost +runs"));
  EXPECT_THAT(page, HasSubstr("2 s       none"));
  EXPECT_THAT(page, HasSubstr("2 s    12.5 ms"));
  std::ranges::replace(page, '\n', ' ');
  EXPECT_THAT(page, testing::ContainsRegex("loss 40 %, +delay 2 s, +call cost 12.5 ms"));
  EXPECT_THAT(page, testing::ContainsRegex("call cost 0 ms, +12.5 ms"));
  EXPECT_THAT(page, testing::ContainsRegex("call cost = simulated time +that every call"));
  EXPECT_THAT(render("json", input), HasSubstr("\"call_cost_s\": 0.0125"));
}

TEST(Report, no_text_line_is_wider_than_150_columns) {
  for (const auto& input :
       {clean_campaign(), failing_campaign(),
        report_of(campaign_of("claim", 3),
                  grid({"sound-with-timeouts-and-a-long-name", "sound"}, {0.4}, {2.0}, {"ring", "cross"}), {})}) {
    for (const auto& line : lines_of(render("text", input))) EXPECT_LE(line.size(), 150u) << line;
  }
}

TEST(Report, a_table_too_wide_for_a_terminal_still_names_every_agent) {
  const auto input =
      report_of(campaign_of("claim", 3000), grid({"an-agent-with-a-name-that-is-very-long", "sound"}, {0.4}, {2.0}), {},
                [](RunRecord& run) {
                  if (run.run_index == 7) samples::violate(run);
                });
  const auto lines = lines_of(render("text", input));
  const auto name = std::ranges::find(lines, " an-agent-with-a-name-that-is-very-long");
  ASSERT_NE(name, lines.end());
  EXPECT_THAT(*std::next(name), HasSubstr("0/3000"));
  EXPECT_EQ(*std::next(name, 2), " sound");
  EXPECT_THAT(*std::next(name, 3), HasSubstr("1/3000"));
}

TEST(Report, a_search_prints_counts_and_no_rates) {
  const auto input = report_of(campaign_of("search", 50), grid({"sound"}, {0.4}, {2.0, 5.0}),
                               {gate_of("sound", GateKind::None, Region::Contract, 1e-3)}, [](RunRecord& run) {
                                 if (run.run_index == 10) samples::violate(run);
                               });
  for (const auto* format : {"text", "markdown"}) {
    const auto page = render(format, input);
    EXPECT_THAT(page, HasSubstr("1 run failed"));
    EXPECT_THAT(page, Not(HasSubstr("interval")));
    EXPECT_THAT(page, Not(HasSubstr("upper")));
  }
  const auto json = nlohmann::json::parse(render("json", input));
  EXPECT_TRUE(json["gates"][0]["claim"].is_null());
  EXPECT_FALSE(json["cells"][0].contains("claim"));
  EXPECT_EQ(json["verdict"], "violated");
}

TEST(Report, pooled_rows_say_that_their_unit_is_the_replicate) {
  const auto pooled = report_of(campaign_of("claim", 20), grid({"sound"}, {0.4}, {2.0}, {"ring", "cross", "aisle"}), {},
                                [](RunRecord& run) {
                                  if (run.replicate == 4) samples::violate(run);
                                });
  EXPECT_THAT(render("text", pooled), HasSubstr("Its unit is the replicate"));
  EXPECT_THAT(render("text", pooled), HasSubstr("1/20"));
  EXPECT_THAT(render("text", pooled), HasSubstr("3 runs"));
  EXPECT_THAT(render("text", clean_campaign()), Not(HasSubstr("Its unit is the replicate")));
  EXPECT_EQ(nlohmann::json::parse(render("json", pooled))["cells"].size(), 3u);
}

TEST(Report, unknown_outcomes_have_their_optimistic_line) {
  const auto input = report_of(campaign_of("claim", 100), grid({"sound"}, {0.4}, {2.0}),
                               {gate_of("sound", GateKind::Rate, Region::WorstCase, 1e-3)},
                               [](RunRecord& run) { run.outcome.crash = run.run_index % 10 == 0; });
  const auto page = render("markdown", input);
  EXPECT_THAT(page, HasSubstr("0 of 100 runs failed and 10 stayed unknown, which counts as failing"));
  EXPECT_THAT(page, HasSubstr("If none of the unknown had failed: 0 of 100, upper bound 2.96 %"));
}

TEST(Report, json_has_full_digits_units_and_hexadecimal_digests) {
  const auto json = nlohmann::json::parse(render("json", failing_campaign()));
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["exit_code"], samples::kExitCode);
  EXPECT_EQ(json["verdict"], "demonstrated");
  EXPECT_EQ(json["campaign"]["plan_hash"], "0000000000000abc");
  EXPECT_EQ(json["campaign"]["judged_runs"], 15000);
  const auto& gate = json["gates"][0];
  EXPECT_EQ(gate["verdict"], "demonstrated");
  EXPECT_NEAR(gate["claim"]["upper_bound"].get<double>(), upper_bound(1, 5000, 0.95), 1e-17);
  EXPECT_EQ(gate["worst_run"]["replay"], "fleetproof replay night.fp 3001");
  EXPECT_EQ(gate["worst_run"]["closest"]["closest_at_s"], 12.345);
  const auto& cell = json["cells"][1];
  for (const auto* key : {"delay_s", "loss", "runs", "violating_runs", "stuck_runs", "min_clearance_m", "agv_hours",
                          "transports_per_agv_hour", "claim", "optimistic"}) {
    EXPECT_TRUE(cell.contains(key)) << key;
  }
  EXPECT_EQ(cell["min_clearance_m"], 0.07);
  EXPECT_TRUE(json["cells"][0]["min_clearance_m"].is_null());
}

TEST(Report, markdown_of_500_cells_stays_under_60_kilobytes_and_keeps_the_failing_rows) {
  std::vector<double> losses, delays_s;
  for (int i = 0; i < 25; ++i) losses.push_back(0.02 * i);
  for (int i = 0; i < 20; ++i) delays_s.push_back(0.2 * i);
  const auto cells = grid({"a-rather-long-name-of-an-agent-under-test"}, losses, delays_s);
  ASSERT_EQ(cells.size(), 500u);
  const auto input = report_of(campaign_of("claim", 3), cells,
                               {gate_of(cells[0].agent, GateKind::None, Region::Contract, 1e-3)}, [](RunRecord& run) {
                                 if (run.cell == 205 || run.cell == 490) samples::violate(run);
                                 if (run.cell > 400) {
                                   run.outcome.crash = true;
                                   run.outcome.message = std::string(5000, 'x');
                                 }
                               });
  const auto page = render("markdown", input);
  EXPECT_LT(page.size(), 60'000u);
  EXPECT_THAT(page, HasSubstr("rows with fewer failures are left out"));
  EXPECT_THAT(page, HasSubstr("| 20 % | 1 s | 3 | 3 | 3/3 |"));
  const auto violating = page.find("| 48 % | 2 s | 3 | 3 | 3/3 |");  // kept for its violation, and in its place
  ASSERT_NE(violating, std::string::npos);
  EXPECT_LT(page.find("| 42 % | 0 s |"), violating);
  EXPECT_EQ(nlohmann::json::parse(render("json", input))["cells"].size(), 500u);
}

TEST(Report, names_from_outside_cannot_break_the_page) {
  auto campaign = campaign_of("claim", 1);
  campaign.name = "a|b\n<script>\x1b[31m\xff";
  const auto input = report_of(campaign, grid({"ag|ent`"}, {0.4}, {2.0}), {}, [](RunRecord& run) {
    run.outcome.crash = true;
    run.outcome.message = "line one\nline two\x1b[0m";
  });
  const auto text = render("text", input);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_THAT(std::regex_replace(text, std::regex("\n +"), " "), HasSubstr("line one\\nline two"));
  const auto markdown = render("markdown", input);
  EXPECT_EQ(markdown.find("<script>"), std::string::npos);
  EXPECT_THAT(markdown, HasSubstr("ag\\|ent\\`"));
  EXPECT_TRUE(nlohmann::json::accept(render("json", input)));
}

// Every name in an archive may be hostile: the page keeps its lines and columns, and no character steers a terminal.
TEST(Report, hostile_names_change_no_line_of_any_format) {
  const auto page = [](const std::string& format, const std::string& name) {
    auto campaign = campaign_of("claim", 3);
    campaign.name = name;
    campaign.engine.libraries = name;
    campaign.required_probes = {name};
    campaign.plugin_agents = {name};
    campaign.exempt_pairs = {name};
    auto gate = gate_of(name, GateKind::None, Region::Contract, 1e-3);
    gate.name = name;
    auto nowhere = gate_of(name + "2", GateKind::None, Region::Contract, 1e-3);
    auto input = report_of(campaign, grid({name}, {0.4}, {2.0}, {name}), {gate, nowhere}, [&](RunRecord& run) {
      run.outcome.crash = true;
      run.outcome.message = name;
      run.outcome.probes = {{ProbeSource::Agent, name, 1}};
    });
    input.archive_path = name + ".fp";
    return render(format, input);
  };
  const std::string hostile =
      "-\x1b[2J\n`$(id)`|<b>\xc2\x9b\xe2\x80\xae\xff";  // fewer characters than any limit of a page
  for (const auto* format : {"text", "summary", "markdown", "junit", "json"}) {
    const auto text = page(format, hostile);
    EXPECT_EQ(printable_lines(text), text) << format;
    if (std::string(format) == "json" || std::string(format) == "markdown") {
      EXPECT_EQ(lines_of(text).size(), lines_of(page(format, "plain")).size()) << text;
    }
  }
}

TEST(Report, markdown_shows_names_as_they_are) {
  auto campaign = campaign_of("claim", 1);
  campaign.name = "a|b <i>&lt; [x](y) *z* _w_ ~q~ $m$ `c` \\";
  const auto page = render("markdown", report_of(campaign, grid({"sound"}, {0.4}, {2.0}), {}));
  EXPECT_THAT(page, HasSubstr("a\\|b &lt;i>&amp;lt; \\[x\\](y) \\*z\\* \\_w\\_ \\~q\\~ \\$m\\$ \\`c\\` \\\\"));
}

TEST(Report, the_replay_line_survives_a_shell) {
  EXPECT_EQ(replay_command("out/night.fp", 7), "fleetproof replay out/night.fp 7");
  EXPECT_EQ(replay_command("$(touch x).fp", 7), "fleetproof replay '$(touch x).fp' 7");
  EXPECT_EQ(debug_command("a b.fp", 7), "gdb --args fleetproof replay 'a b.fp' 7 --in-process");
}

TEST(Report, clearances_round_towards_the_unsafe_side) {
  EXPECT_EQ(metres_text(99'999), "0.09 m");
  EXPECT_EQ(metres_text(100'000), "0.10 m");
  EXPECT_EQ(metres_text(-1), "-0.01 m");
  EXPECT_EQ(percent(0.4), "40 %");
  EXPECT_EQ(percent(0.125), "12.5 %");
  EXPECT_EQ(seconds_text(2.0), "2 s");
  EXPECT_EQ(seconds_text(0.255), "0.26 s");
}

TEST(Report, reads_an_archive_up_to_its_first_gap) {
  const samples::TemporaryFolder folder;
  const auto cells = grid({"sound"}, {0.4}, {1.0, 2.0});
  ArchiveWriter writer(folder / "night.fp",
                       {campaign_of("claim", 10), cells, {gate_of("sound", GateKind::None, Region::Contract, 1e-3)}});
  for (const std::uint64_t i : {0u, 1u, 2u, 3u, 5u}) writer.add(samples::clean_run(i, 2));
  writer.publish(20);
  const auto input = read_report_input(ArchiveReader(folder / "night.fp"), "typed.fp");
  EXPECT_EQ(input.stored_runs, 5u);
  EXPECT_EQ(input.evidence.runs(), 4u);
  EXPECT_EQ(input.evidence.complete_replicates(), 2u);
  EXPECT_EQ(conclusion_of(input), Conclusion::NotDemonstrated);
  EXPECT_THAT(render("text", input), HasSubstr("archive: typed.fp"));
}

TEST(Report, what_is_not_sealed_demonstrates_nothing) {
  const samples::TemporaryFolder folder;
  const auto cells = grid({"sound"}, {0.4}, {1.0, 2.0});
  const StoredPlan plan{campaign_of("claim", 60), cells, {gate_of("sound", GateKind::Rate, Region::Contract, 0.5)}};
  ArchiveWriter writer(folder / "night.fp", plan);
  for (std::uint64_t i = 0; i < 120; ++i) {
    RunRecord run = samples::clean_run(i, 2);
    run.outcome.digest = i + 1;
    writer.add(run);
  }
  writer.commit();
  const auto live = read_report_input(ArchiveReader(folder / "night.fp.partial"), "night.fp.partial");
  EXPECT_EQ(conclusion_of(live), Conclusion::NotDemonstrated);
  EXPECT_THAT(render("text", live), HasSubstr("the campaign is not at an end, and its file not sealed"));
  writer.publish(120);
  const auto sealed = read_report_input(ArchiveReader(folder / "night.fp"), "night.fp");
  EXPECT_EQ(conclusion_of(sealed), Conclusion::Demonstrated) << sealed.gates[0].reason;
}

TEST(Report, a_campaign_that_is_not_complete_says_so_in_its_title) {
  const auto cells = grid({"sound"}, {0.4}, {1.0, 2.0});
  const std::vector<GateRecord> gates{gate_of("sound", GateKind::Rate, Region::Contract, 1e-2)};
  const auto fail_once = [](RunRecord& run) {
    if (run.run_index == 7) samples::violate(run);
  };
  const auto stopped = report_of(campaign_of("claim", 3000), cells, gates, fail_once, 0, 3);
  const auto whole = report_of(campaign_of("claim", 3000), cells, gates, fail_once);
  for (const auto* format : {"text", "summary", "markdown"}) {
    const auto lines = lines_of(render(format, stopped));
    EXPECT_THAT(lines[0], HasSubstr("INCOMPLETE: 2998 of 3000 planned replicates")) << format;
    EXPECT_THAT(lines[2], HasSubstr("violation")) << format;  // what was seen still heads the page
    auto page = render(format, stopped);
    std::ranges::replace(page, '\n', ' ');
    EXPECT_THAT(page, HasSubstr("stopped after 2998 of 3000 planned replicates")) << format;
    EXPECT_THAT(render(format, whole), Not(HasSubstr("INCOMPLETE"))) << format;
  }
  EXPECT_EQ(nlohmann::json::parse(render("json", stopped))["complete"], false);
  EXPECT_EQ(nlohmann::json::parse(render("json", stopped))["verdict"], "not demonstrated");
  EXPECT_EQ(nlohmann::json::parse(render("json", whole))["complete"], true);
  EXPECT_EQ(nlohmann::json::parse(render("json", whole))["verdict"], "demonstrated");
}

TEST(Report, every_format_renders_an_empty_campaign) {
  const auto input = report_of(campaign_of("claim", 0), grid({"sound"}, {0.4}, {2.0}),
                               {gate_of("sound", GateKind::None, Region::Contract, 1e-3)});
  for (const auto& format : report_formats()) {
    EXPECT_FALSE(format.description.empty());
    EXPECT_THAT(format.make(input), HasSubstr("no replicate is complete")) << format.name;
  }
}

}  // namespace
}  // namespace fleetproof::report_test
