#include "core/radio/radio.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// The Lomax quantile for scale 1.
double lomax(double share, double shape) { return natural_exp(-natural_log(1.0 - share) / shape) - 1.0; }

}  // namespace

DelayModel::DelayModel(const RadioSetup& setup)
    : model_(setup.delay_model), delay_s_(setup.delay_s), constant_(seconds(setup.delay_s)), tail_(setup.delay_tail) {
  scale_ = (tail_.median_share - tail_.min_share) / lomax(0.5, tail_.shape);
}

Duration DelayModel::heavy_tail(double share) const {
  double of_nominal = tail_.min_share + scale_ * lomax(share, tail_.shape);
  if (tail_.cap_share > 0.0) of_nominal = std::min(of_nominal, tail_.cap_share);
  return seconds(delay_s_ * of_nominal);
}

namespace {

auto in_order_of(const RecordedMessage& message) { return std::tuple(message.sender, message.receiver, message.sent); }

}  // namespace

RecordedRadio::RecordedRadio(std::shared_ptr<const RadioTrace> trace) : trace_(std::move(trace)) {
  if (empty()) return;
  period_ = std::ranges::max_element(*trace_, {}, &RecordedMessage::sent)->sent +
            Duration{1};  // the last instant belongs to the recording
}

const RecordedMessage* RecordedRadio::at(AgvId sender, AgvId receiver, SimTime t) const {
  const auto first_from = [&](Duration from) -> const RecordedMessage* {
    const auto found = std::ranges::lower_bound(*trace_, std::tuple(sender, receiver, from), {}, in_order_of);
    const bool of_this_pair = found != trace_->end() && found->sender == sender && found->receiver == receiver;
    return of_this_pair ? &*found : nullptr;
  };
  if (const auto* message = first_from(t.time_since_epoch() % period_)) return message;
  return first_from(Duration::zero());
}

namespace {

// Kinds of draws under the key of external sources.
constexpr std::uint32_t kOnProcess = 1, kLossKey = 2;

OutageLaw on_and_off(const RadioSource& source) {
  return {.sojourn = OutageLaw::Sojourn::Exponential,
          .bad_share = source.mean_on_s / (source.mean_on_s + source.mean_off_s),
          .mean_bad_s = source.mean_on_s};
}

}  // namespace

RadioSources::RadioSources(const std::vector<RadioSource>& sources, std::uint64_t key) {
  for (const RadioSource& source : sources) {
    const auto number = static_cast<std::uint32_t>(sources_.size());
    sources_.push_back({.at_m = Vec2(source.x_m, source.y_m),
                        .range_m = source.range_m,
                        .loss = source.loss,
                        .on = OutageProcess(on_and_off(source), {.key = key, .kind = kOnProcess, .a = number, .b = 0}),
                        .loss_key = word64(philox(key, {0, kLossKey << 1, number, 0}), 0)});
  }
}

bool RadioSources::destroy(const MessageKey& message, const Vec2& receiver_m) {
  for (Source& source : sources_) {
    if ((receiver_m - source.at_m).norm() > source.range_m || !source.on.bad_at(message.sent)) continue;
    if (unit_interval(word64(draw_for(message, source.loss_key), 0)) < source.loss) return true;
  }
  return false;
}

namespace {

// The kinds of processes and draws under the key of radio states. RadioPlaces uses 1 to 3, RadioCrossings uses 10.
constexpr std::uint32_t kLinkProcess = 8, kAsymmetryDraw = 9;
constexpr std::size_t kDrawnAtOnce = 4;
constexpr double kDrawRange = 0x1p53;  // of the 53 bits of a draw, as a whole number

// The loss of a message that is lost with probability `loss` near its sender. Of the messages that would arrive there,
// distance takes a share of its own.
double loss_at_distance(double loss, const RadioSetup& setup, const LinkPlaces& places) {
  if (setup.range_falloff_m == 0.0) return loss;
  const double falloff_m = std::min(setup.range_falloff_m, setup.range_m),
               into_falloff_m = (places.receiver_m - places.sender_m).norm() - (setup.range_m - falloff_m);
  return loss + (1.0 - loss) * std::clamp(into_falloff_m / falloff_m, 0.0, 1.0);
}

}  // namespace

