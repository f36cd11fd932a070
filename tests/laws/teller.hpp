#pragma once

#include "core/engine/company.hpp"
#include "core/outcome/law.hpp"

namespace fleetproof::test {

// Tells a law of pieces, and of the company that they have, as a world does.
class Teller {
 public:
  Teller(Law& law, std::size_t bodies) : law_(law), company_(bodies, law.looks_within_m()) {}

  // Requires: the piece stays where it is until the next one of its body begins, and knows its planned box.
  void begins(const Piece& piece) {
    company_.begins(piece);
    law_.piece_started(piece);
  }
  // The same piece with its true end. The body has no piece until the next one begins.
  void ends(const Piece& piece) {
    const auto others = company_.pieces_near(piece.entity);
    if (!others.empty()) law_.had_company(piece, others);
    law_.piece_ended(piece);
    company_.leaves(piece.entity);
  }

 private:
  Law& law_;
  Company company_;
};

}  // namespace fleetproof::test
