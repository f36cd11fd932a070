#pragma once

#include <string>
#include <string_view>
#include <vector>

// The rules of the official schemas and of the tables in the text of VDA 5050, as a table of our own. It is written
// from the standard and knows nothing of the code that it checks.
namespace fleetproof::test {

// Which rules a message breaks, each as "nodes[0].actions[1].blockingType: must be one of NONE|SOFT|HARD". A field that
// the version does not have breaks a rule, too. `version` is "2.0.0" or "2.1.0", `topic` the word of a topic.
std::vector<std::string> broken_rules(std::string_view json, std::string_view topic, std::string_view version);

}  // namespace fleetproof::test
