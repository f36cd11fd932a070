// The enumerations of fleetproof/agent.h as the words of lockstep.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::lockstep {

template <std::size_t kCount>
constexpr const char* word_in(const std::array<const char*, kCount>& words, std::uint32_t number) {
  return number < kCount ? words[number] : "unknown";
}

constexpr std::array kActionWords{"idle",   "driving",      "turning",      "picking", "dropping",
                                  "parked", "charging_now", "out_of_order", "stopped"};
static_assert(FP_STOPPED == kActionWords.size() - 1);
constexpr std::array kEventWords{"start", "order", "message", "timer", "action_done", "fault", "withdrawn"};
static_assert(FP_EVENT_WITHDRAWN == kEventWords.size() - 1);
constexpr std::array kLoadWords{"any_load", "empty_only", "loaded_only"};
constexpr std::array kBlockWords{"one_vehicle", "same_direction"};
constexpr std::array kRoleWords{"agv", "computer"};
constexpr std::array kOrdersWords{"assigned", "open"};

struct PurposeWord {
  fp_purpose bit;
  const char* word;
};
constexpr std::array kPurposeWords{PurposeWord{FP_ROUTING, "routing"}, PurposeWord{FP_STORAGE, "storage"},
                                   PurposeWord{FP_CHARGING, "charging"}, PurposeWord{FP_PARKING, "parking"}};

constexpr const char* result_word(std::int32_t result) {
  switch (result) {
    case FP_OK:
      return "ok";
    case FP_EMPTY:
      return "empty";
    case FP_REFUSED:
      return "refused";
    case FP_INVALID:
      return "invalid";
    default:
      return "suspended";
  }
}

}  // namespace fleetproof::lockstep
