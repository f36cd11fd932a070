#include "reports/replay_page/replay_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/markup/section_tables.hpp"
#include "reports/replay_page/assets.hpp"
#include "reports/replay_page/clearance_chart.hpp"
#include "reports/replay_page/drive_reasons.hpp"
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

Element header_of(const Film& film, const ReasonLine* decisive) {
  Element header("header");
  header.add(text_element("p", kicker_of(film), {{"class", "kicker"}}));
  header.add(text_element("h1", film.title));
  Element story("div", {{"class", film.failed || !film.involved.empty() ? "story failed" : "story"}});
  const auto instant = [&](const ReasonLine& line, const char* name) {
    return text_element("p", line.text, {{"class", name}, {"data-us", fmt::format("{}", line.at_us)}});
  };
  for (std::size_t i = 0; i < film.story.size(); ++i) {
    story.add(text_element("p", film.story[i]));
    if (i == 0 && decisive != nullptr) story.add(instant(*decisive, "decisive"));
  }
  for (const ReasonLine& line : given_delivery_lines(film)) story.add(instant(line, "given"));
  return header.add(story);
}

Element reason_element(const Reason& reason) {
  Element box("div", {{"class", "reason"}});
  box.add(text_element("h3", reason.title));
  for (const ReasonLine& line : reason.lines) {
    constexpr const char* kClasses[] = {"sentence", "head-line", "item"};
    box.add(text_element(
        "p", line.text,
        {{"class", fmt::format("{}{}", kClasses[static_cast<std::size_t>(line.rank)], line.marked ? " marked" : "")},
         {"data-us", fmt::format("{}", line.at_us)}}));
  }
  return box;
}

// The reasons of what is fatal, side by side; the others stand in the data of the page.
Element reasons_part(const std::vector<Reason>& reasons) {
  Element part("div", {{"class", "reasons"}, {"id", "reasons"}});
  for (const Reason& reason : reasons) {
    if (reason.is_fatal) part.add(reason_element(reason));
  }
  return part;
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
  return part.add(list);
}

// Where the decision fell; without one, as the story says.
void open_at_decision(Film& film, const std::vector<Reason>& reasons) {
  if (!film.violations.empty() && !reasons.empty() && reasons.front().is_fatal && reasons.front().activity)
    film.open_us = std::min(film.open_us, reasons.front().decided_us);
}

std::string script_of(const std::string& json) {
  return fmt::format("<script type=\"application/json\" id=\"film\">{}</script>\n<script>//<![CDATA[\n{}//]]></script>",
                     json, script_text());
}

}  // namespace

std::string replay_page(Film film) {
  const std::vector<Reason> reasons = drive_reasons(film);
  const ReasonLine* decisive = reasons.empty() || !reasons.front().is_fatal ? nullptr : reasons.front().decisive();
  open_at_decision(film, reasons);
  Element tables("div", {{"id", "record"}});
  const EventLog event_log = event_log_of(film);
  if (!event_log.lines.empty()) tables.add(event_log_part(event_log));
  if (!film.clearances.empty()) tables.add(clearance_part(film));
  if (!film.strip.frames.empty()) tables.add(pictures_part(film));
  for (const Element& part : table_parts(film)) tables.add(part);
  keep_within(film);
  if (!film.left_out.empty()) tables.add(left_out_part(film));
  std::string body = header_of(film, decisive).str();
  body += Element("noscript")
              .add(text_element("p", "Scripts are off. The words, the pictures and the tables show the failure.",
                                {{"class", "note"}}))
              .str();
  body += reasons_part(reasons).str();
  body += player_markup();
  body += tables.str() + run_part(film).str() + words_part(film).str();
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">{}<body><main>{}</main>{}</body></html>\n", head_of(film),
                     body, script_of(film_json(film, reasons)));
}

}  // namespace fleetproof::web
