#include "campaign/explain/sentences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/shown_time.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kEnoughFailing = 12;
constexpr Duration kNotable = std::chrono::milliseconds(10);  // so late a message is worth a word

class Words {
 public:
  explicit Words(const Explanation& of) : of_(of), scenario_(of.small.scenario) {}

  std::vector<std::string> all() {
    what_happens();
    if (!of_.ended.empty()) say("The {}.", of_.ended);
    for (const MessageNeed& need : of_.messages) message(need);
    things();
    for (const LastStop& stop : of_.stops) last_stop(stop);
    for (const SetOff& drive : of_.set_offs) set_off(drive);
    for (const Departure& drive : of_.past_drives) past_drive(drive);
    if (of_.has_notes) std::ranges::for_each(involved(), [&](EntityId agv) { knowledge(agv); });
    shares();
    no_return();
    if (!of_.is_smallest)
      say("The search for a smaller case was ended before it was done: a longer one may find a smaller case.");
    if (!of_.not_tried.empty()) say("Not tried, because the time was over: {}.", fmt::join(of_.not_tried, "; "));
    return std::move(lines_);
  }

 private:
  template <class... Parts>
  void say(fmt::format_string<Parts...> format, Parts&&... parts) {
    lines_.push_back(fmt::format(format, std::forward<Parts>(parts)...));
  }

