// JUnit XML, validated as Jenkins and GitLab read it.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"
#include "tests/support/synthetic_archive.hpp"

namespace fleetproof::junit_schema_test {
namespace {

using samples::campaign_of;
using samples::gates_of_every_kind;
using samples::grid;

class JUnitSchema : public test::ProgramTest {
 protected:
  test::Finished validated(const std::string& file, const std::string& dialect) const {
    return shell("xmllint --noout --nonet --schema '" +
                 test::source("tests/contract/reports/junit/" + dialect + ".xsd") + "' " + file);
  }
  void expect_valid(const std::string& archive) const {
    const auto report = run("report " + archive + " --format junit --exit-zero -o j.xml");
    ASSERT_EQ(report.exit_code, 0) << report.err;
    for (const char* dialect : {"jenkins", "gitlab"}) {
      const auto finished = validated("j.xml", dialect);
      EXPECT_EQ(finished.exit_code, 0) << dialect << finished.err << read(path("j.xml"));
    }
    std::filesystem::remove(path("j.xml"));
  }
};

TEST_F(JUnitSchema, EverySizeOfCampaign) {
  const auto cells = grid({"sound"}, {0.0, 0.4}, {1.0, 2.0}, {"ring", "cross"});
  for (const std::uint64_t runs : {0, 1, 400}) {
    const std::string name = std::to_string(runs) + ".db";
    samples::write_archive(path(name), campaign_of("claim", 50), cells, gates_of_every_kind("sound", "ring"), runs,
                           0.3);
    expect_valid(name);
  }
  samples::write_archive(path("none.db"), campaign_of("claim", 5), cells, {}, 40, 0.3);
  expect_valid("none.db");
  samples::write_archive(path("s.db"), campaign_of("search", 5), cells, gates_of_every_kind("sound", "ring"), 40, 0.3);
  expect_valid("s.db");
}

TEST_F(JUnitSchema, DefaultGatesOfACampaignThatWasRun) {
  write("a.toml",
        "replicates = 4\nhorizon_s = 60\n[factors]\nagents = [\"reckless\", { agent = \"hull-lock\", role = "
        "\"candidate\" }]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n");
  run("run a.toml --db a.db");
  expect_valid("a.db");
}

TEST_F(JUnitSchema, NamesThatAnAttackerChooses) {
  const std::string hostile = "]]></system-out><failure/>\"'&<b>\x1b[2J\xc2\x9b\xe2\x80\xae\xff\xef\xbf\xbf";
  auto campaign = campaign_of("claim", 5);
  campaign.name = hostile;
  auto gates = gates_of_every_kind(hostile, hostile);
  for (auto& gate : gates) gate.name += gate.requirement = hostile;
  samples::write_archive(path("h.db"), campaign, grid({hostile}, {0.4}, {1.0, 2.0}, {hostile}), gates, 10, 0.5);
  expect_valid("h.db");
}

// The control: what each reader refuses or drops.
TEST_F(JUnitSchema, FindsWhatIsWrong) {
  const std::string head = "<testsuites><testsuite name=\"a\" tests=\"1\" failures=\"0\" errors=\"0\">";
  const auto refused = [&](const std::string& cases, const std::string& dialect) {
    write("bad.xml", head + cases + "</testsuite></testsuites>");
    EXPECT_EQ(validated("bad.xml", dialect).exit_code, 3) << dialect << cases;
  };
  write("good.xml", head + "<testcase name=\"x\" classname=\"y\" time=\"1.000\"/></testsuite></testsuites>");
  EXPECT_EQ(validated("good.xml", "jenkins").exit_code, 0);
  EXPECT_EQ(validated("good.xml", "gitlab").exit_code, 0);
  refused("<testcase name=\"x\" classname=\"y\" time=\"1e3\"/>", "jenkins");
  refused("<testcase name=\"x\" classname=\"y\" time=\"1\" file=\"z\"/>", "jenkins");
  refused("<testcase classname=\"y\" time=\"1\"/>", "jenkins");
  refused("<testcase name=\"x\" classname=\"y\" time=\"1\"><note/></testcase>", "jenkins");
  refused("<testcase name=\"x\" classname=\"y\" time=\"1e3\"/>", "gitlab");
  refused("<testcase name=\"x\" classname=\"\" time=\"1\"/>", "gitlab");
  refused("<testcase name=\"x\" classname=\"y\" time=\"1\"><failure/></testcase>", "gitlab");
  refused("<testcase name=\"x\" classname=\"y\" time=\"1\"/><testcase name=\"x\" classname=\"y\" time=\"1\"/>",
          "gitlab");
}

}  // namespace
}  // namespace fleetproof::junit_schema_test
