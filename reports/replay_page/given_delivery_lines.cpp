#include "reports/replay_page/given_delivery_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/wording.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {
namespace {

constexpr std::size_t kMostDeliveries = 3;

struct Given {
  const Message* message = nullptr;
  std::size_t receiver = 0;
  std::vector<const Arrival*> arrivals;
};

std::vector<Given> given_until_failure(const Film& film) {
  std::vector<Given> all;
  for (const Message& message : film.messages) {
    if (message.sent_us > film.focus_us) continue;
    for (const Arrival& arrival : message.arrivals) {
      if (!arrival.is_given) continue;
      auto known = std::ranges::find_if(
          all, [&](const Given& g) { return g.message == &message && g.receiver == arrival.receiver; });
      if (known == all.end()) known = all.insert(all.end(), {&message, arrival.receiver, {}});
      known->arrivals.push_back(&arrival);
    }
  }
  return all;
}

std::string delivery_text(const Given& given, const Film& film) {
  if (given.arrivals.front()->receipt != Receipt::Received) return word_of(given.arrivals.front()->receipt);
  std::vector<std::int64_t> at_us;
  for (const Arrival* arrival : given.arrivals) at_us.push_back(given.message->sent_us + arrival->after_us);
  std::ranges::sort(at_us);
  std::vector<std::string> at;
  for (const std::int64_t us : at_us) at.push_back(us > film.end_us ? "not before the end" : time_text(us) + " s");
  return "received " + joined(at) + ", as the scenario says";
}

}  // namespace

std::vector<GivenDeliveryLine> given_delivery_lines(const Film& film) {
  const std::vector<Given> all = given_until_failure(film);
  const std::size_t skipped = all.size() > kMostDeliveries ? all.size() - kMostDeliveries : 0;
  std::vector<GivenDeliveryLine> lines;
  for (std::size_t i = skipped; i < all.size(); ++i) {
    const Given& given = all[i];
    GivenDeliveryLine line;
    line.at_us = given.message->sent_us;
    line.text = fmt::format("{} from {} to {}, sent {} s: {}{}", text_of(*given.message),
                            film.bodies[given.message->sender].name, film.bodies[given.receiver].name,
                            time_text(line.at_us), delivery_text(given, film), i + 1 == all.size() ? "." : ";");
    if (i == skipped && skipped > 0)
      line.text = fmt::format("{} before them; ", count_text(skipped, "other message")) + line.text;
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace fleetproof::web
