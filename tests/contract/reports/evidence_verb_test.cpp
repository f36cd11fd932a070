// Every estimator through the program: its figures, its list of methods, and what it refuses.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/reference_table.hpp"

namespace fleetproof::evidence_verb_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

class EvidenceVerb : public test::ProgramTest {
 protected:
  Json figures(const std::string& words) const {
    const auto finished = run("evidence " + words + " --json");
    EXPECT_EQ(finished.exit_code, 0) << words << finished.err;
    return Json::parse(finished.out);
  }
  void expect_refused(const std::string& words, const std::string& error) const {
    const auto finished = run("evidence " + words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    EXPECT_EQ(finished.out, "") << words;
    EXPECT_THAT(finished.err, HasSubstr(error)) << words;
    EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
  }
};

// A table in tests/vectors, the method that it belongs to, and the columns that are arguments.
struct Checked {
  std::string table, method;
  std::vector<std::pair<std::string, std::string>> arguments;
};
const std::vector<Checked> kChecked = {
    {"clopper_pearson", "clopper-pearson", {{"failing", "k"}, {"units", "n"}, {"confidence", "confidence"}}},
    {"zero_failure_bound", "zero-failure-bound", {{"units", "n"}, {"confidence", "confidence"}}},
    {"zero_failure_plan", "zero-failure-plan", {{"limit", "p_limit"}, {"confidence", "confidence"}}},
    {"acceptance_plan",
     "acceptance-plan",
     {{"limit", "p_limit"}, {"confidence", "confidence"}, {"failing", "accept_if_failures_at_most"}}},
    {"garwood", "garwood", {{"events", "k"}, {"exposure", "exposure"}, {"confidence", "confidence"}}},
    {"hours_needed", "hours-needed", {{"limit", "rate_limit_per_hour"}, {"confidence", "confidence"}}},
    {"cs_beta_binomial",
     "beta-binomial-sequence",
     {{"prior-a", "prior_a"}, {"prior-b", "prior_b"}, {"alpha", "alpha"}, {"failing", "k"}, {"units", "n"}}},
    {"cs_gamma_poisson",
     "gamma-poisson-sequence",
     {{"prior-shape", "prior_shape"},
      {"prior-rate", "prior_rate"},
      {"alpha", "alpha"},
      {"events", "events"},
      {"exposure", "exposure"}}},
    {"eprocess_gate", "release-gate", {{"limit", "p_limit"}, {"failing", "k"}, {"units", "n"}}},
    {"gate_runs_needed", "gate-runs-needed", {{"limit", "p_limit"}, {"alpha", "alpha"}, {"failing", "failures_seen"}}},
    {"fisher", "fisher", {{"failing1", "k1"}, {"units1", "n1"}, {"failing2", "k2"}, {"units2", "n2"}}},
    {"mcnemar", "mcnemar", {{"only-old", "b_only_old_violates"}, {"only-new", "c_only_new_violates"}}},
    {"paired_difference",
     "paired-difference",
     {{"both", "both"},
      {"only-old", "only_old"},
      {"only-new", "only_new"},
      {"neither", "neither"},
      {"confidence", "confidence"}}},
    {"poisson_rate_ratio",
     "poisson-rate-ratio",
     {{"events1", "k1"}, {"exposure1", "T1"}, {"events2", "k2"}, {"exposure2", "T2"}, {"confidence", "confidence"}}},
    {"stratified_zero_failure",
     "stratified-zero-failure",
     {{"weights", "weights"}, {"units", "runs_per_stratum"}, {"alpha", "alpha"}}},
};

// The last row of every table: the words reach the right arguments, and the figures their names.
TEST_F(EvidenceVerb, PrintsTheFiguresOfEveryTable) {
  for (const Checked& checked : kChecked) {
    const auto row = test::reference_rows(checked.table).back();
    std::string words = checked.method;
    for (const auto& [option, column] : checked.arguments) words += " --" + option + " '" + row.text(column) + "'";
    const Json json = figures(words);
    EXPECT_EQ(json["method"], checked.method);
    std::size_t compared = 0;
    for (const auto& [name, figure] : json.items()) {
      if (!row.knows(name) || !figure.is_number()) continue;
      test::expect_close(figure.get<double>(), row, name);
      ++compared;
    }
    EXPECT_GE(compared, 2U) << words;
  }
}

TEST_F(EvidenceVerb, PrintsSeventeenDigitsOrOneFigurePerLine) {
  const auto json = run("evidence clopper-pearson --failing 3 --units 1000 --confidence 0.95 --json");
  EXPECT_THAT(json.out, HasSubstr("\"two_sided_lower\": 0.00061909993164957131,"));
  const auto text = run("evidence clopper-pearson --failing 3 --units 1e3");
  EXPECT_THAT(text.out, HasSubstr("two_sided_lower  0.0006190999316\n"));
  EXPECT_EQ(std::ranges::count(text.out, '\n'), 4);
}

TEST_F(EvidenceVerb, ListsEveryMethodWithItsArguments) {
  const Json json = figures("");
  const auto text = run("evidence");
  ASSERT_GE(json["methods"].size(), 20U);
  for (const Json& method : json["methods"]) {
    EXPECT_THAT(text.out, HasSubstr(method["name"].get<std::string>() + "\n"));
    EXPECT_THAT(text.out, HasSubstr(method["usage"].get<std::string>()));
    // Without arguments each names the first that is missing.
    expect_refused(method["name"], "evidence " + method["name"].get<std::string>() + ": --");
  }
}

TEST_F(EvidenceVerb, AnEnvelopeHasARowForEachCell) {
  const Json json = figures("envelope --failing '0,0/0,9' --units '6000,6000/6000,6000' --limit 1e-3 --path 0:0,1:1");
  ASSERT_EQ(json["rows"].size(), 4U);
  EXPECT_EQ(json["rows"][2]["loss_index"], 1);
  EXPECT_EQ(json["rows"][2]["delay_index"], 0);
  EXPECT_EQ(json["rows"][2]["claim_antichain_2"], true);
  EXPECT_EQ(json["rows"][3]["claim_antichain_2"], false);
  EXPECT_EQ(json["rows"][0]["claim_fixed_sequence_staircase"], true);
  EXPECT_EQ(json["rows"][3]["claim_fixed_sequence_staircase"], false);
  EXPECT_FALSE(json["rows"][1].contains("claim_fixed_sequence_staircase"));
}

TEST_F(EvidenceVerb, OtherMethodsHaveTheirFigures) {
  EXPECT_EQ(figures("gate-table --failing 3 --limit 1e-3")["rows"][3]["anytime_gate_e"], 10660);
  EXPECT_NEAR(figures("gate-operating-characteristic --limit 1e-3 --true-rate 1e-4 --cap 5000")["pass_prob_gate_e_95"],
              0.713040604681177, 1e-12);
  EXPECT_NEAR(figures("clusters --failing 5,0,5,0 --units 5,5,5,5")["effective_runs"], 3.0, 1e-12);
  EXPECT_TRUE(figures("clusters --failing 0,0 --units 5,5")["design_effect"].is_null());
  EXPECT_NEAR(figures("incident-dispersion --events 12,0,0,0 --exposure 2,2,2,2")["dispersion"], 12.0, 1e-12);
  EXPECT_TRUE(figures("poisson-rate-ratio --events1 3 --exposure1 1 --events2 0 --exposure2 1")["upper"].is_null());
}

// The largest numbers that are allowed: an answer, soon.
TEST_F(EvidenceVerb, AnswersAtTheEndsOfItsRanges) {
  const std::string risks = " --alpha 1e-15";
  for (const std::string words :
       {"clopper-pearson --failing 1e9 --units 1e15", "clopper-pearson --failing 1e9 --units 1e9",
        "garwood --events 1e9 --exposure 1e18", "garwood --events 1e9 --exposure 1e-15",
        "hours-needed --limit 1e-15 --events 1e9", "beta-binomial-sequence --failing 1 --units 1e15 --prior-a 1e6",
        "gamma-poisson-sequence --events 1e9 --exposure 1e-15 --prior-shape 1e-9",
        "release-gate --failing 1e9 --units 1e15 --limit 1e-15", "gate-runs-needed --failing 1e9 --limit 0.9",
        "gate-operating-characteristic --limit 1e-3 --true-rate 0.5 --cap 2e5",
        "poisson-rate-ratio --events1 1e9 --exposure1 1e18 --events2 1e9 --exposure2 1e-15",
        "stratified-zero-failure --weights 0,1 --units 0,1e15",
        "paired-difference --both 1e15 --only-old 1e9 --only-new 0 --neither 1e15"})
    EXPECT_EQ(figures(words + risks)["schema_version"], 1);
  EXPECT_EQ(figures("mcnemar --only-old 1e9 --only-new 1")["p_exact_two_sided"], 0.0);
  EXPECT_EQ(figures("fisher --failing1 1e9 --units1 1e15 --failing2 0 --units2 1e15")["p_two_sided"], 0.0);
}

TEST_F(EvidenceVerb, RefusesWhatMakesNoSense) {
  expect_refused("clopper-pearsn", "\"clopper-pearsn\" is not a method; did you mean \"clopper-pearson\"?");
  const std::string clopper = "clopper-pearson --units 1000 ";
  expect_refused(clopper, "evidence clopper-pearson: --failing is missing; usage: --failing FAILING --units UNITS");
  expect_refused(clopper + "--failing -3",
                 "--failing: \"-3\" is refused; allowed: a whole number from 0 to 1000000000");
  expect_refused(clopper + "--failing 1.5", "--failing: \"1.5\" is refused; allowed: a whole number");
  expect_refused(clopper + "--failing nan", "--failing: \"nan\" is refused");
  expect_refused(clopper + "--failing 1001", "--failing: \"1001\" is refused; allowed: at most the 1000 of --units");
  expect_refused(clopper + "--failing 1 --confidence 1", "--confidence: \"1\" is refused; allowed: a number from");
  expect_refused(clopper + "--failing 1 --confidence 0.95 --alpha 0.05", "--alpha: says the same as --confidence");
  expect_refused(clopper + "--failing 1 --exposure 3", "--exposure \"3\" is no argument of this method; usage: ");
  expect_refused(clopper + "--failing 1 --unit 3", "did you mean \"--units\"?");
  expect_refused("zero-failure-bound --units 0", "--units: \"0\" is refused; allowed: a whole number from 1");
  expect_refused("garwood --events 1 --exposure 0", "--exposure: \"0\" is refused; allowed: a number from 1e-15");
  expect_refused("beta-binomial-sequence --failing 0 --units 3 --prior-a 1e9", "allowed: a number from 1e-09 to 1e+06");
  expect_refused("paired-difference --both 0 --only-old 0 --only-new 0 --neither 0", "a difference needs pairs");
  expect_refused("stratified-zero-failure --weights 0.5,0.4 --units 1,2", "weights with the sum 1, not 0.9");
  expect_refused("stratified-zero-failure --weights 0.5,0.5 --units 1,2,3", "--units: names 3 values where");
  expect_refused("envelope --failing 0,0/0 --units 1,1/1,1 --limit 0.1", "rows of one length");
  expect_refused("envelope --failing 0,2 --units 1,1 --limit 0.1",
                 "--failing: \"2\" is refused; allowed: at most the 1");
  expect_refused("envelope --failing 0,0 --units 1,1 --limit 0.1 --path 1:0", "--path: \"1\" is refused");
  expect_refused("gate-operating-characteristic --limit 0.5 --true-rate 0.1 --cap 1e6", "--cap: 1000000 is refused");
}

}  // namespace
}  // namespace fleetproof::evidence_verb_test
