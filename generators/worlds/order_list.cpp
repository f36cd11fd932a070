#include "generators/worlds/order_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "generators/text/csv_fields.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"
#include "generators/text/xml_text.hpp"
#include "generators/worlds/transports.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kColumns[] = {"release_s", "from", "to", "agv"};
constexpr double kLatestRelease_s = 1e6;
constexpr std::uint32_t kMostAgvs = 1000;

class OrderReader {
 public:
  OrderReader(std::string_view text, std::string_view source) : lines_(text), source_(source) {}

  OrderList read() {
    list_.source = std::filesystem::path(source_).filename().string();
    while (const auto line = lines_.next()) {
      if (is_csv_remark(*line)) continue;
      const auto fields = csv_fields(*line, source_, lines_.number());
      columns_.empty() ? take_heading(fields) : add(fields);
    }
    if (list_.orders.empty())
      throw InputError(source_, "has no orders; expected a line release_s,from,to,agv and one line for each order");
    return std::move(list_);
  }

 private:
  [[noreturn]] void refuse(std::string_view sentence) const {
    throw InputError(at_line(source_, lines_.number()), sentence);
  }

  void take_heading(const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (std::ranges::find(kColumns, fields[i]) == std::end(kColumns)) {
        refuse(fmt::format("{} is not a column of orders{}", in_quotes(fields[i]), name_hint(fields[i], kColumns)));
      }
      if (!columns_.emplace(fields[i], i).second)
        refuse(fmt::format("column {} occurs twice; keep one", in_quotes(fields[i])));
    }
    for (const auto needed : {"release_s", "from", "to"}) {
      if (!columns_.contains(needed))
        refuse(fmt::format("column {} is missing; the first line names release_s, from and to", needed));
    }
  }

  std::string field(const std::vector<std::string>& fields, std::string_view column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() || found->second >= fields.size() ? "" : fields[found->second];
  }

  std::string station(const std::vector<std::string>& fields, std::string_view column) const {
    auto name = field(fields, column);
    if (name.empty()) refuse(fmt::format("{} is empty; expected the name of a station", column));
    if (!is_plain_utf8(name))
      refuse(fmt::format("{} is {}; a name is UTF-8 without control characters", column, in_quotes(name)));
    return name;
  }

  void add(const std::vector<std::string>& fields) {
    if (fields.size() > columns_.size())
      refuse(fmt::format("the line has {} fields, its table {} columns", fields.size(), columns_.size()));
    ListedOrder order;
    order.line = lines_.number();
    const auto release = field(fields, "release_s");
    double release_s = 0.0;
    if (!read_number(release, release_s) || !(release_s >= 0.0 && release_s <= kLatestRelease_s)) {
      refuse(fmt::format("release_s is {}; expected seconds from 0 to 1e6", in_quotes(release)));
    }
    order.release = seconds(release_s);
    order.from = station(fields, "from");
    order.to = station(fields, "to");
    if (order.from == order.to)
      refuse(fmt::format("to is {}, where the order comes from; name another station", in_quotes(order.to)));
    if (const auto agv = field(fields, "agv"); !agv.empty()) {
      std::uint32_t number = 0;
      const auto [end, error] = std::from_chars(agv.data(), agv.data() + agv.size(), number);
      if (error != std::errc{} || end != agv.data() + agv.size() || number >= kMostAgvs) {
        refuse(fmt::format("agv is {}; expected a number from 0, or nothing for any AGV", in_quotes(agv)));
      }
      order.agv = number;
    }
    list_.orders.push_back(std::move(order));
  }

  TextLines lines_;
  std::string_view source_;
  std::map<std::string, std::size_t, std::less<>> columns_;
  OrderList list_;
};

// Names of stations where orders may begin and end.
class Ends {
 public:
  Ends(const Scenario& scenario, const Reachability& reachability)
      : layout_(scenario.map->layout()), reachability_(reachability) {
    for (std::size_t i = 0; i < layout_.stations.size(); ++i) stations_.emplace(layout_.stations[i].name, StationId{i});
  }

  // Whether the load of an order gets to its end.
  void expect_way(const ListedOrder& order, StationId from, StationId to, const std::string& place,
                  std::uint32_t type) const {
    if (reachability_.reaches(from, to, true, type)) return;
    throw InputError(place, fmt::format("no way leads from {} to {} for an AGV with a load; choose another station",
                                        in_quotes(order.from), in_quotes(order.to)));
  }

  // `column`: "from" or "to".
  StationId find(const std::string& name, std::string_view column, const std::string& place, std::uint32_t type) const {
    const auto found = stations_.find(name);
    if (found == stations_.end()) {
      std::vector<std::string_view> known;
      for (const auto& [known_name, id] : stations_) known.push_back(known_name);
      const auto nearest = nearest_name(name, known);
      throw InputError(
          place,
          fmt::format("{} is {}, but layout {} has no such station{}", column, in_quotes(name), in_quotes(layout_.name),
                      nearest ? "; did you mean " + in_quotes(*nearest) + "?" : "; correct the name"));
    }
    if (!may_end_orders(layout_.stations[found->second.index()])) {
      throw InputError(place, fmt::format("{} is {}, a station for charging or parking; orders begin and end elsewhere",
                                          column, in_quotes(name)));
    }
    const StationUse& use = reachability_.use_of(found->second, type);
    if (!reachability_.in_core(found->second)) {
      throw InputError(place, fmt::format("{} is {}, but there is no way from or to it; choose another station", column,
                                          in_quotes(name)));
    }
    const bool from = column == "from";
    if (!(from ? use.picks : use.drops)) {
      throw InputError(place, fmt::format("{} is {}, but the layout does not permit an AGV of this type to {} a load "
                                          "there (turns, headings, loads and types); choose another station",
                                          column, in_quotes(name), from ? "pick" : "drop"));
    }
    return found->second;
  }

 private:
  const Layout& layout_;
  const Reachability& reachability_;
  std::map<std::string, StationId> stations_;
};

}  // namespace

OrderList read_order_list(const std::string& path) { return parse_order_list(read_text_file(path), path); }

OrderList parse_order_list(std::string_view text, std::string_view source) { return OrderReader(text, source).read(); }

void assign_listed_orders(Scenario& scenario, const OrderList& list, const Reachability& reachability) {
  const Ends ends(scenario, reachability);
  const auto fleet = static_cast<std::uint32_t>(scenario.agvs.size());
  std::uint32_t free_orders = 0;
  for (auto& agv : scenario.agvs) agv.transports.clear();
  for (const auto& order : list.orders) {
    const auto place = at_line(list.source, order.line);
    const auto agv = order.agv ? *order.agv : free_orders++ % fleet;
    if (agv >= fleet)
      throw InputError(place, fmt::format("agv is {}; a fleet of {} has AGVs 0 to {}", agv, fleet, fleet - 1));
    const std::uint32_t type = scenario.agvs[agv].type;
    const auto from = ends.find(order.from, "from", place, type), to = ends.find(order.to, "to", place, type);
    ends.expect_way(order, from, to, place, type);
    if (order.release < scenario.horizon) scenario.agvs[agv].transports.push_back({from, to, order.release});
  }
  for (auto& agv : scenario.agvs) std::ranges::stable_sort(agv.transports, {}, &TransportOrder::release);
}

}  // namespace fleetproof
