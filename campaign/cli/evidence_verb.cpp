#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/cli/evidence/evidence_methods.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof::cli {
namespace {

struct EvidenceWords {
  std::string method;
  std::map<std::string, std::string> given;  // every argument of every method; empty if it was not given
  bool json = false;
};

struct MethodArgument {
  std::string name;
  bool may_be_left_out = false;
};

// "failing units [confidence]" as a list. What takes a confidence takes a risk instead.
std::vector<MethodArgument> arguments_of(const EvidenceMethod& method) {
  std::vector<MethodArgument> arguments;
  std::string_view rest = method.arguments;
  while (!rest.empty()) {
    std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    const bool optional = word.starts_with('[');
    if (optional) word = word.substr(1, word.size() - 2);
    arguments.push_back({std::string(word), optional});
    if (word == "confidence") arguments.push_back({"alpha", true});
  }
  return arguments;
}

// "--failing FAILING --units UNITS [--confidence CONFIDENCE | --alpha ALPHA]"
std::string usage_of(const EvidenceMethod& method) {
  std::string usage;
  for (const MethodArgument& argument : arguments_of(method)) {
    const bool instead = argument.name == "alpha";
    if (instead) usage.pop_back();
    std::string value = argument.name;
    for (char& c : value) c = c == '-' ? '_' : static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    if (!usage.empty()) usage += instead ? " | " : " ";
    if (argument.may_be_left_out && !instead) usage += "[";
    usage += "--" + argument.name + " " + value;
    if (argument.may_be_left_out) usage += "]";
  }
  return usage;
}

int list_methods(bool json) {
  std::string text =
      "usage: fleetproof evidence METHOD ARGUMENTS [--json]; the arguments: fleetproof evidence --help\n";
  Json all = Json::array();
  for (const EvidenceMethod& method : evidence_methods()) {
    if (json) {
      all.push_back({{"name", method.name}, {"description", method.description}, {"usage", usage_of(method)}});
    } else {
      text += fmt::format("\n{}\n    {}\n    {}\n", method.name, method.description, usage_of(method));
    }
  }
  put_text(json ? json_text({{"schema_version", 1}, {"methods", all}}, 2) + "\n" : text);
  return kDemonstrated;
}

EvidenceMethod method_named(const std::string& name) {
  const auto methods = evidence_methods();
  std::vector<std::string_view> names;
  for (const EvidenceMethod& method : methods) {
    if (method.name == name) return method;
    names.push_back(method.name);
  }
  throw InputError("evidence", fmt::format("{} is not a method{}", in_quotes(name), name_hint(name, names)));
}

// What was given, if the method takes all of it and misses none.
std::map<std::string, std::string> given_to(const EvidenceMethod& method, const EvidenceWords& words) {
  std::map<std::string, std::string> given;
  for (const auto& [name, word] : words.given) {
    if (!word.empty()) given[name] = word;
  }
  std::map<std::string, std::string> superfluous = given;
  for (const MethodArgument& argument : arguments_of(method)) {
    superfluous.erase(argument.name);
    if (!argument.may_be_left_out && !given.contains(argument.name)) {
      throw InputError(fmt::format("evidence {}", method.name),
                       fmt::format("--{} is missing; usage: {}", argument.name, usage_of(method)));
    }
  }
  if (!superfluous.empty()) {
    throw InputError(fmt::format("evidence {}", method.name),
                     fmt::format("--{} {} is no argument of this method; usage: {}", superfluous.begin()->first,
                                 in_quotes(superfluous.begin()->second), usage_of(method)));
  }
  return given;
}

int evidence(const EvidenceWords& words) {
  if (words.method.empty()) return list_methods(words.json);
  const EvidenceMethod method = method_named(words.method);
  const auto given = given_to(method, words);
  const Figures figures = method.compute(EvidenceInput(given));
  if (!words.json) {
    put_text(figures.text());
    return kDemonstrated;
  }
  put_text(
      printable_json(fmt::format("{{\n  \"schema_version\": 1,\n  \"method\": \"{}\",\n  \"arguments\": {},\n{}\n}}\n",
                                 method.name, json_text(SortedJson(given)), figures.json_members("  "))));
  return kDemonstrated;
}

}  // namespace

Action prepare_evidence(Options& options) {
  auto words = std::make_shared<EvidenceWords>();
  options.optional_positional("METHOD", words->method,
                              "which figure (without it: a list of all, with their arguments)");
  for (const EvidenceArgument& argument : evidence_arguments()) {
    const std::string name(argument.name);
    options.option("--" + name, words->given[name], std::string(argument.text));
  }
  options.flag("--json", words->json, "print JSON, with 17 significant digits");
  return [words] { return evidence(*words); };
}

}  // namespace fleetproof::cli
