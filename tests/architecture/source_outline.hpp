#pragma once

#include <cstddef>
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

struct Outline {
  std::vector<OutlinedFunction> functions;  // free ones and members; a lambda belongs to the function around it
  std::vector<OutlinedClass> classes;
};

// The functions and classes of a C++ source, read from its text. This is no parser of C++: it follows braces and looks
// at the words before them, which is enough for sources that clang-format has formatted.
Outline outline_of(const std::vector<std::string>& lines);

}  // namespace fleetproof::architecture
