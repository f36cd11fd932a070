#include "campaign/cli/manual.hpp"

#include <fmt/format.h>

#include <memory>
#include <vector>

namespace fleetproof::cli {
namespace {

struct Said {
  std::string names;  // as it is declared: "-o,--output"
  std::string help;
  bool is_positional = false, takes_value = true;
};

// Writes down what a verb declares, in place of a parser.
class Listener final : public Options {
 public:
  void positional(const std::string& name, std::string&, const std::string& help) override { position(name, help); }
  void positional(const std::string& name, std::uint64_t&, const std::string& help) override { position(name, help); }
  void optional_positional(const std::string& name, std::string&, const std::string& help) override {
    position(fmt::format("[{}]", name), help);
  }
  void positionals(const std::string& name, std::vector<std::string>&, const std::string& help) override {
    position(name + "...", help);
  }
  void option(const std::string& names, std::string&, const std::string& help) override { value(names, help); }
  void option(const std::string& names, std::optional<std::uint64_t>&, const std::string& help) override {
    value(names, help);
  }
  void option(const std::string& names, std::optional<double>&, const std::string& help) override {
    value(names, help);
  }
  void option(const std::string& names, std::vector<std::string>&, const std::string& help) override {
    value(names, help);
  }
  void flag(const std::string& names, bool&, const std::string& help) override {
    said.push_back({names, help, false, false});
  }

  std::vector<Said> said;

 private:
  void position(const std::string& name, const std::string& help) { said.push_back({name, help, true, true}); }
  void value(const std::string& names, const std::string& help) { said.push_back({names, help, false, true}); }
};

std::vector<Said> declared_by(const Verb& verb) {
  Listener listener;
  verb.prepare(listener);
  return std::move(listener.said);
}

// The names of an option, one by one.
std::vector<std::string> names_of(const Said& said) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= said.names.size();) {
    const std::size_t comma = std::min(said.names.find(',', from), said.names.size());
    names.push_back(said.names.substr(from, comma - from));
    from = comma + 1;
  }
  return names;
}

// Text for roff: no character has a meaning of its own.
std::string roff(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if ((c == '.' || c == '\'') && escaped.empty()) {
      escaped += fmt::format("\\&{}", c);
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string quoted_for_zsh(std::string_view text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted;
}

}  // namespace

std::string man_page(std::span<const Verb> verbs, std::string_view version) {
  std::string page = fmt::format(
      ".TH FLEETPROOF 1 \"\" \"fleetproof {}\" \"User commands\"\n.SH NAME\nfleetproof \\- test campaigns for AGV "
      "control software\n.SH SYNOPSIS\n.B fleetproof\n.I verb\n.RI [ options ]\n.SH DESCRIPTION\nHow often is the "
      "10 cm safety distance broken when messages are lost and late?\n.SH VERBS\n",
      roff(version));
  for (const Verb& verb : verbs) {
    page += fmt::format(".SS {}\n{}.\n", roff(verb.name), roff(verb.description));
    for (const Said& said : declared_by(verb)) {
      page += fmt::format(".TP\n.{} \"{}\"\n{}\n", said.is_positional ? "I" : "B", roff(said.names), roff(said.help));
    }
    page += fmt::format(".PP\nExample:\n.EX\n{}\n.EE\n", roff(verb.example));
  }
  return page + ".SH EXIT STATUS\n" + exit_codes_text() + ".\n";
}

std::string bash_completion(std::span<const Verb> verbs) {
  std::string names, cases;
  for (const Verb& verb : verbs) {
    names += fmt::format("{}{}", names.empty() ? "" : " ", verb.name);
    std::string options = "--help";
    for (const Said& said : declared_by(verb)) {
      if (said.is_positional) continue;
      for (const std::string& name : names_of(said)) options += " " + name;
    }
    cases += fmt::format("    {}) options=\"{}\" ;;\n", verb.name, options);
  }
  return fmt::format(
      "_fleetproof() {{\n  local word=\"${{COMP_WORDS[COMP_CWORD]}}\" options=\"\"\n  if ((COMP_CWORD == 1)); then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"{} --help --version\" -- \"$word\")\n    return\n  fi\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n{}  esac\n  if [[ \"$word\" == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n  else\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n  fi\n}}\n"
      "complete -o filenames -F _fleetproof fleetproof\n",
      names, cases);
}

std::string zsh_completion(std::span<const Verb> verbs) {
  std::string names, cases;
  for (const Verb& verb : verbs) {
    names += fmt::format("    '{}:{}'\n", verb.name, quoted_for_zsh(verb.description));
    cases += fmt::format("    {})\n      _arguments", verb.name);
    for (const Said& said : declared_by(verb)) {
      if (said.is_positional) continue;
      for (const std::string& name : names_of(said)) {
        cases += fmt::format(" \\\n        '{}[{}]{}'", name, quoted_for_zsh(said.help),
                             said.takes_value ? ":value:_files" : "");
      }
    }
    cases += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return fmt::format(
      "#compdef fleetproof\n_fleetproof() {{\n  local -a verbs=(\n{}  )\n  if ((CURRENT == 2)); then\n"
      "    _describe verb verbs\n    return\n  fi\n  local verb=$words[2]\n  shift words\n  ((CURRENT--))\n"
      "  case $verb in\n{}  esac\n}}\n_fleetproof \"$@\"\n",
      names, cases);
}

}  // namespace fleetproof::cli
