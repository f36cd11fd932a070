#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace fleetproof::architecture {

struct OutlinedFunction {
  std::size_t first_line = 0, lines = 0;
};

// A class, struct or union. Constructors, destructors, friends, types and static constants are not counted.
struct OutlinedClass {
  std::string name;
  std::size_t first_line = 0, functions = 0, data = 0;
};

// A function under the name by which callers know it. Constructors, destructors, operators and friends are left out.
struct NamedFunction {
  std::string name;      // without namespaces: "f", or "A::f" for a member of A
  bool defined = false;  // else only declared
  bool local = false;    // in an anonymous namespace, or static and free: no other file can call it

  // "f", for a member too.
  std::string last_word() const { return name.substr(name.rfind(':') + 1); }
};

// A class, struct, union or enumeration at the scope of a namespace.
struct NamedType {
  std::string name;    // with its namespaces: "fleetproof::agents::A"
  bool local = false;  // in an anonymous namespace: no other file can name it
};

struct Outline {
  std::vector<OutlinedFunction> functions;  // free ones and members; a lambda belongs to the function around it
  std::vector<OutlinedClass> classes;
  std::vector<NamedFunction> names;  // one for each declaration and definition
  std::vector<NamedType> types;      // one for each definition
};

// The functions and classes of a C++ source, read from its text. This is no parser of C++: it follows braces and looks
// at the words before them, which is enough for sources that clang-format has formatted.
Outline outline_of(const std::vector<std::string>& lines);

// How often each word stands in a source, outside comments, literals and directives.
std::map<std::string, int> words_of(const std::vector<std::string>& lines);

}  // namespace fleetproof::architecture
