#include "tests/architecture/source_outline.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace fleetproof::architecture {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool starts_with_any(const std::string& text, std::initializer_list<const char*> words) {
  return std::ranges::any_of(words, [&](const char* word) { return text.starts_with(word); });
}

// The text without comments, literals and directives; every line feed stays where it is.
class Stripped {
 public:
  explicit Stripped(const std::vector<std::string>& lines) {
    bool directive = false;
    for (const std::string& line : lines) {
      const auto first = line.find_first_not_of(' ');
      directive = directive || (first != std::string::npos && line[first] == '#' && state_ == State::Code);
      if (!directive) strip(line);
      directive = directive && line.ends_with('\\');
      text += '\n';
      if (state_ == State::Line) state_ = State::Code;
    }
  }

  std::string text;

 private:
  enum class State { Code, Line, Block, Raw };

  void strip(const std::string& line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (state_ == State::Code) {
        i = code(line, i);
      } else if (const std::string& end = state_ == State::Block ? kBlockEnd : raw_end_;
                 state_ != State::Line && line.compare(i, end.size(), end) == 0) {
        i += end.size() - 1;
        state_ = State::Code;
      }
    }
  }

  // Takes what begins at `i`; returns the place of its last character.
  std::size_t code(const std::string& line, std::size_t i) {
    const auto next = i + 1 < line.size() ? line[i + 1] : '\0';
    if (line[i] == '/' && (next == '/' || next == '*')) {
      state_ = next == '/' ? State::Line : State::Block;
      return i + 1;
    }
    const bool in_word = i > 0 && is_word(line[i - 1]);
    if (line[i] == '"' && in_word && line[i - 1] == 'R') {
      const auto open = line.find('(', i);
      raw_end_ = ")" + line.substr(i + 1, open - i - 1) + "\"";
      state_ = State::Raw;
      return open;
    }
    if (line[i] == '"' || (line[i] == '\'' && !in_word)) return literal(line, i);  // 10'000 is no character
    text += line[i];
    return i;
  }

  static std::size_t literal(const std::string& line, std::size_t i) {
    std::size_t end = i + 1;
    while (end < line.size() && line[end] != line[i]) end += line[end] == '\\' ? 2 : 1;
    return end;
  }

  const std::string kBlockEnd = "*/";
  State state_ = State::Code;
  std::string raw_end_;
};

// The head of a declaration without what stands between < and >, so that commas and parentheses are its own.
std::string without_template_arguments(const std::string& head) {
  std::string plain;
  int depth = 0;
  for (std::size_t i = 0; i < head.size(); ++i) {
    const bool arrow = head[i] == '>' && i > 0 && head[i - 1] == '-';
    if (head[i] == '<') ++depth;
    if (depth == 0) plain += head[i];
    if (head[i] == '>' && !arrow && depth > 0) --depth;
  }
  return plain;
}

// Where the list of initializers of a constructor begins; npos if there is none.
std::size_t initializers_of(const std::string& head) {
  static const std::regex pattern(R"(\)\s*(noexcept\s*)?:[^:])");
  std::smatch match;
  return std::regex_search(head, match, pattern) ? static_cast<std::size_t>(match.position()) : std::string::npos;
}

bool is_function_head(const std::string& head) {
  const bool op = head.find("operator") != std::string::npos;
  const std::string plain = op ? head : without_template_arguments(head);
  const auto parenthesis = plain.find('('), equals = plain.find('=');
  if (parenthesis == std::string::npos || plain.compare(parenthesis, 2, "(*") == 0) return false;
  return op || equals == std::string::npos || parenthesis < equals;
}

std::string without_template_line(const std::string& head) {
  if (!head.starts_with("template")) return head;
  int depth = 0;
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (head[i] == '<') ++depth;
    if (head[i] == '>' && --depth == 0) {
      const auto rest = head.find_first_not_of(' ', i + 1);
      return rest == std::string::npos ? "" : head.substr(rest);
    }
  }
  return head;
}

std::size_t data_declared_by(const std::string& head) {
  const std::string plain = without_template_arguments(head);
  std::size_t count = 1;
  int depth = 0;
  for (const char c : plain) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    count += c == ',' && depth == 0 ? 1 : 0;
  }
  return count;
}

// Constructors and destructors are no functions that a caller has to know.
void count_function(OutlinedClass& type, const std::string& head) {
  const bool constructs = head.starts_with(type.name + "(") || head.starts_with("explicit " + type.name + "(") ||
                          head.find("~" + type.name + "(") != std::string::npos;
  type.functions += constructs ? 0 : 1;
}

// The name before the parameters; empty for operators and for what is no name.
std::string name_in(const std::string& head) {
  if (head.find("operator") != std::string::npos) return {};
  static const std::regex attribute(R"(\[\[[^\]]*\]\])");
  const std::string plain = without_template_arguments(std::regex_replace(head, attribute, ""));
  auto end = plain.find('(');
  while (end > 0 && plain[end - 1] == ' ') --end;
  auto begin = end;
  while (begin > 0 && (is_word(plain[begin - 1]) || plain[begin - 1] == ':' || plain[begin - 1] == '~')) --begin;
  return plain.substr(begin, end - begin);
}

class Reader {
 public:
  Outline read(const std::string& text) {
    open_.push_back({Kind::Namespace, 0, 0, 0, {}});
    for (const char c : text) {
      take(c);
      if (c == '\n') ++line_;
    }
    return std::move(outline_);
  }

 private:
  enum class Kind { Namespace, Type, Function, Other };
  struct Open {
    Kind kind;
    std::size_t first_line, of_class;
    int parentheses;
    std::string head;
  };

