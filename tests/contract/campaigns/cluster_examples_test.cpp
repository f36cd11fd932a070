// The examples for job engines: their own commands, with the variables that these engines set.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include "tests/contract/campaigns/sharded_campaign.hpp"

namespace fleetproof::cluster_examples_test {
namespace {

class ClusterExamples : public test::ShardedCampaign {
 protected:
  ClusterExamples() = default;
  static YAML::Node example(const std::string& name) {
    return YAML::LoadFile(std::string(FLEETPROOF_SOURCE_DIR) + "/tests/examples/cluster/" + name);
  }
  // The file of one machine; then a folder with a program of the name that the examples have.
  std::string prepare() {
    write_campaign("c.toml", 30);
    const std::string single = single_file();
    EXPECT_EQ(shell("mkdir bin && ln -s \"$FLEETPROOF\" bin/fleetproof && mv c.toml campaign.toml").exit_code, 0);
    return single;
  }
  // With nothing of the caller's environment.
  test::Finished task(const std::string& variables, const std::string& command) const {
    write("task.sh", command + "\n");
    return shell("env -i PATH=\"$PWD/bin:/usr/bin:/bin\" " + variables + " sh task.sh");
  }
  void expect_published(const test::Finished& finished) const { EXPECT_EQ(finished.exit_code, 0) << finished.err; }
  void expect_merged(const std::string& command, const std::string& single) const {
    EXPECT_EQ(task("", command).exit_code, single_code_);
    EXPECT_TRUE(read(path("night.db")) == single);
  }
};

std::string lines(const YAML::Node& script) {
  std::string text;
  for (const auto& line : script) text += line.as<std::string>() + "\n";
  return text;
}

TEST_F(ClusterExamples, GitLab) {
  const std::string single = prepare();
  const YAML::Node jobs = example("gitlab-ci.yml");
  const int count = jobs["shards"]["parallel"].as<int>();
  for (int index = 1; index <= count; ++index)
    expect_published(task("CI_NODE_INDEX=" + std::to_string(index) + " CI_NODE_TOTAL=" + std::to_string(count),
                          lines(jobs["shards"]["script"])));
  expect_merged(jobs["merge"]["script"][0].as<std::string>(), single);
  EXPECT_EQ(task("", jobs["merge"]["script"][1].as<std::string>()).exit_code, 0);
  EXPECT_FALSE(read(path("report.html")).empty());
}

TEST_F(ClusterExamples, GitHub) {
  const std::string single = prepare();
  const YAML::Node jobs = example("github-actions.yml")["jobs"];
  const std::string command = jobs["shards"]["steps"][1]["run"].as<std::string>(), place = "${{ matrix.shard }}";
  for (const auto& shard : jobs["shards"]["strategy"]["matrix"]["shard"]) {
    std::string own = command;
    own.replace(own.find(place), place.size(), shard.as<std::string>());
    expect_published(task("CI=true GITHUB_ACTIONS=true", own));
  }
  expect_merged(jobs["merge"]["steps"][1]["run"].as<std::string>(), single);
}

TEST_F(ClusterExamples, Kubernetes) {
  const std::string single = prepare();
  const YAML::Node job = example("kubernetes.yml")["spec"];
  std::string command;
  for (const auto& word : job["template"]["spec"]["containers"][0]["command"])
    command += "'" + word.as<std::string>() + "' ";
  for (int index = 0; index < job["completions"].as<int>(); ++index)
    expect_published(task("JOB_COMPLETION_INDEX=" + std::to_string(index), command));
  expect_merged("fleetproof merge shards --db night.db", single);
}

}  // namespace
}  // namespace fleetproof::cluster_examples_test
