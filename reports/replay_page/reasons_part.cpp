#include "reports/replay_page/reasons_part.hpp"

#include <fmt/format.h>

namespace fleetproof::web {
namespace {

using html::Element;
using html::text_element;

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

}  // namespace

Element reasons_part(const std::vector<Reason>& reasons) {
  Element part("div", {{"class", "reasons"}, {"id", "reasons"}});
  for (const Reason& reason : reasons) {
    if (reason.is_fatal) part.add(reason_element(reason));
  }
  return part;
}

}  // namespace fleetproof::web
