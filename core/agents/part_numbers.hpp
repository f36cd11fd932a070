#pragma once

#include <cstdint>

namespace fleetproof::agents {

enum class Rank : std::uint8_t { Lane, Disc, Sector };

// How the parts of hulls are numbered. First come lanes and discs: those of one kind of body, then those of the next
// one. After them come the sectors, again by kind.
class PartNumbers {
 public:
  PartNumbers(std::uint32_t lanes, std::uint32_t stations, std::uint32_t kinds, std::uint32_t sectors)
      : lanes_(lanes), per_kind_(lanes + stations), first_sector_(kinds * per_kind_), sectors_(sectors) {}

  std::uint32_t of_lane(std::uint32_t kind, std::uint32_t lane) const { return kind * per_kind_ + lane; }
  std::uint32_t of_disc(std::uint32_t kind, std::uint32_t station) const { return kind * per_kind_ + lanes_ + station; }
  std::uint32_t of_sector(std::uint32_t kind, std::uint32_t sector) const {
    return first_sector_ + kind * sectors_ + sector;
  }

  Rank rank(std::uint32_t number) const {
    if (is_sector(number)) return Rank::Sector;
    return number % per_kind_ < lanes_ ? Rank::Lane : Rank::Disc;
  }
  bool is_sector(std::uint32_t number) const { return number >= first_sector_; }
  std::uint32_t kind(std::uint32_t number) const {
    return is_sector(number) ? (number - first_sector_) / sectors_ : number / per_kind_;
  }
  // Require: it is one.
  std::uint32_t lane(std::uint32_t number) const { return number % per_kind_; }
  std::uint32_t station(std::uint32_t disc) const { return disc % per_kind_ - lanes_; }
  std::uint32_t sector(std::uint32_t number) const { return (number - first_sector_) % sectors_; }

 private:
  std::uint32_t lanes_, per_kind_, first_sector_, sectors_;
};

}  // namespace fleetproof::agents
