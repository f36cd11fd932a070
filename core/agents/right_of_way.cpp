#include "core/agents/right_of_way.hpp"

#include <utility>

namespace fleetproof::agents {

void Seniority::raise(std::int64_t now_ns) {
  if (before_ns_ >= 0 && now_ns >= old_again_at_ns_) since_ns_ = std::exchange(before_ns_, kNone);
  if (since_ns_ < 0) since_ns_ = now_ns;
}

void Seniority::stand_back(std::int64_t now_ns) {
  if (before_ns_ < 0) before_ns_ = since_ns_;
  since_ns_ = kNone;
  old_again_at_ns_ = now_ns + kYoung_ns;
}

namespace {

enum PatienceDraws : std::uint32_t { kPatienceDraws = 11 };

constexpr double kPatienceWithElders_s = 3.0;
constexpr double kPatience_s = 10.0;  // up to half of it is added, so that two AGVs do not yield to each other at once

}  // namespace

Yields RightOfWay::when_blocked(const OwnPath& held, std::int64_t demand_ns) {
  const double now_s = static_cast<double>(controller_.now_ns()) * 1e-9;
  if (blocked_since_s_ < 0.0) {
    blocked_since_s_ = now_s;
    patience_s_ = kPatience_s * (1.0 + 0.5 * controller_.random(kPatienceDraws));
  }
  const double waited_s = now_s - blocked_since_s_;
  if (waited_s < kPatienceWithElders_s) return Yields::ToNobody;
  const Yields to = waited_s < patience_s_ ? Yields::ToElders : Yields::ToAll;
  return in_the_way(held, demand_ns, to) ? to : Yields::ToNobody;
}

bool RightOfWay::is_asked_for(const OwnPath& held) { return in_the_way(held, 0, Yields::ToAll); }

bool RightOfWay::in_the_way(const OwnPath& held, std::int64_t demand_ns, Yields to) {
  bool found = false;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    found = found || (goes_first(to, demand_ns, agv, n) && neighbours_.clashes(agv, n.with_held, held));
  });
  return found;
}

std::int64_t RightOfWay::eldest_demand_ns(const OwnPath& held, std::int64_t demand_ns) {
  std::int64_t eldest_ns = demand_ns;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (n.request_is_open() && n.demand_ns < eldest_ns && neighbours_.clashes(agv, n.with_held, held))
      eldest_ns = n.demand_ns;
  });
  return eldest_ns;
}

bool RightOfWay::goes_first(Yields to, std::int64_t demand_ns, std::uint32_t agv, const Neighbour& neighbour) const {
  if (!neighbour.request_is_open() || to == Yields::ToNobody) return false;
  const std::uint32_t self = smaller_number_first_ ? neighbours_.self() : agv;
  return to == Yields::ToAll || std::pair(neighbour.demand_ns, agv) < std::pair(demand_ns, self);
}

}  // namespace fleetproof::agents
