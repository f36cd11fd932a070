// Plays drawn sequences to the vehicle and to the model that was written from the standard alone, prints the first five
// in which the vehicle says what the model does not allow, and counts all. An argument: so many seeds.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/bridges/vda5050/vehicle_protocol.hpp"
#include "tests/support/vda5050_model.hpp"
#include "tests/support/vda5050_sequences.hpp"

namespace fleetproof::vda5050_compare {
namespace {

namespace model = test::vda5050_model;
namespace vda = bridges::vda5050;
using Kind = model::Input::Kind;

class Vehicle {
 public:
  explicit Vehicle(const model::VehicleTraits& traits) : traits_(traits) {
    restart(traits.start_node, traits.start_position);
  }

  void hear(const model::Input& input) {
    switch (input.kind) {
      case Kind::Order:
        if (is_connected_) protocol_->order_received(input.text);
        break;
      case Kind::InstantActions:
        if (is_connected_) protocol_->instant_actions_received(input.text);
        break;
      case Kind::NodeReached:  // it stands there, as the model has it, until it enters an edge
        if (!input.may_be_known) {
          protocol_->hear(vda::EdgeBegun{input.sequence - 1});
          protocol_->hear(vda::Driving{true});
        }
        locate(input.position);
        protocol_->hear(vda::NodeReached{input.sequence});
        protocol_->hear(vda::Driving{false});
        break;
      case Kind::EdgeEntered:
        protocol_->hear(vda::EdgeBegun{input.sequence});
        protocol_->hear(vda::Driving{true});
        break;
      case Kind::Stopped:
        locate(input.position);
        protocol_->hear(vda::Driving{false});
        break;
      case Kind::ActionBegun:
        protocol_->hear(vda::ActionBegun{input.action_id});
        break;
      case Kind::ActionFinished:
        protocol_->hear(vda::ActionFinished{input.action_id, {}});
        break;
      case Kind::ActionFailed:
        protocol_->hear(vda::ActionFailed{input.action_id, "it did"});
        break;
      case Kind::PauseEffective:
        if (input.on) protocol_->hear(vda::Driving{false});
        break;
      case Kind::ConnectionLost:
        is_connected_ = false;
        protocol_->hear(vda::ConnectionLost{});
        break;
      case Kind::ConnectionRestored:
        is_connected_ = true;
        protocol_->hear(vda::ConnectionOpened{});
        break;
      case Kind::Restarted:  // its place it knows
        restart("", at_);
        break;
    }
    if (input.kind == Kind::EdgeEntered) node_.clear();
    if (input.kind == Kind::NodeReached) node_ = input.node_id;
    const bool ends_pause = input.kind == Kind::InstantActions && input.text.find("stopPause") != input.text.npos;
    is_resuming_ = (is_resuming_ || ends_pause) && !(input.kind == Kind::PauseEffective && !input.on);
    protocol_->take_action_wishes();
  }

  model::Report report() {
    model::Report told;
    bool published = false, sent_factsheet = false, announced_online = false;
    std::string state;
    for (const vda::Publication& one : protocol_->publish(0)) {
      published = published || one.topic == vda::Topic::State;
      sent_factsheet = sent_factsheet || one.topic == vda::Topic::Factsheet;
      announced_online = announced_online || one.topic == vda::Topic::Connection;
      if (one.topic == vda::Topic::State) state = one.payload;
    }
    if (state.empty()) state = vda::write_document(protocol_->state(), version());
    told = model::read_report(state);
    told.published = published;
    told.sent_factsheet = sent_factsheet;
    told.announced_online = announced_online;
    // Between the end of a pause and the body that drives again, either is right.
    if (is_resuming_) return told;
    told.drives.emplace();
    for (const vda::Edge& edge : protocol_->driving_wish().edges) told.drives->push_back(edge.sequence_id);
    return told;
  }

 private:
  const vda::Version& version() const {
    return *vda::find_version(traits_.version == model::Version::V2_0_0 ? "2.0" : "2.1");
  }
  void locate(const model::Position& at) {
    at_ = at;
    protocol_->hear(vda::Located{{true, at.x, at.y, 0.0, "hall"}});
  }
  void restart(const std::string& node, const model::Position& at) {
    vda::VehicleSettings settings;
    settings.identity = {&version(), "fp", "agv1", 0};
    settings.stops_between_nodes = traits_.stops_between_nodes;
    settings.node_tolerance_m = traits_.tolerance_m;
    for (const std::string& type : traits_.known) {
      const bool can_be_cancelled = !traits_.uninterruptible.contains(type);
      settings.abilities.actions.push_back({type, true, true, true, {}, can_be_cancelled, true});
    }
    protocol_ = std::make_unique<vda::VehicleProtocol>(settings, vda::Factsheet{});
    locate(at);
    if (!node.empty()) protocol_->hear(vda::StandsAt{node});
    is_connected_ = true;
    protocol_->hear(vda::ConnectionOpened{});
    protocol_->take_action_wishes();
  }

  const model::VehicleTraits traits_;
  std::unique_ptr<vda::VehicleProtocol> protocol_;
  bool is_connected_ = true, is_resuming_ = false;
  std::string node_ = traits_.start_node;
  model::Position at_;
};

std::string told(const model::Input& input) {
  return std::string(model::name_of(input.kind)) + " " + input.node_id + input.action_id + " " +
         std::to_string(input.sequence) + " " + input.text;
}

// The first disagreement of a sequence, with what came before; empty: there is none.
std::string disagreement(model::Version version, bool stops, std::uint64_t seed) {
  const model::VehicleTraits traits = model::grid_traits(version, stops);
  model::VehicleModel standard(traits);
  model::SequenceSettings settings;
  settings.seed = seed;
  model::SequenceDrawer drawer(traits, settings);
  Vehicle vehicle(traits);
  vehicle.report();
  std::string story;
  while (const auto input = drawer.next(standard)) {
    story += told(*input) + "\n";
    standard.apply(*input);
    vehicle.hear(*input);
    const auto against = standard.judge(vehicle.report());
    if (against.empty()) continue;
    for (const std::string& one : against) story += "  " + one + "\n";
    return story;
  }
  return {};
}

}  // namespace
}  // namespace fleetproof::vda5050_compare

int main(int argc, char** argv) {
  using namespace fleetproof::vda5050_compare;
  const std::uint64_t seeds = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 500;
  std::uint64_t different = 0;
  for (const model::Version version : {model::Version::V2_0_0, model::Version::V2_1_0}) {
    for (const bool stops : {false, true}) {
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const std::string story = disagreement(version, stops, seed);
        if (!story.empty() && ++different <= 5)
          std::printf("seed %llu\n%s\n", static_cast<unsigned long long>(seed), story.c_str());
      }
    }
  }
  std::printf("%llu of %llu sequences\n", static_cast<unsigned long long>(different),
              static_cast<unsigned long long>(4 * seeds));
  return different > 0 ? 1 : 0;
}
