// write_seeds FOLDER: the seeds and the dictionary of every reader, as FOLDER/READER/N and FOLDER/READER.dict.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "readers.hpp"

namespace {

// The form in which libFuzzer takes words.
std::string escaped(std::string_view word) {
  std::string text;
  for (const char c : word)
    text += c >= ' ' && c <= '~' && c != '"' && c != '\\' ? std::string(1, c)
                                                          : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return text;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "write_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path root = words[1];
  for (const auto& reader : fleetproof::fuzz::readers()) {
    const auto folder = root / reader.name;
    std::filesystem::create_directories(folder);
    const auto seeds = reader.seeds();
    for (std::size_t i = 0; i < seeds.size(); ++i)
      std::ofstream(folder / fmt::format("seed-{}", i), std::ios::binary) << seeds[i];
    std::ofstream dictionary(folder.string() + ".dict");
    for (const auto word : reader.words) dictionary << '"' << escaped(word) << "\"\n";
  }
  return 0;
}
