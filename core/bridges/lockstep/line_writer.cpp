#include "core/bridges/lockstep/line_writer.hpp"

namespace fleetproof::lockstep {
namespace {

constexpr char kHexadecimal[] = "0123456789abcdef";

}  // namespace

void LineWriter::escaped(unsigned char byte) {
  line_ += "\\u00";
  line_.push_back(kHexadecimal[byte >> 4U]);
  line_.push_back(kHexadecimal[byte & 0xfU]);
}

// Names of a plant are UTF-8 as they are.
void LineWriter::string(std::string_view text) {
  comma();
  line_.push_back('"');
  for (const char c : text) {
    if (c == '"' || c == '\\') line_.push_back('\\');
    if (static_cast<unsigned char>(c) < 0x20) {
      escaped(static_cast<unsigned char>(c));
    } else {
      line_.push_back(c);
    }
  }
  line_.push_back('"');
}

void LineWriter::bits(std::string_view name, std::uint64_t word) {
  key(name);
  comma();
  line_.push_back('"');
  for (unsigned shift = 64; shift > 0; shift -= 4) line_.push_back(kHexadecimal[(word >> (shift - 4)) & 0xfU]);
  line_.push_back('"');
}

void LineWriter::bytes(std::string_view name, const void* bytes, std::uint32_t size) {
  key(name);
  comma();
  line_.push_back('"');
  for (std::uint32_t i = 0; i < size; ++i) {
    const auto byte = static_cast<const unsigned char*>(bytes)[i];
    if (byte < 0x20 || byte == 0x7f) {
      escaped(byte);
    } else if (byte < 0x80) {
      if (byte == '"' || byte == '\\') line_.push_back('\\');
      line_.push_back(static_cast<char>(byte));
    } else {  // UTF-8 of U+0080 to U+00FF
      line_.push_back(static_cast<char>(0xc0U | (byte >> 6U)));
      line_.push_back(static_cast<char>(0x80U | (byte & 0x3fU)));
    }
  }
  line_.push_back('"');
}

}  // namespace fleetproof::lockstep
