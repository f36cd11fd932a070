#include <array>

#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/workers/worker.hpp"

int main(int argc, char** argv) {
  using namespace fleetproof::cli;
  fleetproof::serve_if_called(argc, argv);
  open_standard_streams();
  constexpr std::array verbs = {
      Verb{"run", "run a campaign and leave its results in a file",
           "fleetproof run tests/campaigns/demo.toml --db demo.db", prepare_run},
      Verb{"merge", "put the shards of a campaign together to one results file, and judge it",
           "fleetproof merge out --db night.db", prepare_merge},
      Verb{"missing", "say which shards of a campaign have to run again", "fleetproof missing out --array",
           prepare_missing},
      Verb{"submit", "give the shards of a campaign to the job engine of a cluster, and the merge after them",
           "fleetproof submit tests/campaigns/demo.toml --shards 8 --out shards --go", prepare_submit},
      Verb{"report", "judge a results file and tell what it shows", "fleetproof report demo.db --format markdown",
           prepare_report},
      Verb{"replay", "simulate one run of a campaign again and compare it to the bit", "fleetproof replay demo.db 17",
           prepare_replay},
      Verb{"verify", "check every row of a results file, and simulate a sample of its runs again",
           "fleetproof verify demo.db --sample 5%", prepare_verify},
      Verb{"plan", "run a short pilot and forecast the time and the bounds of a campaign",
           "fleetproof plan tests/campaigns/demo.toml --max-time 5h", prepare_plan},
      Verb{"shrink", "find the smallest case that fails in the same way as a run",
           "fleetproof shrink demo.db 11 -o case.json", prepare_shrink},
      Verb{"explain", "say why a run fails: what it needs, what does not matter, when it was decided",
           "fleetproof explain demo.db 7", prepare_explain},
      Verb{"findings", "group the failures of a campaign by what they need: its findings",
           "fleetproof findings demo.db --file findings.toml", prepare_findings},
      Verb{"retest", "play known findings and a thousand neighbours of each with other software",
           "fleetproof retest findings.toml --agent hull-lock", prepare_retest},
      Verb{"simulate", "simulate one scenario file",
           "fleetproof simulate tests/scenarios/figure4.json --law exact --json", prepare_simulate},
      Verb{"generate", "draw the layout of a family and a seed, as JSON and as a picture",
           "fleetproof generate fishbone --seed 7 -o layout.json --svg layout.svg", prepare_generate},
      Verb{"import", "turn a layout of another program into a layout file, and back into LIF or CSV",
           "fleetproof import opentcs tests/layouts/crossdock.xml -o crossdock.json", prepare_import},
      Verb{"check", "check a campaign or scenario file, with a second of trial runs of a campaign",
           "fleetproof check tests/campaigns/demo.toml", prepare_check},
      Verb{"evidence", "compute one figure of evidence from counts: bounds, plans, gates, comparisons",
           "fleetproof evidence clopper-pearson --failing 3 --units 1000 --confidence 0.95", prepare_evidence},
      Verb{"compare", "compare two releases: what is worse, better, not worse, or not to be told",
           "fleetproof compare old.db new.db --fail-on-regression", prepare_compare},
      Verb{"sensitivity", "run agents with planted faults in the worlds of a campaign, and say which faults it detects",
           "fleetproof sensitivity tests/campaigns/standard-short.toml --runs 1000", prepare_sensitivity},
      Verb{"new", "write the standard campaign, or control software of your own, to start from",
           "fleetproof new campaign night.toml", prepare_new},
      Verb{"list", "list agents, laws, generators, importers, reports or fields", "fleetproof list agents",
           prepare_list},
  };
  return run_command_line(verbs, argc, argv);
}
