#!/usr/bin/env python3
"""Reads layout files of other programs by itself, and compares what it finds with what fleetproof imports:
survey.py PROGRAM FILE_OR_FOLDER...

Prints a table, one row for each file, and each difference below; exit code 1 if there is one. A file that fleetproof
refuses is a difference unless the survey finds the fault, too.
"""
import os
import subprocess
import sys
import tempfile
from collections import Counter

import geojson_plant
import lif_plant
import opentcs_plant
import rmf_plant
import smap_plant
import table_plant

FORMATS = {".lif.json": ("lif", lif_plant.read), ".xml": ("opentcs", opentcs_plant.read),
           ".yaml": ("rmf", rmf_plant.read), ".geojson": ("geojson", geojson_plant.read),
           ".smap": ("smap", smap_plant.read), ".map": ("grid", table_plant.read_grid),
           ".csv": ("csv", table_plant.read_csv), ".json": ("layout", table_plant.read_layout)}
SMALLEST_CORE = 0.9
CAMPAIGN = """horizon_s = 10
[factors]
agents = ["hull-lock"]
layouts = [{ file = "%s"%s }]
fleet_sizes = [1]
%s"""


def format_of(path):
    return next((entry for ending, entry in FORMATS.items() if path.endswith(ending)), None)


def files_in(words):
    for word in words:
        if os.path.isdir(word):
            for folder, _, names in sorted(os.walk(word)):
                yield from (os.path.join(folder, name) for name in sorted(names) if format_of(name))
        else:
            yield word


def options_of(path):
    """`plant@level.yaml` is read with this level, `plant@level@2.yaml` with this level and graph as well."""
    words = os.path.basename(path).split(".")[0].split("@")[1:]
    return dict(zip(("level", "graph"), (word if i == 0 else int(word) for i, word in enumerate(words))))


def same_place(mine, theirs):
    return all(abs(a - b) < 1e-6 for a, b in ((mine.x, theirs.x), (mine.y, theirs.y)))


def compare(mine, theirs):
    """Sentences."""
    found = []
    for name in sorted(set(mine.stations) | set(theirs.stations)):
        a, b = mine.stations.get(name), theirs.stations.get(name)
        if a is None or b is None:
            found.append(f"station {name} is {'not in the file' if a is None else 'not imported'}")
        elif not same_place(a, b):
            found.append(f"station {name} stands at {a.x} {a.y}, imported at {b.x} {b.y}")
        elif a.rules() != b.rules():
            found.append(f"station {name} is {a.rules()}, imported as {b.rules()}")
    surveyed, imported = Counter(d.rules() for d in mine.drives), Counter(d.rules() for d in theirs.drives)
    found += [f"drive {rules} is not imported" for rules in (surveyed - imported)]
    found += [f"drive {rules} is imported and not in the file" for rules in (imported - surveyed)]
    return found or compare_lengths(mine, theirs)


def compare_lengths(mine, theirs):
    found, by_rules = [], {}
    for drive in theirs.drives:
        by_rules.setdefault(drive.rules(), []).append(drive.length)
    for drive in mine.drives:
        nearest = min(by_rules[drive.rules()], key=lambda length: abs(length - (drive.length or length)))
        if drive.length is not None and abs(nearest - drive.length) > 0.001 + 0.005 * drive.length:
            found.append(f"drive {drive.rules()} has {drive.length:.4f} m, imported with {nearest:.4f} m")
    return found


class Survey:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.differences = []

    def run(self, *words):
        return subprocess.run([self.program, *words], capture_output=True, text=True, timeout=600)

    def checked(self, path, plant, core_only):
        """What `check` says to a campaign on this file, with the types of vehicles that the file names."""
        choice = "".join(f", {key} = {value!r}".replace("'", '"') for key, value in options_of(path).items())
        campaign = os.path.join(self.folder, "campaign.toml")
        with open(campaign, "w", encoding="utf-8") as file:
            file.write(CAMPAIGN % (os.path.abspath(path), choice + (", core_only = true" if core_only else ""),
                                   "".join(f'[[vehicle]]\nname = "{name}"\n' for name in plant.types())))
        return self.run("check", campaign)

    def usable(self, path, plant):
        """As it is, or what has to be done; a refusal in its own words."""
        whole = self.checked(path, plant, False)
        if whole.returncode == 0:
            return "as it is"
        if self.checked(path, plant, True).returncode == 0:
            return "with core_only"
        reason = whole.stderr.strip().split("\n")[-1]
        if whole.returncode != 2 or not reason.startswith("error: "):
            self.differences.append(f"{path}: check ends with {whole.returncode} and {reason!r}")
        return "refused: " + reason

    def survey(self, path):
        kind, read = format_of(path)
        options = options_of(path)
        words = [word for key, value in options.items() for word in (f"--{key}", str(value))]
        layout = os.path.join(self.folder, "layout.json")
        imported = self.run("import", kind, path, "-o", layout, *words)
        mine = None
        try:
            mine = read(path, **options)
        except (ValueError, LookupError, TypeError, StopIteration) as error:
            if imported.returncode == 0:
                self.differences.append(f"{path}: the survey cannot read it ({error!r}), and it is imported")
            return [imported.stderr.strip().split("\n")[-1]]
        if imported.returncode != 0:
            reason = imported.stderr.strip().split("\n")[-1]
            if not any(fault in reason for fault in mine.faults) and mine.drives:
                self.differences.append(f"{path}: refused, and the survey finds no fault: {reason}")
            return [reason]
        theirs = table_plant.read_layout(layout)
        found = compare(mine, theirs)
        if found and mine.drawn:
            drawn = read(path, drawn=True)
            found, mine = min((found, mine), (compare(drawn, theirs), drawn), key=lambda pair: len(pair[0]))
        found += [f"{fault} is a fault, and is imported" for fault in mine.faults]
        self.differences += [f"{path}: {sentence}" for sentence in found]
        return row_of(mine) + [self.usable(path, mine)]


def row_of(plant):
    drives, stations = plant.drives, plant.stations.values()
    def purpose(word):
        return sum(word in s.purposes for s in stations)
    return [len(stations), len(drives), f"{sum(d.length or 0.0 for d in drives):.2f}",
            *(purpose(word) for word in ("storage", "charging", "parking")),
            sum(d.limit is not None for d in drives), sum(d.first == "backward" for d in drives),
            sum(d.permissions != (("", "any"),) for d in drives), sum(bool(d.blocks) for d in drives),
            sum(s.heading is not None for s in stations), sum(not s.turning for s in stations),
            f"{100.0 * plant.core_share():.0f} %"]


def main(program, *words):
    print("file | stations | drives | metres | storage | charging | parking | limited | backward | permissions | blocks "
          "| headings | no turning | core | in a campaign")
    with tempfile.TemporaryDirectory() as folder:
        survey = Survey(program, folder)
        for path in files_in(words):
            print(" | ".join(map(str, [os.path.basename(path), *survey.survey(path)])))
    print("\n" + ("\n".join(survey.differences) or "no difference"))
    return 1 if survey.differences else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