  // Claims are told in the order of claims_of, so that their numbers go up.
  std::string runs(std::size_t count) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(++claim_);
    return fmt::format("[{}]", fmt::join(numbers, ", "));
  }

  std::vector<EntityId> involved() const {
    std::vector<EntityId> agvs;
    for (const EntityId body : {of_.small.failure.a, of_.small.failure.b}) {
      if (body.valid() && body.index() < scenario_.agvs.size()) agvs.push_back(body);
    }
    return agvs;
  }

  void what_happens() {
    const Failure& failure = of_.small.failure;
    std::string who;
    if (failure.a.valid()) who = " of " + name_of_body(scenario_, failure.a);
    if (failure.b.valid()) who += " and " + name_of_body(scenario_, failure.b);
    say("The {} fails at {:.3f} s: {}{}.", of_.is_smallest ? "smallest case" : "case found so far",
        shown_seconds(failure.at), failure.kind.what, who);
    std::vector<std::string> doings;
    for (std::size_t i = 0; i < std::min(involved().size(), of_.doing.size()); ++i)
      doings.push_back(fmt::format("{} {}", name_of_body(scenario_, involved()[i]), past_of(of_.doing[i])));
    if (!doings.empty()) say("Then {}.", fmt::join(doings, ", and "));
  }

  static std::string past_of(const std::string& doing) {
    if (doing == kTurning) return "turned";
    if (doing == kOnABend) return "drove on a bend";
    if (doing == kBackward) return "drove backward";
    if (doing == kDriving) return "drove";
    return doing == kTransferring ? "moved a load" : "stood";
  }

  void message(const MessageNeed& need) {
    const std::string name = message_text(scenario_, need.message);
    const GivenDelivery& delivery = need.message.delivery;
    const std::string trouble = delivery.lost     ? "the loss"
                                : delivery.copied ? "the second copy"
                                                  : fmt::format("the delay of {:.2f} s", to_seconds(delivery.delay));
    const std::size_t count = need.claims.size();
    if (!need.is_needed) return say("It does not need {} of {} {}.", trouble, name, runs(count));
    if (!need.latest)
      return say("It needs {} of {}: had it arrived at once, no failure {}.", trouble, name, runs(count));
    say("It needs {} of {}. Had it arrived by {:.3f} s, no failure; at {:.3f} s, it fails {}.", trouble, name,
        shown_seconds(delivery.sent + need.latest->in_time), shown_seconds(delivery.sent + need.latest->too_late),
        runs(count));
  }

  void things() {
    for (const Claim& claim : of_.things) {
      say("It {} {}.", claim.sentence, runs(1));
      if (!claim.avoids) continue;
      avoiding_.push_back(claim_);
      said_when_avoided_.insert(claim.words.begin(), claim.words.end());
    }
  }

  void last_stop(const LastStop& stop) {
    const std::size_t count = stop.claims.size();
    if (!stop.at)
      return say("No brake of {} in the last 30 s avoids it, not even the first {}.", stop.agv, runs(count));
    if (count == 1)
      return say("{} avoids it by braking at {:.3f} s, 0.1 s before it {}.", stop.agv, shown_seconds(*stop.at),
                 runs(count));
    say("{} avoids it by braking at {:.3f} s at the latest; 0.1 s later is too late {}.", stop.agv,
        shown_seconds(*stop.at), runs(count));
  }

  void set_off(const SetOff& is) {
    const std::string name = name_of_body(scenario_, is.agv);
    const auto station = [&](StationId id) { return scenario_.map->station(id).name; };
    const std::string what = is.is_turn()
                                 ? "began to turn at " + station(is.drive.from)
                                 : fmt::format("set off from {} for {}", station(is.drive.from), station(is.drive.to));
    say("{} {} at {:.3f} s, {:.2f} s before.", name, what, shown_seconds(is.drive.at),
        to_seconds(of_.small.failure.at - is.drive.at));
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) {
      const bool is_silent = std::ranges::count(is.leaves, EntityId{i}, &Leave::from) == 0;
      if (EntityId{i} != is.agv && is_silent)
        say("In the {} s before that, nothing of {} reached it.", kLookedAt / std::chrono::seconds(1),
            scenario_.agvs[i].name);
    }
    for (const Leave& of : is.leaves) leave(is, of);
  }

  // It stands at the end of it, or where a fault has stopped it.
  void past_drive(const Departure& drive) {
    const auto& map = *scenario_.map;
    const Duration at = drive.at - kStart;
    say("{} had last set off from {} for {}, at {:.3f} s.", name_of_body(scenario_, drive.agv),
        map.station(drive.from).name, map.station(drive.to).name, shown_seconds(drive.at));
    faults_between(drive.agv, at, of_.small.failure.at - kStart, "after that");
  }

  void leave(const SetOff& is, const Leave& of) {
    const std::string from = name_of_body(scenario_, of.from);
    const auto looked_at_s = kLookedAt / std::chrono::seconds(1);
    for (std::size_t i = 0; i < of.claims.size(); ++i)
      say("Without any {}message of {} in the {} s before, it does not {} then{} {}.",
          of.kinds[i].empty() ? "" : of.kinds[i] + " ", from, looked_at_s, is.is_turn() ? "turn" : "set off",
          and_then(of.claims[i]), runs(1));
    if (of.without_others)
      say("It needed nothing {}of {} for that: without {} in the {} s before, it {} all the same {}.",
          of.kinds.empty() ? "" : "else ", from, of.kinds.empty() ? "any message of it" : "any other message of it",
          looked_at_s, is.is_turn() ? "turns" : "sets off", runs(1));
    for (const GoAhead& one : of.keys) key(is, one);
    if (of.keys.size() == 2) two_answers(name_of_body(scenario_, is.agv), of.keys[0].message, of.keys[1].message);
  }

  void two_answers(const std::string& name, const MessageDelivery& a, const MessageDelivery& b) {
    if (a.content.empty() || words_of(a) != words_of(b)) return;
    say("Messages {} and {} say the same ({}), and {} needed both.", b.number, a.number, words_of(a), name);
  }

  static const char* and_then(const Claim& claim) { return claim.avoids ? ", and nothing fails" : ""; }

  void key(const SetOff& is, const GoAhead& key) {
    const GivenDelivery& delivery = key.message.delivery;
    const std::string name = name_of_body(scenario_, is.agv), from = name_of_body(scenario_, delivery.sender);
    say("Without {} alone, it does not either{} {}.", message_text(scenario_, key.message), and_then(key.claim),
        runs(1));
    if (delivery.copied) say("That message arrived twice.");
    if (delivery.delay >= kNotable) say("That message was {:.2f} s late.", to_seconds(delivery.delay));
    said_with(delivery);
    if (key.asked.empty()) say("{} had heard nothing of {} when it sent it.", from, name);
    for (const Question& asked : key.asked) question(is, asked, name, from);
    if (!key.sender_drive || std::ranges::count(involved(), delivery.sender) == 0) return;
    const auto& map = *scenario_.map;
    say("{} had last set off from {} for {} then, at {:.3f} s{}.", from, map.station(key.sender_drive->from).name,
        map.station(key.sender_drive->to).name, shown_seconds(key.sender_drive->at),
        key.is_last_drive ? "; it was on that drive, or behind it, when it failed" : "");
    faults_between(delivery.sender, key.sender_drive->at - kStart, delivery.sent, "between that and the message");
  }

  void question(const SetOff& is, const Question& asked, const std::string& name, const std::string& from) {
    const auto& [message, again, last] = asked;
    std::string since;
    if (again > 0)
      since = fmt::format("; {} sent {} more of that kind before that drive or turn, at last message {} ({}, {:.3f} s)",
                          name, again, last->number, words_of(*last), shown_seconds(last->delivery.sent));
    say("When {} sent it, the last {}to reach it of {} was message {} ({}, {:.3f} s){}.", from,
        message.kind.empty() ? "" : message.kind + " ", name, message.number, words_of(message),
        shown_seconds(message.delivery.sent), since);
    faults_between(is.agv, message.delivery.sent, is.drive.at - kStart, "after it had sent that");
  }

  // What the sender of a message declared when it sent it.
  void said_with(const GivenDelivery& delivery) {
    std::vector<std::string> words;
    for (const Declared& declared : of_.notes.declared) {
      if (declared.agv == delivery.sender && declared.at == kStart + delivery.sent)
        words.push_back(fmt::format("\"{}\"", declared.word));
    }
    if (!words.empty())
      say("At that instant, {} said {}.", name_of_body(scenario_, delivery.sender), fmt::join(words, " and "));
  }

  void faults_between(EntityId agv, Duration from, Duration to, std::string_view when) {
    for (const Fault& fault : scenario_.faults) {
      if (fault.agv == agv && !fault.transport && from <= fault.at && fault.at <= to)
        say("The {} of {} at {:.3f} s was {}.", text_of(fault), name_of_body(scenario_, agv), shown_seconds(fault.at),
            when);
    }
  }

  // What it said last, and what it had from the other.
  void knowledge(EntityId agv) {
    const std::string name = name_of_body(scenario_, agv);
    for (const Declared& declared : of_.notes.declared) {
      if (declared.agv != agv) continue;
      if (!of_.undisturbed_words.empty() && !std::ranges::binary_search(of_.undisturbed_words, declared.word)) {
        say("{} said \"{}\" at {:.3f} s; on a perfect radio, nobody says it.", name, declared.word,
            shown_seconds(declared.at));
      } else if (!avoiding_.empty() && !said_when_avoided_.contains(declared.word)) {
        say("{} said \"{}\" at {:.3f} s; nobody says it in [{}].", name, declared.word, shown_seconds(declared.at),
            fmt::join(avoiding_, ", "));
      }
    }
    for (const EntityId other : involved()) {
      if (other != agv) heard(agv, other);
    }
  }

  void heard(EntityId agv, EntityId other) {
    const std::string name = name_of_body(scenario_, agv), from = name_of_body(scenario_, other);
    const auto last =
        std::ranges::find_if(of_.notes.heard, [&](const Heard& h) { return h.by == agv && h.of == other; });
    if (last == of_.notes.heard.end()) {
      say("{} had never heard {}.", name, from);
    } else {
      say("The last that {} had heard of {} was message {}{}, sent at {:.3f} s: {:.2f} s old at the failure.", name,
          from, last->number, last->kind.empty() ? "" : " (" + words_of(last->kind, last->content) + ")",
          shown_seconds(last->sent), to_seconds(of_.small.failure.at - last->sent));
    }
    const auto belief =
        std::ranges::find_if(of_.notes.believed, [&](const Believed& b) { return b.by == agv && b.about == other; });
    if (belief == of_.notes.believed.end()) return;
    say("It believed {} at ({:.2f}, {:.2f}), as of {:.3f} s by its clock.", from, 1e-3 * belief->where.x_mm,
        1e-3 * belief->where.y_mm, shown_seconds(belief->as_of));
  }

  void shares() {
    if (of_.shares.empty()) return;
    const Share& base = of_.shares.front();
    say("With other draws, the run fails in the same way in {} of {} [share 1].", base.failing(), base.of);
    for (std::size_t i = 1; i < of_.shares.size(); ++i) {
      const Share& share = of_.shares[i];
      say("If {}: {} of {}{} [share {}].", share.what, share.failing(), share.of, verdict(share, base), i + 1);
    }
  }

  // Only said where the run as it is fails often enough to compare.
  static const char* verdict(const Share& share, const Share& base) {
    if (base.failing() < kEnoughFailing) return "";
    if (share.failing() == 0)
      return share.smallest_case_fails
                 ? " (below 5 %, 95 % sure): the run needs this to be otherwise, the smallest case does not"
                 : " (below 5 %, 95 % sure): the failure needs this to be otherwise";
    return 2 * share.failing() >= base.failing() ? ": that does not decide it" : ": that makes it rarer";
  }

  void no_return() {
    const NoReturn& curve = of_.no_return;
    if (curve.curve.empty()) return;
    const SimTime at = of_.original.failure.at;
    if (curve.certain_from == curve.curve.front().at)
      return say(
          "The run itself fails at {:.3f} s. That is certain from {:.3f} s on, the first instant looked at: all {} "
          "branches with a new radio fail so.",
          shown_seconds(at), shown_seconds(*curve.certain_from), kBranches);
    say("The run itself fails at {:.3f} s. From {:.2f} s before that, {} of {} branches with a new radio fail.",
        shown_seconds(at), to_seconds(at - curve.curve.front().at), curve.curve.front().failing(), kBranches);
    if (curve.likely_from)
      say("It is likely from {:.3f} s on ({:.2f} s before).", shown_seconds(*curve.likely_from),
          to_seconds(at - *curve.likely_from));
    if (curve.certain_from) {
      say("It is certain from {:.3f} s on ({:.2f} s before): what decided it happened between {:.3f} s and then{}.",
          shown_seconds(*curve.certain_from), to_seconds(at - *curve.certain_from), shown_seconds(curve.open_until),
          curve.acted_by ? fmt::format(", and was acted upon by {:.3f} s", shown_seconds(*curve.acted_by)) : "");
    } else {
      say("Until {:.2f} s before it, a new radio could still avoid it.", to_seconds(at - curve.curve.back().at));
    }
  }

  const Explanation& of_;
  const Scenario& scenario_;
  std::vector<std::string> lines_;
  std::size_t claim_ = 0;
  std::vector<std::size_t> avoiding_;  // runs without a thing that avoid the failure, and all that is said in them
  std::set<std::string> said_when_avoided_;
};

}  // namespace

std::vector<std::string> sentences_of(const Explanation& explanation) { return Words(explanation).all(); }

}  // namespace fleetproof
