#include "reports/replay_page/replay_page.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>

#include "reports/replay_page/film_budget.hpp"

namespace fleetproof::web::replay_page_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

MotionPiece resting(std::size_t body, std::int64_t end_us) {
  MotionPiece piece;
  piece.body = body;
  piece.end_us = end_us;
  piece.x_um = 3'000'000 * static_cast<std::int64_t>(body);
  return piece;
}

Message message(std::uint32_t number, std::size_t sender, std::size_t receiver, std::int64_t sent_us, Receipt receipt) {
  Message sent;
  sent.number = number;
  sent.sender = sender;
  sent.sent_us = sent_us;
  sent.kind = "GRANT";
  sent.arrivals.push_back({receiver, receipt, receipt == Receipt::Received ? 1'500'000 : 0});
  return sent;
}

// Two AGVs that are too close at 20 s, in a run of 40 s.
Film small_film() {
  Film film;
  film.title = "AGV 0 and AGV 1";
  film.command = "fleetproof replay a.db 7";
  film.failed = true;
  film.story = {"They come too close."};
  film.facts = {{"agent", "reckless"}};
  film.end_us = 40'000'000;
  film.focus_us = 20'000'000;
  film.open_us = 17'000'000;
  film.involved = {0, 1};
  film.safety_distance_um = 100'000;
  film.bodies = {{"AGV 0", BodyKind::Agv}, {"AGV 1", BodyKind::Agv}};
  film.outlines = {{1'600'000, 1'000'000, 0}};
  film.pieces = {resting(0, film.end_us), resting(1, film.end_us)};
  film.activities = {{0, 16'000'000, 20'000'000, "drive", "A to B"}};
  film.states = {{0, 15'000'000, "driving"}};
  film.waits = {{1, 12'000'000, 0}};
  film.messages = {message(1, 0, 1, 18'000'000, Receipt::Received),
                   message(2, 1, 0, 19'000'000, Receipt::LostInOutage)};
  film.messages[0].content = "answers 7";
  film.happenings = {{1, 14'000'000, "fault", "restart", true, false}};
  TooClose close;
  close.b = 1;
  close.first_us = close.closest_us = 20'000'000;
  close.last_us = 21'000'000;
  close.clearance_um = 34'567;
  close.level = "safety distance broken";
  film.violations = {close};
  film.clearances = {{0, 1, {{17'000'000, 900'000}, {20'000'000, 34'567}, {22'000'000, 700'000}}}};
  film.orders = {{0, 5, "A", "B", 1'000'000, {}}};
  return film;
}

std::string element_text(const std::string& page, const std::string& begin, const std::string& end) {
  const auto from = page.find(begin);
  if (from == std::string::npos) return {};
  return page.substr(from + begin.size(), page.find(end, from) - from - begin.size());
}
Json data_of(const std::string& page) {
  return Json::parse(element_text(page, "<script type=\"application/json\" id=\"film\">", "</script>"));
}

TEST(ReplayPage, IsWellFormedAndFetchesNothing) {
  const std::string page = replay_page(small_film());
  pugi::xml_document document;
  const auto parsed = document.load_buffer(page.data(), page.size(), pugi::parse_full);
  ASSERT_TRUE(parsed) << parsed.description() << page.substr(static_cast<std::size_t>(parsed.offset), 80);
  const std::string policy =
      document.select_node("//meta[@http-equiv='Content-Security-Policy']").node().attribute("content").value();
  EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
  EXPECT_THAT(policy, Not(HasSubstr("http")));
  EXPECT_TRUE(document.select_nodes("//*[@src or @href or @srcset or @style]").empty());
  EXPECT_TRUE(document.select_nodes("//link | //img | //iframe | //object | //embed").empty());
  for (const char* word : {"@import", "url(", "fetch(", "XMLHttpRequest", "innerHTML", "eval(", "Date"})
    EXPECT_THAT(page, Not(HasSubstr(word))) << word;
}

TEST(ReplayPage, TheSameFilmGivesTheSameBytes) { EXPECT_EQ(replay_page(small_film()), replay_page(small_film())); }

TEST(ReplayPage, SaysWithoutScriptsWhatHappened) {
  const std::string page = replay_page(small_film());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  const auto cells = [&](const char* part) {
    std::string text;
    for (const auto& cell : document.select_nodes(fmt::format("//section[@id='{}']//tbody//td", part).c_str()))
      text += std::string(cell.node().text().get()) + "|";
    return text;
  };
  EXPECT_EQ(cells("violations"), "AGV 0|AGV 1|20.000|21.000|20.000|0.034|0.000|safety distance broken|");
  EXPECT_EQ(cells("who-waits-for-whom"), "AGV 1|AGV 0|12.000||");
  EXPECT_EQ(cells("faults"), "14.000|AGV 1|fault|restart|");
  EXPECT_EQ(cells("transports-orders"), "5|AGV 0|A|B|1.000|open|");
  std::string event_log;
  for (const auto& cell : document.select_nodes("//div[@id='log-lines']/div/span"))
    event_log += std::string(cell.node().text().get()) + "|";
  EXPECT_EQ(event_log,
            "12.000|AGV 1|says it waits|for AGV 0|14.000|AGV 1|fault|restart|15.000|AGV 0|its agent says|\"driving\"|"
            "16.000|AGV 0|begins drive|A to B|18.000|AGV 0 \u2192 all|GRANT #1 (answers 7)|received 19.500 s|"
            "19.000|AGV 1 \u2192 all|GRANT #2|lost in an outage|20.000|AGV 0|ends drive||"
            "20.000|AGV 0|too close|to AGV 1|");
  EXPECT_STREQ(document.select_node("//section[@id='player']").node().attribute("hidden").value(), "hidden");
  EXPECT_STREQ(document.select_node("//figure[@class='clearance']/figcaption").node().text().get(),
               "AGV 0 and AGV 1: smallest clearance 0.034 m at 20.000 s");
}

TEST(ReplayPage, TheDataHaveWhatTheScriptsAsk) {
  const Json data = data_of(replay_page(small_film()));
  EXPECT_EQ(data["open_us"], 16'000'000) << "where AGV 0 set off, not shortly before the failure";
  EXPECT_EQ(data["messages_ms"][0], Json({1, 0, -1, 18000, data["messages_ms"][0][4], 0, 1, 1500}));
  EXPECT_EQ(data["words"][data["messages_ms"][0][4].get<std::size_t>()], "GRANT");
  EXPECT_EQ(data["messages_ms"][1][7], -2) << "lost in an outage";
  EXPECT_EQ(data["violations"][0]["clearance_um"], 34'567);
  EXPECT_EQ(data["kept_ms"]["messages"], Json({0, 40000, 0, 40000}));
}

TEST(ReplayPage, HostileNamesStayText) {
  const std::string hostile = "</script><img src=x onerror=alert(1)>]]><!-- &lt; \x1b[2J \xe2\x80\xae \"'";
  Film film = small_film();
  film.title = film.command = film.bodies[0].name = film.facts[0].value = film.activities[0].details = hostile;
  film.states[0].word = film.messages[0].kind = film.happenings[0].details = film.orders[0].from = hostile;
  film.stations = {{hostile, 0, 0}};
  film.tracks = {{hostile, {{0, 0, 0, 0}, {1'000'000, 0, 0, 1'000'000}}}};
  const std::string page = replay_page(film);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  EXPECT_TRUE(document.select_nodes("//img").empty());
  for (const char* markup : {"<img", "<!-- ", "\x1b", "\xe2\x80\xae"}) EXPECT_THAT(page, Not(HasSubstr(markup)));
  std::size_t scripts = 0;
  for (auto at = page.find("</script>"); at != std::string::npos; at = page.find("</script>", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 2U);
  const Json data = data_of(page);
  EXPECT_EQ(data["bodies"][0]["name"], hostile) << "the scripts get the name itself, as text";
  EXPECT_EQ(data["stations"][0]["name"], hostile);
}

TEST(ReplayPage, WithoutAViolationItShowsThePairThatCameClosest) {
  Film film = small_film();
  film.violations.clear();
  film.nearest = Nearest{0, 1, 20'000'999, 3'400'567};
  film.clearances = {{0, 1, {{17'000'000, 9'000'000}, {20'000'999, 3'400'567}, {22'000'000, 7'000'000}}}};
  const std::string page = replay_page(film);
  EXPECT_THAT(page, HasSubstr("this pair came closest of all"));
  EXPECT_THAT(page, HasSubstr("smallest clearance 3.400 m at 20.000 s"));
  EXPECT_EQ(data_of(page)["nearest"], Json({{"a", 0}, {"b", 1}, {"at_us", 20'000'999}, {"clearance_um", 3'400'567}}));
  // The curve goes on above 2 m, where others are cut.
  pugi::xml_document document;
  ASSERT_TRUE(document.load_buffer(page.data(), page.size(), pugi::parse_full));
  const auto dot = document.select_node("//figure[@class='clearance']//circle").node();
  EXPECT_NEAR(dot.attribute("cy").as_double(), 210.0 - 34.0 - (210.0 - 34.0 - 14.0) / 2.0, 1.0) << "half way up";
  EXPECT_THAT(replay_page(small_film()), Not(HasSubstr("this pair came closest of all")));
}

// A central fleet: the server lets AGV 0 and AGV 2 go. AGV 2 is not involved in the failure.
Film central_film() {
  Film film = small_film();
  film.bodies.push_back({"AGV 2", BodyKind::Agv});
  film.bodies.push_back({"server", BodyKind::Computer, FloorPlace{5'000'000, -1'000'000}});
  film.bodies.push_back({"broker", BodyKind::Computer});
  film.messages.clear();
  std::uint32_t number = 0;
  const auto send = [&](std::size_t from, std::size_t to, std::int64_t sent_us, const char* kind) {
    film.messages.push_back(message(++number, from, to, sent_us, Receipt::Received));
    film.messages.back().receiver = to;
    film.messages.back().kind = kind;
  };
  send(0, 3, 8'000'000, "ASK");
  send(3, 0, 9'500'000, "GO");
  send(2, 3, 10'000'000, "ASK");
  send(3, 2, 11'500'000, "GO");
  film.messages[1].content = "the lane A to B is yours";
  film.messages[3].content = "lease 7";
  film.happenings.push_back({3, 12'000'000, "fault", "restart", true, false});
  return film;
}

TEST(ReplayPage, HasThePlacesOfComputersAndWhatTheySayToEverybody) {
  const std::string page = replay_page(central_film());
  const Json data = data_of(page);
  EXPECT_EQ(data["bodies"][3],
            Json({{"name", "server"}, {"kind", "computer"}, {"x_um", 5'000'000}, {"y_um", -1'000'000}}));
  EXPECT_EQ(data["bodies"][4], Json({{"name", "broker"}, {"kind", "computer"}})) << "connected everywhere";
  std::vector<std::string> contents;
  for (const Json& content : data["contents"]) contents.push_back(data["words"][content[1].get<std::size_t>()]);
  EXPECT_THAT(contents, testing::ElementsAre("the lane A to B is yours", "lease 7"));
  EXPECT_THAT(page, HasSubstr("<span class=\"whose\">server</span><span class=\"what\">fault</span>"))
      << "faults of all stand in the event log";
}

TEST(ReplayPage, NamesComputersAmongThoseWhoReceive) {
  Film film = central_film();
  Message& to_all = film.messages.emplace_back(message(9, 0, 1, 12'000'000, Receipt::Received));
  for (const std::size_t receiver : {2U, 3U, 4U}) to_all.arrivals.push_back({receiver, Receipt::Received, 1'500'000});
  for (std::size_t i = 0; i < 3; ++i) {
    to_all.arrivals.push_back({film.bodies.size(), Receipt::Received, 1'500'000});
    film.bodies.push_back({fmt::format("AGV {}", i + 3), BodyKind::Agv});
  }
  const std::string page = replay_page(film);
  EXPECT_THAT(page, HasSubstr("AGV 1, server, broker received 13.500 s; 4 AGVs received"));
}

// What a fleet of 50 does in ten minutes with a protocol that floods the radio.
Film flooded_film() {
  Film film = small_film();
  constexpr std::size_t kAgvs = 50;
  film.end_us = 600'000'000;
  film.focus_us = 400'000'000;
  film.bodies.clear();
  film.pieces.clear();
  film.messages.clear();
  for (std::size_t i = 0; i < kAgvs; ++i) film.bodies.push_back({fmt::format("AGV {}", i), BodyKind::Agv});
  for (std::size_t i = 0; i < kAgvs; ++i) {
    for (std::int64_t t_us = 0; t_us < film.end_us; t_us += 4'000'000) {
      MotionPiece drive = resting(i, t_us + 4'000'000);
      drive.begin_us = t_us;
      drive.moving = Moving::Drives;
      drive.way_begin_um = 12'345'678;
      drive.planned_way = 10'123'456;
      drive.phases.assign(3, {1'234'567, 1'234'567, 1'234'567, -1'000'000});
      film.pieces.push_back(drive);
    }
  }
  film.tracks.assign(400, {"a segment", {{0, 0, 0, 0}, {1'000'000, 0, 0, 1'000'000}}});
  std::uint32_t number = 0;
  for (std::int64_t t_us = 0; t_us < film.end_us; t_us += 1'000'000) {
    for (std::size_t sender = 0; sender < kAgvs; ++sender) {
      Message sent = message(++number, sender, 0, t_us + static_cast<std::int64_t>(sender) * 7000, Receipt::Received);
      sent.arrivals.clear();
      for (std::size_t receiver = 0; receiver < kAgvs; ++receiver) {
        if (receiver == sender) continue;
        sent.arrivals.push_back({receiver, receiver % 5 == 0 ? Receipt::LostByChance : Receipt::Received, 1'234'567});
        Belief belief{receiver, sender, sent.sent_us + 1'234'567, sent.sent_us, 12'345'000, 23'456'000, 3'141'592};
        film.beliefs.push_back(belief);
      }
      film.messages.push_back(sent);
      film.happenings.push_back({sender, sent.sent_us, "probe", "negotiation", false, true});
      film.waits.push_back({sender, sent.sent_us, (sender + number) % kAgvs});
      for (int word = 0; word < 3; ++word)
        film.states.push_back(
            {sender, sent.sent_us, fmt::format("step {} of message {} of a long plan", word, number)});
    }
  }
  return film;
}

TEST(ReplayPage, AFloodOfMessagesFitsInFiveMegabytes) {
  const Film film = flooded_film();
  ASSERT_GT(film.beliefs.size(), 1'000'000U);
  const std::string page = replay_page(film);
  EXPECT_LT(page.size(), 5'000'000U);
  EXPECT_THAT(page, HasSubstr("What this page leaves out"));
  const Json data = data_of(page);
  EXPECT_EQ(data["pieces_us_um_urad"].size(), film.pieces.size()) << "motion is whole";
}

// The page has all of the time that it says it has: counted in what went in.
TEST(ReplayPage, LeavesNothingOutWhereItSaysSo) {
  Film whole = flooded_film();
  for (std::size_t i = 0; i < whole.messages.size(); i += 9) whole.messages[i].arrivals.clear();  // nobody is in range
  Film film = whole;
  keep_within(film);
  ASSERT_EQ(film.left_out.size(), 5U);
  const auto is_promised = [&](const Kept& kept, std::int64_t at_us, bool involved) {
    return involved ? kept.involved_from_us <= at_us && at_us <= kept.involved_to_us
                    : kept.others_from_us <= at_us && at_us <= kept.others_to_us;
  };
  const auto key = [](std::size_t number, std::size_t receiver) { return number * 64 + receiver; };
  std::set<std::size_t> arrivals;
  for (const Message& m : film.messages) {
    for (const Arrival& arrival : m.arrivals) arrivals.insert(key(m.number, arrival.receiver));
  }
  std::size_t promised = 0, missing = 0;
  for (const Message& m : whole.messages) {
    for (const Arrival& arrival : m.arrivals) {
      const bool involved = m.sender < 2 || arrival.receiver < 2;
      if (!is_promised(film.kept_messages, m.sent_us, involved)) continue;
      ++promised;
      missing += arrivals.contains(key(m.number, arrival.receiver)) ? 0 : 1;
    }
  }
  EXPECT_EQ(missing, 0U);
  EXPECT_GT(promised, 1000U);
  EXPECT_LE(film.kept_messages.involved_from_us, whole.focus_us - 20'000'000);
  const auto unheard = [&](const std::vector<Message>& messages) {
    return std::ranges::count_if(messages, [&](const Message& m) {
      return m.arrivals.empty() && is_promised(film.kept_messages, m.sent_us, m.sender < 2);
    });
  };
  EXPECT_EQ(unheard(film.messages), unheard(whole.messages));
  EXPECT_GT(unheard(film.messages), 10);
  EXPECT_LT(film.messages.size(), whole.messages.size());
  const auto count = [&](const std::vector<Belief>& beliefs) {
    return std::ranges::count_if(beliefs,
                                 [&](const Belief& b) { return is_promised(film.kept_beliefs, b.at_us, b.body < 2); });
  };
  EXPECT_EQ(count(film.beliefs), count(whole.beliefs));
  EXPECT_GT(count(film.beliefs), 1000);
  const auto states = [&](const std::vector<Declared>& all) {
    return std::ranges::count_if(all,
                                 [&](const Declared& s) { return is_promised(film.kept_states, s.at_us, s.body < 2); });
  };
  EXPECT_EQ(states(film.states), states(whole.states));
  EXPECT_GT(states(film.states), 100);
  EXPECT_LT(film.states.size(), whole.states.size());
}

}  // namespace
}  // namespace fleetproof::web::replay_page_test
