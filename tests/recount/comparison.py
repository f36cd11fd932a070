"""The comparison with a baseline: pairs of worlds, exact tests, and the interval of the difference."""
from math import comb
from fractions import Fraction

import wording as w
from bounds import fixed_share

END_POINTS = ("violation", "contact", "deadlock", "livelock", "starvation", "wrong-load", "crash", "hang")
RISK, MARGIN = 0.05, 0.05


def agents_under_test(archive):
    return [agent for agent in archive.agents if archive.is_under_test(agent)]


def cells_of(archive, agent):
    return [cell["cell"] for cell in archive.cells if cell["agent"] == agent]


def failing_worlds(archive, agent, end_point):
    """Worlds in which the agent failed, or in which it stayed unknown whether it did."""
    return {row["replicate"] for row in archive.results(end_point, cells_of(archive, agent)) if row["result"]}


def at_least(successes, trials):
    """P(X >= successes) of a fair coin, exactly."""
    return Fraction(sum(comb(trials, i) for i in range(successes, trials + 1)), 2**trials)


def hypergeometric(first, first_of, second, second_of):
    """P(first or fewer failures in the first group), given the margins."""
    failing, everyone = first + second, comb(first_of + second_of, first + second)
    return Fraction(sum(comb(first_of, i) * comb(second_of, failing - i) for i in range(0, first + 1)
                        if failing - i <= second_of), everyone)


def difference(one, one_of, other, other_of, risk):
    """Bounds of share(one) - share(other), each part with half of the risk."""
    lower_one, upper_one = fixed_share(one, one_of, risk / 2)
    lower_other, upper_other = fixed_share(other, other_of, risk / 2)
    return lower_one - upper_other, upper_one - lower_other


def signed(share, upwards):
    text = w.directed(abs(100.0 * share), upwards == (share >= 0.0))
    return ("-" if share < 0.0 else "+") + text


def row_of(old, new, agent, end_point, paired):
    """The row of an end point, without the number of worlds that would tell."""
    before, now = failing_worlds(old, agent, end_point), failing_worlds(new, agent, end_point)
    old_worlds, new_worlds = old.replicates, new.replicates
    if paired:
        old_worlds = new_worlds = min(old_worlds, new_worlds)
        before, now = ({world for world in worlds if world < old_worlds} for worlds in (before, now))
        only_old, only_new = len(before - now), len(now - before)
        worse, improved = (at_least(count, only_old + only_new) for count in (only_new, only_old))
        parts = (only_new, new_worlds, only_old, old_worlds)
    else:
        only_old = only_new = "-"
        worse = hypergeometric(len(before), old_worlds, len(now), new_worlds)
        improved = hypergeometric(len(now), new_worlds, len(before), old_worlds)
        parts = (len(now), new_worlds, len(before), old_worlds)
    lower, upper = difference(*parts, RISK / 2)
    change = "cannot tell"
    if worse <= RISK:
        change = "worse"
    elif improved <= RISK:
        change = "improved"
    elif difference(*parts, RISK)[1] <= MARGIN:
        change = "not worse within the margin"
    return [agent, end_point, change, f"{len(before)}/{old_worlds}", f"{len(now)}/{new_worlds}", str(only_old),
            str(only_new), f"[{signed(lower, False)}, {signed(upper, True)}]"]


def newly_failing(old, new, agent):
    """Runs of the new release that fail at some end point, where the run of the old one did not."""
    worlds = min(old.replicates, new.replicates)
    places = []
    for archive in (old, new):
        own = cells_of(archive, agent)
        places.append({(row["replicate"], own.index(row["cell"])): row["run_index"] for end_point in END_POINTS
                       for row in archive.results(end_point, own) if row["result"] and row["replicate"] < worlds})
    before, now = places
    return sorted(now[place] for place in now.keys() - before.keys()), len(before.keys() - now.keys())