Radio::Radio(const RadioSetup& setup, std::uint64_t world_seed, std::span<const GivenDelivery> deliveries,
             DrawNumbers numbers)
    : setup_(setup),
      keys_{.draws = RoundKeys(stream_key(world_seed, Stream::Radio)),
            .states = stream_key(world_seed, Stream::RadioState),
            .copies = stream_key(world_seed, Stream::RadioCopy)},
      delay_(setup),
      has_states_(setup.outages.mean_outage_s > 0.0 || setup.asymmetry > 0.0 || setup.places.roaming_border_m > 0.0 ||
                  setup.places.roaming_at_crossing),
      depends_on_place_(setup.places.roaming_border_m > 0.0 || setup.range_falloff_m > 0.0 || !setup.sources.empty() ||
                        (setup.outages.mean_outage_s > 0.0 && setup.outages.scope == OutageSetup::Scope::Place)),
      numbers_(std::move(numbers)),
      given_(deliveries),
      recorded_(setup.trace),
      places_(setup.places, outage_law(setup.loss), keys_.states),
      crossings_(setup.places, keys_.states),
      sources_(setup.sources, stream_key(world_seed, Stream::RadioSources)),
      is_plain_(!has_states_ && !depends_on_place_ && given_.empty() && recorded_.empty() && setup.duplicates == 0.0 &&
                setup.adverse.adverse_from_s == 0.0 && setup.adverse.adverse_until_s == 0.0),
      loss_limit_(static_cast<std::uint64_t>(std::ceil(setup.loss * kDrawRange))) {}

Delivery Radio::delivery(AgvId sender, AgvId receiver, SimTime sent, std::uint32_t ordinal, const LinkPlaces& places,
                         bool spared) {
  const Hearer hearer{receiver, ordinal};
  return delivery(sender, hearer, sent, draw_for(key_of(sender, hearer, sent), keys_.draws.key()), places, spared);
}

void Radio::draw(AgvId sender, SimTime sent, std::span<const Hearer> hearers, Block* draws) const {
  if (hearers.size() == 1) {
    *draws = draw_for(key_of(sender, hearers.front(), sent), keys_.draws.key());
    return;
  }
  const Block first = counter_of({numbers_.of(sender), AgvId{0U}, sent, 0});
  std::array<std::uint64_t, kDrawnAtOnce> rest{};
  for (std::size_t i = 0; i < hearers.size(); i += kDrawnAtOnce) {
    const std::size_t count = std::min(kDrawnAtOnce, hearers.size() - i);
    for (std::size_t k = 0; k < count; ++k)
      rest[k] = std::uint64_t{hearers[i + k].ordinal} << 32 | first[2] | numbers_.of(hearers[i + k].receiver).value;
    philox_of_four(keys_.draws, word64(first, 0), rest.data(), draws + i);
  }
}

Delivery Radio::delivery(AgvId sender, const Hearer& hearer, SimTime sent, const Block& draws, const LinkPlaces& places,
                         bool spared) {
  const auto& [receiver, ordinal] = hearer;
  if (const GivenDelivery* given = given_.empty() ? nullptr : given_.of({sender, receiver, sent, ordinal})) {
    Delivery delivery{.lost = given->lost, .delay = given->delay, .given = true};
    if (given->copied) delivery.copy_delay = given->copy_delay;
    return delivery;
  }
  if (spared || !setup_.adverse.contains(sent)) return {};
  return drawn_delivery({sender, receiver}, key_of(sender, hearer, sent), draws, places);
}

Delivery Radio::drawn_delivery(const Link& link, const MessageKey& message, const Block& draws,
                               const LinkPlaces& places) {
  const auto& [sender, receiver, sent, ordinal] = message;
  const double loss_draw = unit_interval(word64(draws, 0));
  Delivery delivery;
  delivery.lost = loss_draw < loss_at_distance(setup_.loss, setup_, places);
  delivery.delay = delay(draws);
  if (has_states_) weigh_states(delivery, loss_draw, link, sent, places);
  if (!recorded_.empty()) {
    if (const auto* recorded = recorded_.at(sender, receiver, sent)) {
      delivery = Delivery{.lost = !recorded->delay, .delay = recorded->delay.value_or(Duration::zero())};
    }
  }
  // A message that is already lost keeps its cause. One more source therefore does not change the other counts.
  if (!delivery.lost) delivery.lost = delivery.to_source = sources_.destroy(message, places.receiver_m);
  if (setup_.duplicates > 0.0) delivery.copy_delay = copy_of(message);
  return delivery;
}

