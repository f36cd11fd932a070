#include "campaign/explain/sentences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/shown_time.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kEnoughFailing = 12;
// As Sentence::decides. That a drive needed the message which let it begin says least: it may have been right to send
// it.
constexpr std::ptrdiff_t kMostDeciding = 2;  // messages
constexpr int kByGoAhead = 1, kByShare = 2, kByThing = 3, kByMessage = 4;
constexpr Duration kNotable = std::chrono::milliseconds(10);  // so late a message is worth a word

std::vector<std::string> names_of_bodies(const FailingCase& of) {
  std::vector<std::string> names;
  for (const EntityId body : {of.failure.a, of.failure.b}) {
    if (body.valid()) names.push_back(name_of_body(of.scenario, body));
  }
  std::ranges::sort(names);
  return names;
}

std::string past_of(const std::string& doing) {
  if (doing == kTurning) return "turned";
  if (doing == kOnABend) return "drove on a bend";
  if (doing == kBackward) return "drove backward";
  if (doing == kDriving) return "drove";
  return doing == kTransferring ? "moved a load" : "stood";
}

class Words {
 public:
  explicit Words(const Explanation& of) : of_(of), scenario_(of.small.scenario) {}

  std::vector<Sentence> all() {
    what_happens();
    if (!of_.ended.empty()) say("The {}.", of_.ended);
    for (const std::string& shape : of_.shapes) say("{}", shape).at = of_.small.failure.at;
    for (const MessageNeed& need : of_.messages) message(need);
    things();
    for (const LastStop& stop : of_.stops) last_stop(stop);
    for (const SetOff& drive : of_.set_offs) set_off(drive);
    for (const Departure& drive : of_.past_drives) past_drive(drive);
    if (of_.has_notes) std::ranges::for_each(involved(), [&](EntityId agv) { knowledge(agv); });
    if (of_.has_notes) known_to_computers();
    shares();
    no_return();
    if (!of_.is_smallest)
      say("The search for a smaller case was ended before it was done: a longer one may find a smaller case.");
    if (!of_.not_tried.empty()) say("Not tried, because the time was over: {}.", fmt::join(of_.not_tried, "; "));
    return std::move(lines_);
  }

 private:
  // The sentence, for what else is to be said of it.
  template <class... Parts>
  Sentence& say(fmt::format_string<Parts...> format, Parts&&... parts) {
    Sentence& sentence = lines_.emplace_back();
    sentence.text = fmt::format(format, std::forward<Parts>(parts)...);
    return sentence;
  }
  template <class... Parts>
  Sentence& say_at(SimTime at, fmt::format_string<Parts...> format, Parts&&... parts) {
    Sentence& sentence = say(format, std::forward<Parts>(parts)...);
    sentence.at = at;
    return sentence;
  }

  // Claims are told in the order of claims_of, so that their numbers go up.
  Sentence& shown_by(std::size_t count, Sentence& sentence) {
    for (std::size_t i = 0; i < count; ++i) sentence.claims.push_back(++claim_);
    return sentence;
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
    say_at(failure.at, "The {} fails at {:.3f} s: {}{}.", of_.is_smallest ? "smallest case" : "case found so far",
           shown_seconds(failure.at), failure.kind.what, who);
    if (const Failure& original = of_.original.failure;
        names_of_bodies(of_.original) != names_of_bodies(of_.small) && original.a.valid())
      say("In the run itself it is {}: the smallest case fails in the same way, but with others.",
          fmt::join(names_of_bodies(of_.original), " and "));
    std::vector<std::string> doings;
    for (std::size_t i = 0; i < std::min(involved().size(), of_.doing.size()); ++i)
      doings.push_back(fmt::format("{} {}", name_of_body(scenario_, involved()[i]), past_of(of_.doing[i])));
    if (!doings.empty()) say("Then {}.", fmt::join(doings, ", and "));
  }