  void take(char c) {
    if (c == '{') return begin();
    if (c == '}') return end();
    Open& here = open_.back();
    if (here.kind == Kind::Function || here.kind == Kind::Other) return;
    if (c == '(') ++here.parentheses;
    if (c == ')') --here.parentheses;
    if (c == ';' && here.parentheses == 0) return declaration();
    if (c == ':' && (head_ == "public" || head_ == "private" || head_ == "protected")) return head_.clear();
    const bool space = c == ' ' || c == '\n';
    if (head_.empty() && !space) head_line_ = line_;
    if (!space) head_ += c;
    if (space && !head_.empty() && head_.back() != ' ') head_ += ' ';
  }

  void begin() {
    const Kind kind = open_.back().parentheses > 0 ? Kind::Other : kind_of_block();
    Open opened{kind, head_line_, outline_.classes.size(), 0, head_};
    if (kind == Kind::Type) {
      static const std::regex pattern(R"((class|struct|union)\s+([A-Za-z_0-9:]*))");
      std::smatch match;
      const std::string head = without_template_line(head_);
      std::regex_search(head, match, pattern);
      outline_.classes.push_back({match[2], head_line_, 0, 0});
    }
    note_type();
    if (kind != Kind::Other) head_.clear();
    open_.push_back(opened);
  }

  // Of the block that begins, if it is one of a type. One that is declared in another and defined here has colons.
  void note_type() {
    static const std::regex pattern(R"(^(class|struct|union|enum|enum class) (\w+) ?(final )?(:[^:].*)?$)");
    std::smatch match;
    const std::string head = without_template_line(head_);
    if (is_function_head(head) || !std::regex_search(head, match, pattern)) return;
    NamedType type;
    for (const Open& open : open_) {
      if (open.kind != Kind::Namespace) return;
      if (!open.head.starts_with("namespace ")) continue;
      type.local = type.local || open.head.size() == 10;
      type.name += open.head.substr(10, open.head.size() - 11) + "::";
    }
    type.name += match[2];
    outline_.types.push_back(type);
  }

  Kind kind_of_block() const {
    if (open_.back().kind == Kind::Function || open_.back().kind == Kind::Other) return Kind::Other;
    if (starts_with_any(head_, {"namespace", "inline namespace"})) return Kind::Namespace;
    if (head_.starts_with("extern") && head_.find('(') == std::string::npos) return Kind::Namespace;
    const std::string head = without_template_line(head_);
    if (starts_with_any(head, {"class ", "struct ", "union "}) && !is_function_head(head)) return Kind::Type;
    if (head.starts_with("enum") || !is_function_head(head)) return Kind::Other;
    const std::string trimmed = head.substr(0, head.find_last_not_of(' ') + 1);
    const bool names_a_member = initializers_of(trimmed) != std::string::npos && is_word(trimmed.back());
    return names_a_member ? Kind::Other : Kind::Function;
  }

  void end() {
    const Open closed = open_.back();
    if (open_.size() > 1) open_.pop_back();
    if (closed.kind == Kind::Function) {
      outline_.functions.push_back({closed.first_line, line_ - closed.first_line + 1});
      if (open_.back().kind == Kind::Type && !closed.head.starts_with("friend"))
        count_function(class_here(), without_template_line(closed.head));
      note_name(closed.head, true);
    }
    const bool outside = open_.back().kind == Kind::Namespace || open_.back().kind == Kind::Type;
    if (closed.kind == Kind::Other && outside) head_ += "{}";
    if (closed.kind != Kind::Other) head_.clear();
  }

  void declaration() {
    const std::string head = without_template_line(head_);
    head_.clear();
    const bool type = open_.back().kind == Kind::Type, free = open_.back().kind == Kind::Namespace;
    if ((type || (free && !starts_with_any(head, {"using ", "static_assert", "typedef "}))) && is_function_head(head))
      note_name(head, false);
    if (!type || head.empty()) return;
    if (starts_with_any(head, {"using ", "friend ", "static_assert", "typedef ", "enum ", "static constexpr ",
                               "struct ", "class ", "union ", "static inline constexpr "}))
      return;
    if (is_function_head(head)) {
      count_function(class_here(), head);
    } else {
      class_here().data += data_declared_by(head);
    }
  }

  // Of the function with this head, in the block that is open now.
  void note_name(const std::string& whole_head, bool defined) {
    const std::string head = without_template_line(whole_head);
    if (starts_with_any(head, {"friend ", "static_assert"})) return;
    NamedFunction function{name_in(head), defined, false};
    if (function.name.find_first_not_of(":") == std::string::npos || function.name.find('~') != std::string::npos)
      return;
    bool member = function.name.find(':') != std::string::npos;
    for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
      if (open->kind == Kind::Namespace && open->head.starts_with("namespace ") && open->head.size() == 10)
        function.local = true;
      if (open->kind != Kind::Type) continue;
      function.name = outline_.classes[open->of_class].name + "::" + function.name;
      member = true;
    }
    function.local = function.local || (!member && head.starts_with("static "));
    const auto last = function.last_word();
    if (member && function.name.ends_with(last + "::" + last)) return;  // a constructor
    outline_.names.push_back(function);
  }

  OutlinedClass& class_here() { return outline_.classes[open_.back().of_class]; }

  Outline outline_;
  std::vector<Open> open_;
  std::string head_;
  std::size_t head_line_ = 1, line_ = 1;
};

}  // namespace

Outline outline_of(const std::vector<std::string>& lines) { return Reader().read(Stripped(lines).text); }

std::map<std::string, int> words_of(const std::vector<std::string>& lines) {
  std::map<std::string, int> words;
  std::string word;
  for (const char c : Stripped(lines).text) {
    if (is_word(c)) {
      word += c;
    } else if (!word.empty()) {
      ++words[word];
      word.clear();
    }
  }
  return words;
}

}  // namespace fleetproof::architecture
