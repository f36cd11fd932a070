#include "reports/replay_page/replay_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "reports/markup/section_tables.hpp"
#include "reports/replay_page/assets.hpp"
#include "reports/replay_page/clearance_chart.hpp"
#include "reports/replay_page/differences.hpp"
#include "reports/replay_page/event_log_part.hpp"
#include "reports/replay_page/film_budget.hpp"
#include "reports/replay_page/film_json.hpp"
#include "reports/replay_page/film_tables.hpp"
#include "reports/replay_page/given_delivery_lines.hpp"

namespace fleetproof::web {
namespace {

using html::Element;
using html::text_element;
using html::titled;

// The scripts and the data stand in the page itself, so nothing may be fetched from anywhere.
constexpr const char* kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

std::string head_of(const Film& film) {
  std::string head = Element("meta", {{"charset", "utf-8"}}).str();
  head += Element("meta", {{"http-equiv", "Content-Security-Policy"}, {"content", kPolicy}}).str();
  head += Element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}).str();
  head += kReplayPageMark;
  head += text_element("title", film.title).str();
  return fmt::format("<head>{}<style>/*<![CDATA[*/\n{}/*]]>*/</style></head>", head, style_text());
}

Element facts_of(const Film& film) {
  Element list("dl", {{"class", "facts"}});
  for (const auto& [name, value] : film.facts) {
    Element fact("div");
    fact.add(text_element("dt", name)).add(text_element("dd", value));
    list.add(fact);
  }
  return list;
}

// "fleetproof replay, layout ring, AGVs 5, loss 40 %": what one wants to know of the run before its story.
std::string kicker_of(const Film& film) {
  std::string text = "fleetproof replay";
  for (const char* wanted : {"layout", "AGVs", "loss", "delay"}) {
    const auto fact = std::ranges::find(film.facts, wanted, &FilmFact::name);
    if (fact != film.facts.end()) text += fmt::format(" \u00b7 {} {}", fact->name, fact->value);
  }
  return text;
}

Element header_of(const Film& film, const std::string& lead) {
  Element header("header");
  header.add(text_element("p", kicker_of(film), {{"class", "kicker"}}));
  header.add(text_element("h1", film.title));
  Element story("div", {{"class", film.failed || !film.involved.empty() ? "story failed" : "story"}});
  for (std::size_t i = 0; i < film.story.size(); ++i) {
    story.add(text_element("p", film.story[i]));
    if (i == 0 && !lead.empty()) story.add(text_element("p", lead, {{"class", "decisive"}}));
  }
  for (const GivenDeliveryLine& line : given_delivery_lines(film))
    story.add(text_element("p", line.text, {{"class", "given"}, {"data-us", fmt::format("{}", line.at_us)}}));
  return header.add(story);
}

// At the bottom: names of files may tell a cause that one wants to see first.
Element run_part(const Film& film) {
  Element part = titled("This run");
  part.add(facts_of(film));
  Element command("p", {{"class", "again"}});
  return part.add(command.add(text_element("span", "Again: ")).add(text_element("code", film.command)));
}

Element clearance_part(const Film& film) {
  Element part = titled("Clearance over time");
  part.add(html::paragraph(
      "Between the footprints of the two bodies, to the micrometre. Below the dashed line the safety distance is "
      "broken."));
  if (film.nearest) part.add(html::paragraph("No violation was filed: this pair came closest of all."));
  for (std::size_t i = 0; i < film.clearances.size(); ++i) part.add(draw_clearance(film, i));
  return part;
}

Element pictures_part(const Film& film) {
  Element part = titled(film.is_about_nearest() ? "The closest approach in pictures" : "The failure in pictures");
  return part.add(html::draw(film.strip));
}

Element left_out_part(const Film& film) {
  Element part = titled("What this page leaves out"), list("ul");
  for (const std::string& sentence : film.left_out) list.add(text_element("li", sentence));
  part.add(list);
  return part.add(html::paragraph("The option --trace of the command above prints everything."));
}