  void message(const MessageNeed& need) {
    const std::string name = message_text(scenario_, need.message);
    const GivenDelivery& delivery = need.message.delivery;
    const std::string trouble = delivery.lost     ? "the loss"
                                : delivery.copied ? "the second copy"
                                                  : fmt::format("the delay of {:.2f} s", to_seconds(delivery.delay));
    const SimTime sent = kStart + delivery.sent;
    Sentence& sentence =
        !need.is_needed ? say_at(sent, "It does not need {} of {}.", trouble, name)
        : !need.latest
            ? say_at(sent, "It needs {} of {}: had it arrived at once, no failure.", trouble, name)
            : say_at(sent, "It needs {} of {}. Had it arrived by {:.3f} s, no failure; at {:.3f} s, it fails.", trouble,
                     name, shown_seconds(delivery.sent + need.latest->in_time),
                     shown_seconds(delivery.sent + need.latest->too_late));
    // Of many that are needed, most only make the AGVs meet.
    const auto needed = std::ranges::count_if(of_.messages, &MessageNeed::is_needed);
    if (need.is_needed) sentence.decides = needed <= kMostDeciding ? kByMessage : kByGoAhead;
    shown_by(need.claims.size(), sentence);
  }

  void things() {
    for (const Claim& claim : of_.things) {
      Sentence& sentence = shown_by(1, say("It {}.", claim.sentence));
      // Without an AGV or its work, words are missing anyway.
      if (!claim.avoids || !claim.tells_why) continue;
      sentence.decides = kByThing;
      avoiding_.push_back(claim_);
      said_when_avoided_.insert(claim.words.begin(), claim.words.end());
    }
  }

  void last_stop(const LastStop& stop) {
    const std::size_t count = stop.claims.size();
    if (!stop.at) {
      shown_by(count, say("No brake of {} in the last 30 s avoids it, not even the first.", stop.agv));
      return;
    }
    const char* how = count == 1 ? ", 0.1 s before it" : " at the latest; 0.1 s later is too late";
    shown_by(count, say_at(*stop.at, "{} avoids it by braking at {:.3f} s{}.", stop.agv, shown_seconds(*stop.at), how));
  }