void Radio::weigh_states(Delivery& delivery, double loss_draw, const Link& link, SimTime sent,
                         const LinkPlaces& places) {
  const auto& [sender, receiver] = link;
  double loss = setup_.asymmetry > 0.0 ? loss_of(sender, receiver) : setup_.loss;
  if (setup_.outages.mean_outage_s > 0.0) {
    const bool by_place = setup_.outages.scope == OutageSetup::Scope::Place;
    delivery.in_outage =
        by_place ? places_.cell_is_out(places.receiver_m, sent) : process_of(sender, receiver).bad_at(sent);
    const auto [good, bad] = losses_by_state(loss);
    loss = delivery.in_outage ? bad : good;
  }
  delivery.lost = loss_draw < loss_at_distance(loss, setup_, places);
  const bool at_border =
      places_.has_borders() && ((places.sender_roams && places_.is_roaming(places.sender_m, sent)) ||
                                (places.receiver_roams && places_.is_roaming(places.receiver_m, sent)));
  if (at_border || crossings_.is_deaf(numbers_.of(sender), sent) || crossings_.is_deaf(numbers_.of(receiver), sent))
    delivery.lost = delivery.in_outage = true;
}

// If the nominal loss is outside [loss_good, loss_bad], the process has one state only, with that loss. The losses of
// both states and the bad share grow with the nominal loss. Therefore a higher nominal loss only adds losses.
Radio::StateLoss Radio::losses_by_state(double loss) const {
  return {std::min(setup_.outages.loss_good, loss), std::max(setup_.outages.loss_bad, loss)};
}

OutageLaw Radio::outage_law(double loss) const {
  const auto& outages = setup_.outages;
  const bool lomax = outages.model == OutageSetup::Model::HeavyTail;
  return {.sojourn = lomax ? OutageLaw::Sojourn::Lomax : OutageLaw::Sojourn::Exponential,
          .bad_share = std::clamp((loss - outages.loss_good) / (outages.loss_bad - outages.loss_good), 0.0, 1.0),
          .mean_bad_s = outages.mean_outage_s,
          .shape = outages.shape};
}

double Radio::loss_of(EntityId from, EntityId to) const {
  const EntityId sender = numbers_.of(from), receiver = numbers_.of(to);
  const auto [low, high] = std::minmax(sender.value, receiver.value);
  const double draw = unit_interval(word64(philox(keys_.states, {0, kAsymmetryDraw << 1, low, high}), 0));
  const double shift = setup_.asymmetry * (2.0 * draw - 1.0) * setup_.loss * (1.0 - setup_.loss);
  return sender < receiver ? setup_.loss + shift : setup_.loss - shift;
}

OutageProcess& Radio::process_of(AgvId sender, AgvId receiver) {
  const auto [low, high] = std::minmax(sender.value, receiver.value);
  const std::uint32_t from = numbers_.of(sender).value, to = numbers_.of(receiver).value;
  const bool keyed_by_direction = setup_.outages.scope == OutageSetup::Scope::Direction;
  // Two directions with different losses share the randomness. The outages of the better direction then lie within the
  // outages of the worse direction.
  const bool one_for_both = !keyed_by_direction && setup_.asymmetry == 0.0;
  const std::uint32_t row = one_for_both ? low : sender.value, column = one_for_both ? high : receiver.value;
  if (links_.size() <= row) links_.resize(row + 1);
  if (links_[row].size() <= column) links_[row].resize(column + 1);
  auto& process = links_[row][column];
  if (!process) {
    const double loss = setup_.asymmetry > 0.0 ? loss_of(sender, receiver) : setup_.loss;
    process.emplace(outage_law(loss),
                    ProcessKey{keys_.states, kLinkProcess, keyed_by_direction ? from : std::min(from, to),
                               keyed_by_direction ? to : std::max(from, to)});
  }
  return *process;
}

std::optional<Duration> Radio::copy_of(const MessageKey& message) const {
  const Block block = draw_for(message, keys_.copies);
  if (unit_interval(word64(block, 0)) >= setup_.duplicates) return std::nullopt;
  return delay_.at(unit_interval(word64(block, 1)));
}

}  // namespace fleetproof
