#include "core/error.hpp"

namespace fleetproof {

InputError::InputError(std::string_view where, std::string_view what)
    : std::runtime_error(where.empty() ? std::string(what) : std::string(where) + ": " + std::string(what)) {}

void invariant_violated(const char* sentence) { throw InvariantViolation(sentence); }

}  // namespace fleetproof
