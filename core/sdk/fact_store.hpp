#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <unordered_map>

#include "core/sdk/fleetproof/agent.h"

struct fp_answer {
  std::unique_ptr<std::byte[]> bytes;
  std::uint64_t size = 0;
  bool under_way = true;  // it is being worked out
};

namespace fleetproof {

// The host's side of fp_facts: works each answer out once and keeps it. Threads: one store belongs to one thread.
class FactStore {
 public:
  // Requires: map and fleet outlive the store.
  FactStore(const fp_map& map, const fp_agv* fleet, std::uint32_t fleet_count, std::uint32_t agv_stride,
            double safety_distance_m)
      : facts_{sizeof(fp_facts), fleet_count, agv_stride, fleet, &map, safety_distance_m, ask, answer, this} {}
  explicit FactStore(const fp_briefing& of)
      : FactStore(*of.map, of.fleet, of.fleet_count, of.agv_stride, of.safety_distance_m) {}
  FactStore(const FactStore&) = delete;
  FactStore& operator=(const FactStore&) = delete;

  const fp_facts& facts() const { return facts_; }

 private:
  struct Question {
    fp_derive derive;
    std::uint64_t number;
    friend bool operator==(const Question&, const Question&) = default;
  };
  struct Hash {
    std::size_t operator()(const Question& question) const {
      const std::uint64_t mixed = question.number * 0x9e3779b97f4a7c15U;
      return std::hash<fp_derive>()(question.derive) ^ (mixed ^ (mixed >> 32));
    }
  };

  static const void* ask(const fp_facts* facts, fp_derive derive, std::uint64_t question, std::uint64_t* size) {
    return static_cast<FactStore*>(facts->host)->look_up({derive, question}, size);
  }

  static void answer(fp_answer* to, const void* bytes, std::uint64_t size) {
    to->bytes = std::make_unique_for_overwrite<std::byte[]>(size);
    to->size = size;
    if (size > 0) std::memcpy(to->bytes.get(), bytes, size);
  }

  const void* look_up(const Question& question, std::uint64_t* size) {
    const auto [place, is_new] = answers_.try_emplace(question);
    fp_answer& found = place->second;  // stays where it is when further answers are kept
    if (is_new) work_out(question, found);
    if (size != nullptr) *size = found.size;
    return found.under_way ? nullptr : found.bytes.get();
  }

  void work_out(const Question& question, fp_answer& to) {
    try {
      answer(&to, nullptr, 0);
      question.derive(&facts_, question.number, &to);
      to.under_way = false;
    } catch (...) {  // an agent in C++ may throw
      answers_.erase(question);
      throw;
    }
  }

  fp_facts facts_;
  std::unordered_map<Question, fp_answer, Hash> answers_;
};

}  // namespace fleetproof
