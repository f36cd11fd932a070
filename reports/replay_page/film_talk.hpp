#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "reports/replay_page/film.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {

// One message at one receiver, with its copy if it arrives twice.
struct Delivery {
  const Message* message = nullptr;
  Receipt receipt = Receipt::Received;
  Moment sent, arrives;         // of a loss: when it was lost
  std::optional<Moment> again;  // the copy, later than the first

  bool is_lost() const { return receipt != Receipt::Received; }
  bool is_to_one() const { return message->receiver.has_value(); }
};

// Who sent what to whom, in order of sending. Requires: the film outlives the object, and its messages stay.
class FilmTalk {
 public:
  explicit FilmTalk(const Film& film);

  const std::vector<const Message*>& sent_by(std::size_t body) const { return sent_by_[body]; }
  const std::vector<Delivery>& between(std::size_t sender, std::size_t receiver) const;
  // When the agent of the AGV began anew last before a moment, without what it knew.
  std::optional<std::int64_t> restarted_us(std::size_t body, Moment before) const;
  // Some AGV sent a message that was for an AGV. In a central fleet, AGVs may talk with computers alone.
  bool is_between_agvs() const { return is_between_agvs_; }
  // Between AGVs, some content says which number it answers.
  bool has_numbered_answers() const { return has_numbered_answers_; }
  // Between AGVs, some message of the run was for one receiver. If none was, answers are among those to all.
  bool has_messages_to_one() const { return has_messages_to_one_; }

 private:
  std::vector<std::vector<const Message*>> sent_by_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Delivery>> links_;
  std::vector<std::vector<Moment>> restarts_;  // by body
  bool is_between_agvs_ = false, has_messages_to_one_ = false, has_numbered_answers_ = false;
};

// The messages of the list that were sent in an interval: [from, until).
std::span<const Delivery> sent_within(const std::vector<Delivery>& list, std::int64_t from_us, Moment until);

}  // namespace fleetproof::web