  void set_off(const SetOff& is) {
    const std::string name = name_of_body(scenario_, is.agv);
    const auto station = [&](StationId id) { return scenario_.map->station(id).name; };
    const std::string what = is.is_turn()
                                 ? "began to turn at " + station(is.drive.from)
                                 : fmt::format("set off from {} for {}", station(is.drive.from), station(is.drive.to));
    say_at(is.drive.at, "{} {} at {:.3f} s, {:.2f} s before.", name, what, shown_seconds(is.drive.at),
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
    say_at(drive.at, "{} had last set off from {} for {}, at {:.3f} s.", name_of_body(scenario_, drive.agv),
           map.station(drive.from).name, map.station(drive.to).name, shown_seconds(drive.at));
    faults_between(drive.agv, at, of_.small.failure.at - kStart, "after that");
  }

  void leave(const SetOff& is, const Leave& of) {
    const std::string from = name_of_body(scenario_, of.from);
    const auto looked_at_s = kLookedAt / std::chrono::seconds(1);
    for (std::size_t i = 0; i < of.claims.size(); ++i)
      shown_by(1, say("Without any {}message of {} in the {} s before, it does not {} then{}.",
                      of.kinds[i].empty() ? "" : of.kinds[i] + " ", from, looked_at_s,
                      is.is_turn() ? "turn" : "set off", and_then(of.claims[i])));
    if (of.without_others)
      shown_by(1, say("It needed nothing {}of {} for that: without {} in the {} s before, it {} all the same.",
                      of.kinds.empty() ? "" : "else ", from,
                      of.kinds.empty() ? "any message of it" : "any other message of it", looked_at_s,
                      is.is_turn() ? "turns" : "sets off"));
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
    const std::string message = message_text(scenario_, key.message);
    Sentence& alone =
        say_at(kStart + delivery.sent, "Without {} alone, it does not either{}.", message, and_then(key.claim));
    if (key.claim.avoids) {
      alone.decides = kByGoAhead;
      alone.lead = fmt::format("Without {}, {} does not {} then, and nothing fails.", message, name,
                               is.is_turn() ? "turn" : "set off");
    }
    shown_by(1, alone);
    if (delivery.copied) say("That message arrived twice.");
    if (delivery.delay >= kNotable) say("That message was {:.2f} s late.", to_seconds(delivery.delay));
    said_with(delivery);
    if (key.answered) {
      answered(*key.answered, name, from);
    } else {
      if (key.asked.empty()) say("{} had heard nothing of {} when it sent it.", from, name);
      for (const Question& asked : key.asked) question(is, asked, name, from);
    }
    if (!key.sender_drive || std::ranges::count(involved(), delivery.sender) == 0) return;
    const auto& map = *scenario_.map;
    say_at(key.sender_drive->at, "{} had last set off from {} for {} then, at {:.3f} s{}.", from,
           map.station(key.sender_drive->from).name, map.station(key.sender_drive->to).name,
           shown_seconds(key.sender_drive->at),
           key.is_last_drive ? "; it was on that drive, or behind it, when it failed" : "");
    faults_between(delivery.sender, key.sender_drive->at - kStart, delivery.sent, "between that and the message");
  }

  // As the agents name their requests.
  void answered(const Answered& is, const std::string& name, const std::string& from) {
    if (is.asked) {
      say_at(kStart + is.asked->delivery.sent, "It answers message {} ({}, {:.3f} s) of {}.", is.asked->number,
             words_of(*is.asked), shown_seconds(is.asked->delivery.sent), name);
    } else {
      say("It answers a request (\"{}\") of {} that had not reached {} by then.", is.request, name, from);
    }
    if (is.asked_new)
      say_at(
          kStart + is.asked_new->delivery.sent,
          "Before that drive or turn, {} had asked something else: message {} ({}, {:.3f} s). It is no answer to that.",
          name, is.asked_new->number, words_of(*is.asked_new), shown_seconds(is.asked_new->delivery.sent));
  }

  void question(const SetOff& is, const Question& asked, const std::string& name, const std::string& from) {
    const auto& [message, again, last] = asked;
    std::string since;
    if (again > 0)
      since = fmt::format("; {} sent {} more of that kind before that drive or turn, at last message {} ({}, {:.3f} s)",
                          name, again, last->number, words_of(*last), shown_seconds(last->delivery.sent));
    say_at(kStart + message.delivery.sent,
           "When {} sent it, the last {}to reach it of {} was message {} ({}, {:.3f} s){}.", from,
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
        say_at(kStart + fault.at, "The {} of {} at {:.3f} s was {}.", text_of(fault), name_of_body(scenario_, agv),
               shown_seconds(fault.at), when);
    }
  }

  // What it said last, and what it had from the other.
  void knowledge(EntityId agv) {
    const std::string name = name_of_body(scenario_, agv);
    for (const Declared& declared : of_.notes.declared) {
      if (declared.agv != agv) continue;
      if (!of_.undisturbed_words.empty() && !std::ranges::binary_search(of_.undisturbed_words, declared.word)) {
        say_at(declared.at, "{} said \"{}\" at {:.3f} s; on a perfect radio, nobody says it.", name, declared.word,
               shown_seconds(declared.at));
      } else if (!avoiding_.empty() && !said_when_avoided_.contains(declared.word)) {
        say_at(declared.at, "{} said \"{}\" at {:.3f} s; nobody says it in the runs that avoid it.", name,
               declared.word, shown_seconds(declared.at))
            .claims = avoiding_;
      }
    }
    for (const EntityId other : involved()) {
      if (other != agv) heard(agv, other);
    }
  }

  // How old what a server knew of them was.
  void known_to_computers() {
    for (std::size_t i = 0; i < scenario_.computers.size(); ++i) {
      for (const EntityId agv : involved()) heard(EntityId{scenario_.agvs.size() + i}, agv);
    }
  }

  void heard(EntityId agv, EntityId other) {
    const std::string name = name_of_body(scenario_, agv), from = name_of_body(scenario_, other);
    const auto last =
        std::ranges::find_if(of_.notes.heard, [&](const Heard& h) { return h.by == agv && h.of == other; });
    if (last == of_.notes.heard.end()) {
      // In a central fleet, AGVs may never speak with each other.
      if (scenario_.computers.empty() || scenario_.is_computer(agv)) say("{} had never heard {}.", name, from);
    } else {
      say_at(last->sent,
             "The last that {} had heard of {} was message {}{}, sent at {:.3f} s: {:.2f} s old at the failure.", name,
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
    if (base.of == 1 && base.failing() == 0) {
      say("With other draws, {} runs are all alike, and none fails so.", kRunsPerShare).share = 1;
    } else if (base.of == 1) {
      say("Other draws change nothing: this run always fails so.").share = 1;
    } else {
      say("With other draws, the run fails in the same way in {} of {}.", base.failing(), base.of).share = 1;
    }
    if (base.failing() == 0) return;  // changed runs that do not fail either tell nothing
    for (std::size_t i = 1; i < of_.shares.size(); ++i) {
      const Share& share = of_.shares[i];
      if (share.of == 1) {
        const char* what = share.failing() > 0         ? "it fails in the same way"
                           : share.smallest_case_fails ? "it does not fail so: the run needs this to be otherwise, the "
                                                         "smallest case does not"
                                                       : "it does not fail so";
        say("If {}, {}; other draws change nothing then.", share.what, what).share = i + 1;
        continue;
      }
      Sentence& sentence = say("If {}: {} of {}{}.", share.what, share.failing(), share.of, verdict(share, base));
      sentence.share = i + 1;
      const bool is_needed = base.failing() >= kEnoughFailing && share.failing() == 0 && !share.smallest_case_fails;
      if (!is_needed || !share.tells_why) continue;
      sentence.decides = kByShare;
      sentence.lead = fmt::format("If {}, it fails in none of {} runs with other draws; as it is, in {}.", share.what,
                                  share.of, base.failing());
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
    const auto of_run = [&](SimTime instant, Sentence& sentence) {
      sentence.at = instant;
      sentence.is_of_run = true;
    };
    if (curve.certain_from == curve.curve.front().at)
      return of_run(
          at,
          say("The run itself fails at {:.3f} s. That is certain from {:.3f} s on, the first instant looked at: all {} "
              "branches with a new radio fail so.",
              shown_seconds(at), shown_seconds(*curve.certain_from), kBranches));
    of_run(at,
           say("The run itself fails at {:.3f} s. From {:.2f} s before that, {} of {} branches with a new radio fail.",
               shown_seconds(at), to_seconds(at - curve.curve.front().at), curve.curve.front().failing(), kBranches));
    if (curve.likely_from)
      of_run(*curve.likely_from, say("It is likely from {:.3f} s on ({:.2f} s before).",
                                     shown_seconds(*curve.likely_from), to_seconds(at - *curve.likely_from)));
    if (curve.certain_from) {
      of_run(
          curve.open_until,
          say("It is certain from {:.3f} s on ({:.2f} s before): what decided it happened between {:.3f} s and then{}.",
              shown_seconds(*curve.certain_from), to_seconds(at - *curve.certain_from), shown_seconds(curve.open_until),
              curve.acted_by ? fmt::format(", and was acted upon by {:.3f} s", shown_seconds(*curve.acted_by)) : ""));
    } else {
      of_run(curve.curve.back().at, say("Until {:.2f} s before it, a new radio could still avoid it.",
                                        to_seconds(at - curve.curve.back().at)));
    }
  }

  const Explanation& of_;
  const Scenario& scenario_;
  std::vector<Sentence> lines_;
  std::size_t claim_ = 0;
  // Runs without a fault or a property that avoid the failure, and all that is said in them.
  std::vector<std::size_t> avoiding_;
  std::set<std::string> said_when_avoided_;
};

}  // namespace

std::string text_of(const Sentence& sentence) {
  if (sentence.claims.empty() && sentence.share == 0) return sentence.text;
  const std::string shown_by = sentence.share > 0 ? fmt::format("share {}", sentence.share)
                                                  : fmt::format("{}", fmt::join(sentence.claims, ", "));
  return fmt::format("{} [{}].", sentence.text.substr(0, sentence.text.size() - 1), shown_by);
}

std::vector<Sentence> told(const Explanation& explanation) { return Words(explanation).all(); }

std::vector<std::string> sentences_of(const Explanation& explanation) {
  std::vector<std::string> texts;
  for (const Sentence& sentence : told(explanation)) texts.push_back(text_of(sentence));
  return texts;
}

const Sentence* leading(const std::vector<Sentence>& sentences) {
  const auto most = std::ranges::max_element(sentences, {}, &Sentence::decides);
  return most != sentences.end() && most->decides > 0 ? &*most : nullptr;
}

}  // namespace fleetproof