// How one's own software says what its messages are, where it does not.
Element undescribed_part(const Film& film) {
  std::set<std::string> kinds, senders;
  for (const Message& message : film.messages) {
    if (message.is_described) continue;
    kinds.insert(message.kind);
    senders.insert(film.bodies[message.sender].name);
  }
  Element part("div", {{"id", "undescribed"}});
  const auto some = [](const std::set<std::string>& all) {
    constexpr std::size_t kMost = 4;
    std::string text;
    for (std::size_t i = 0; const std::string& one : all) {
      if (i == kMost && all.size() > kMost + 1) return text + fmt::format(" and {} more", all.size() - i);
      text += (i == 0 ? "" : i + 1 == all.size() ? " and " : ", ") + one;
      ++i;
    }
    return text;
  };
  part.add(
      html::paragraph(fmt::format("The messages of {} are not described: each is named by its size ({}). To give a "
                                  "message a kind and a content, call "
                                  "describe before it is sent, in the same activation. It changes no result.",
                                  some(senders), some(kinds))));
  constexpr const char* kCalls =
      "host->describe(controller, \"GRANT: lane 3\");   // C, C++: then host->send_unicast(...)\n"
      "[\"describe\", \"GRANT: lane 3\"]               // lockstep: then [\"send_unicast\", ...]\n"
      "agv.describe(\"GRANT: lane 3\")                 # Python: then agv.send(...)";
  return part.add(Element("pre").add(Element("code").lines(kCalls)));
}

Element words_part(const Film& film) {
  Element part = titled("Words of this page"), list("dl", {{"class", "words"}});
  const auto add = [&](const std::string& word, const std::string& meaning) {
    list.add(Element("div").add(text_element("dt", word)).add(text_element("dd", meaning)));
  };
  add("safety perimeter", "the footprint, widened by the safety distance");
  add("hull (envelope)", "what an AGV sweeps during the drive or turn under way, widened by the safety distance");
  add("belief", "where an agent, the control software under test, says another AGV was");
  add("age", "time since then, or since a message was sent");
  for (const auto& [word, meaning] : film.glossary) add(word, meaning);
  if (!film.glossary.empty())
    part.add(html::paragraph("Words of agents are explained as the agents of this project use them."));
  part.add(list);
  const bool all_described = std::ranges::all_of(film.messages, &Message::is_described);
  return all_described ? part : part.add(undescribed_part(film));
}

// Found in the smallest case, in which other AGVs may fail.
std::string lead_of(const ExplainedPart& explained) {
  const std::string& lead = explained.run.lead;
  const bool is_here = explained.shows == ExplainedPart::Shows::Smallest;
  return lead.empty() || is_here ? lead : "In the smallest case that fails in the same way: " + lead;
}

// Where the bodies of a violation set off for what they did then; if that is not known, as the story says.
void open_where_they_set_off(Film& film) {
  if (film.violations.empty()) return;
  for (const std::size_t body : film.involved) {
    const ActivityBar* last = nullptr;
    for (const ActivityBar& bar : film.activities) {
      if (bar.body == body && bar.begin_us <= film.focus_us) last = &bar;
    }
    const bool went_on = last != nullptr && film.focus_us <= last->end_us;
    if (went_on) film.open_us = std::min(film.open_us, last->commanded_us.value_or(last->begin_us));
  }
}

std::string script_of(const std::string& json) {
  return fmt::format("<script type=\"application/json\" id=\"film\">{}</script>\n<script>//<![CDATA[\n{}//]]></script>",
                     json, script_text());
}

}  // namespace

std::string replay_page(Film film, const ExplainedPart& explained) {
  open_where_they_set_off(film);
  Element tables("div", {{"id", "record"}});
  const EventLog event_log = event_log_of(film);
  if (explained.failing != nullptr) tables.add(differences_part(*explained.failing, film, explained.small_page));
  if (!event_log.lines.empty()) tables.add(event_log_part(event_log));
  if (!film.clearances.empty()) tables.add(clearance_part(film));
  if (!film.strip.frames.empty()) tables.add(pictures_part(film));
  for (const Element& part : table_parts(film)) tables.add(part);
  keep_within(film);
  if (!film.left_out.empty()) tables.add(left_out_part(film));
  std::string body = header_of(film, lead_of(explained)).str();
  body += Element("noscript")
              .add(text_element("p", "Scripts are off. The words, the pictures and the tables show the failure.",
                                {{"class", "note"}}))
              .str();
  body += explained_part(explained).str();
  body += player_markup();
  body += tables.str() + run_part(film).str() + words_part(film).str();
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">{}<body><main>{}</main>{}</body></html>\n", head_of(film),
                     body, script_of(film_json(film)));
}

}  // namespace fleetproof::web
