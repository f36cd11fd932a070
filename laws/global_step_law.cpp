#include "laws/global_step_law.hpp"

#include "laws/published_law.hpp"

namespace fleetproof {
namespace {

class GlobalStepLaw final : public PublishedLaw {
 public:
  using PublishedLaw::PublishedLaw;

 private:
  void inspect(const Piece& drive) override {
    for (std::size_t i = 0; i < entity_count(); ++i) {
      const EntityId entity{i};
      if (entity == drive.entity) continue;
      for (SimTime t = drive.begin; t < drive.end; t += step()) {
        if (const Piece* other = piece_at(entity, t)) check_snapshot(drive, *other, t);
      }
    }
  }
};

}  // namespace

std::unique_ptr<Law> make_global_step_law(const Scenario& scenario) {
  return std::make_unique<GlobalStepLaw>(scenario);
}

}  // namespace fleetproof
