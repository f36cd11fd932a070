// Reports of several campaigns against the published schema, by a validator of the few words that the schema uses.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::report_schema_test {
namespace {

using Json = nlohmann::json;

class Validator {
 public:
  explicit Validator(Json root) : root_(std::move(root)) {}

  std::vector<std::string> faults(const Json& value) const { return faults(root_, value, "$"); }

 private:
  using Faults = std::vector<std::string>;

  static bool is_of(const Json& value, const std::string& type) {
    if (type == "null") return value.is_null();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    return type == "array" ? value.is_array() : type == "object" && value.is_object();
  }

  Faults faults(const Json& schema, const Json& value, const std::string& place) const {
    if (schema.contains("$ref"))
      return faults(root_.at(Json::json_pointer(schema.at("$ref").get<std::string>().substr(1))), value, place);
    if (schema.contains("anyOf")) {
      Faults best{place + " fits nothing"};
      for (const Json& choice : schema.at("anyOf")) {
        best = faults(choice, value, place);
        if (best.empty()) return {};
      }
      return best;
    }
    if (schema.contains("const")) return schema.at("const") == value ? Faults{} : Faults{place + " differs"};
    if (schema.contains("enum")) {
      for (const Json& word : schema.at("enum"))
        if (word == value) return {};
      return {place + " is " + value.dump()};
    }
    const Json& type = schema.at("type");
    const bool fits = type.is_array() ? std::ranges::any_of(type, [&](const Json& t) { return is_of(value, t); })
                                      : is_of(value, type);
    if (!fits) return {place + " is " + value.dump().substr(0, 40)};
    Faults found;
    const auto add = [&](const Faults& more) { found.insert(found.end(), more.begin(), more.end()); };
    if (value.is_object()) {
      for (const Json& key : schema.at("required"))
        if (!value.contains(key.get<std::string>())) found.push_back(place + " lacks " + key.dump());
      for (const auto& [key, inner] : value.items()) {
        if (schema.at("properties").contains(key)) {
          add(faults(schema.at("properties").at(key), inner, place + "." + key));
        } else {
          found.push_back(place + " has " + key);
        }
      }
    }
    if (value.is_array()) {
      for (const Json& inner : value) add(faults(schema.at("items"), inner, place + "[]"));
    }
    return found;
  }

  Json root_;
};

class ReportSchema : public test::ProgramTest {
 protected:
  void campaign(const std::string& kind, const std::string& agents, const std::string& more) {
    write("c.toml", "kind = \"" + kind + "\"\nreplicates = 8\nhorizon_s = 200\n[factors]\nagents = [" + agents +
                        "]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0.0, 0.5]\ndelay_s = [2]\n" + more);
    run("run c.toml --db c.db --overwrite");
  }
  Json report() { return Json::parse(run("report c.db --format json").out); }
  const Validator& validator() {
    static const Validator made(Json::parse(run("list report-schema").out));
    return made;
  }
};

TEST_F(ReportSchema, FitsClaimsSearchesAndWhatIsIncomplete) {
  for (const auto& [kind, agents, more] :
       {std::tuple{"claim", "\"reckless\", \"hull-lock\"", "[faults]\nload_drops_per_transport = 0.5\n"},
        {"claim", "\"reckless\"",
         "[[gate]]\nagent = \"reckless\"\nfleet_size = 4\nloss = 0.5\ndelay_s = 2\nmean_outage_s = 0\n"},
        {"claim", "\"reckless\"", "[[gate]]\nagent = \"reckless\"\nunit = \"agv-hour\"\nlimit = 0.001\n"},
        {"claim", "\"timeout-grant\"", "[law]\nexempt_purposes = [\"charging\"]\nexempt_radius_m = 2\n"},
        {"search", "\"reckless\"", ""}}) {
    campaign(kind, agents, more);
    EXPECT_THAT(validator().faults(report()), testing::IsEmpty()) << kind << agents;
  }
  run("run c.toml --db c.db --overwrite --fail-fast 1");
  EXPECT_THAT(validator().faults(report()), testing::IsEmpty());
}

TEST_F(ReportSchema, RefusesWhatDoesNotFit) {
  campaign("claim", "\"reckless\"", "");
  const Json good = report();
  Json bad = good;
  bad["surprise"] = 1;
  EXPECT_THAT(validator().faults(bad), testing::ElementsAre("$ has surprise"));
  bad = good;
  bad["campaign"].erase("seed");
  EXPECT_THAT(validator().faults(bad), testing::ElementsAre("$.campaign lacks \"seed\""));
  bad = good;
  bad["cells"][0]["runs"] = "many";
  EXPECT_THAT(validator().faults(bad), testing::ElementsAre("$.cells[].runs is \"many\""));
  bad = good;
  bad["verdict"] = "perhaps";
  EXPECT_EQ(validator().faults(bad).size(), 1U);
}

}  // namespace
}  // namespace fleetproof::report_schema_test
