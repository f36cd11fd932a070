#pragma once

#include <string>
#include <string_view>

namespace fleetproof {

// What a file is that no importer reads, although people have it where others have a layout, and where the layout is to
// be had: "is a VDA 5050 order, ...". Empty if it is nothing that is known here.
std::string named_foreign(std::string_view text);

// Throws InputError if the file is one of these. Nothing happens if it cannot be read.
void refuse_foreign(const std::string& path);

}  // namespace fleetproof
