#include "reports/web/replay_page.hpp"

#include <fmt/format.h>

#include "reports/html/section_tables.hpp"
#include "reports/web/assets.hpp"
#include "reports/web/clearance_chart.hpp"
#include "reports/web/film_budget.hpp"
#include "reports/web/film_json.hpp"
#include "reports/web/film_tables.hpp"

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

Element header_of(const Film& film) {
  Element header("header");
  header.add(text_element("p", "fleetproof replay", {{"class", "kicker"}}));
  header.add(text_element("h1", film.title));
  Element story("div", {{"class", film.failed ? "story failed" : "story"}});
  for (const std::string& sentence : film.story) story.add(text_element("p", sentence));
  header.add(Element("div", {{"class", "head"}}).add(story).add(facts_of(film)));
  Element command("p", {{"class", "again"}});
  return header.add(command.add(text_element("span", "Again: ")).add(text_element("code", film.command)));
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

Element reading_part() {
  return text_element("p",
                      "Words of this page. Safety perimeter: the footprint, widened by the safety distance. Hull "
                      "(envelope): what an AGV sweeps during the drive or turn under way, widened likewise. Belief: "
                      "where an agent, the control software under test, says another AGV was. Age: time since then, or "
                      "since a message was sent.",
                      {{"class", "words"}});
}

std::string script_of(const std::string& json) {
  return fmt::format("<script type=\"application/json\" id=\"film\">{}</script>\n<script>//<![CDATA[\n{}//]]></script>",
                     json, script_text());
}

}  // namespace

std::string replay_page(Film film) {
  Element tables("div", {{"id", "record"}});
  if (!film.strip.frames.empty()) tables.add(pictures_part(film));
  for (const Element& part : table_parts(film)) tables.add(part);
  keep_within(film);
  if (!film.left_out.empty()) tables.add(left_out_part(film));
  std::string body = header_of(film).str();
  body +=
      Element("noscript")
          .add(text_element("p", "Scripts are off. The pictures, the clearance and the tables below show the failure.",
                            {{"class", "note"}}))
          .str();
  body += player_markup();
  if (!film.clearances.empty()) body += clearance_part(film).str();
  body += tables.str() + reading_part().str();
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">{}<body><main>{}</main>{}</body></html>\n", head_of(film),
                     body, script_of(film_json(film)));
}

}  // namespace fleetproof::web
