#!/usr/bin/env python3
"""Counts an archive again and compares every figure of its text and HTML page:
recount.py ARCHIVE TEXT HTML [BASELINE]
recount.py ARCHIVE --each FOLDER...   (page.txt and page.html in each)

Prints each difference; exit code 1 if there is one; of several folders, a line with their number for each. A sentence or a table with digits that nothing here computes is a
difference, too.
"""
import re
import sys
from collections import Counter
from itertools import zip_longest

import comparison as c
import drawings
import sentences as s
import tables as t
from conditions import conditions, provenance, safety_distance
from counts import Archive
from failures import Failures, discoveries
from known_sentences import explained
from pages import read_html, read_text
from reasons import numbers_of_gate, unexplained
from wording import count

DIFFERENCES = []
REASONS = {"text": set(), "html": set()}  # all numbers that a reason in the head of the page may have


def differ(where, expected, shown):
    DIFFERENCES.append(f"{where}:\n    counted {expected}\n    shown   {shown}")


def same_rows(page, title, section, expected, columns=None):
    """The table of a section has these rows; `columns`: only so many of each row are compared."""
    shown = [row for table in section.tables[:1] for row in table][1:]
    if page == "text":
        expected = [" ".join(row).split() for row in expected]
    cut = [row[:columns] if columns else row for row in shown]
    if page == "text" and columns:
        cut = [row[:len(" ".join(one).split())] for row, one in zip(shown, expected)]
    if len(cut) < len(expected) and any("left out" in text for text in section.sentences):
        remaining = Counter(map(tuple, expected))
        for row in cut:
            if remaining[tuple(row)] == 0:
                differ(f"{page}, {title}", "no such row", row)
            remaining[tuple(row)] -= 1
        return
    if len(cut) != len(expected):
        differ(f"{page}, {title}", f"{len(expected)} rows", f"{len(cut)} rows")
    for one, other in zip(expected, cut):
        if list(one) != list(other):
            differ(f"{page}, {title}", one, other)


def check_tables(archive, page, sections):
    expected = {**t.condition_tables(archive), **t.group_tables(archive)}
    for title, rows in expected.items():
        if title not in sections:
            differ(page, f"a section {title}", "none")
        elif rows:
            same_rows(page, title, sections[title], rows)
    met = t.coverage_rows(archive)
    shown = [row for row in sections["What the runs met"].tables[0][1:] if "nobody" not in row] \
        if sections["What the runs met"].tables else []
    sections["What the runs met"].tables = [[[]] + shown] if shown else []
    same_rows(page, "What the runs met", sections["What the runs met"], met)
    same_rows(page, "What the other laws found", sections["What the other laws found"], t.incident_rows(archive), 4)


def check_gates(archive, page, section, head):
    rows = [row for table in section.tables for row in table][1:]
    for (expected, gate, counts), shown in zip(t.gate_rows(archive), rows):
        text = " ".join(shown)
        wanted = " ".join(cell for cell in expected if cell is not None)
        if not text.startswith(" ".join(wanted.split()) if page == "text" else wanted):
            differ(f"{page}, gates", wanted, text)
        allowed = numbers_of_gate(archive, gate, counts)
        for remark in map(plain, section.sentences):
            if remark.startswith(f"\"{gate['name']}\"") and "Why " in remark:
                wrong = unexplained(archive, allowed, remark.split("Why ", 1)[1])
                if wrong:
                    differ(f"{page}, gates", sorted(allowed), f"{wrong} in {remark}")
        REASONS[page] |= allowed
        if archive.search:
            continue
        pattern = re.escape(s.gate_sentence(gate, counts)).replace("UNIT", "(worlds|runs)")
        if not any(re.match(pattern, each) for each in map(plain, section.sentences)):
            differ(f"{page}, gates", s.gate_sentence(gate, counts), section.sentences)
        verdict = re.search(r"(not demonstrated|demonstrated|violated)( \(reported only\))?$", text)
        if verdict and verdict[1] == "demonstrated":
            archive.demonstrated.add(gate["gate"])
        distance = re.escape(safety_distance(archive))
        told = s.finding(gate, counts, verdict and verdict[1], distance)
        if told and gate["decides"]:
            about = [each for each in head
                     if re.search(s.subject(gate, "[0-9.]+ m"), each) and "within the contract region" not in each]
            if about and not any(re.search(told, each) for each in about):
                differ(f"{page}, claim", told, about)
    deciding = [row[-1] if page == "html" else " ".join(row) for (_, gate, _), row in zip(t.gate_rows(archive), rows)
                if gate["decides"]]
    for found in re.finditer(r"([0-9]+) of ([0-9]+) gates? \(acceptance criteri(?:on|a)\) (not demonstrated|demonstrated|"
                             "violated)", " ".join(head)):
        alike = sum(bool(re.search(r"(?<!not )" + found[3] + "$", text)) for text in deciding)
        if (alike, len(deciding)) != (int(found[1]), int(found[2])):
            differ(f"{page}, claim", f"{alike} of {len(deciding)}", found[0])
    if len(rows) != len(archive.gates):
        differ(f"{page}, gates", f"{len(archive.gates)} rows", f"{len(rows)} rows")


def plain(text):
    """Without the mark of a list, without the command that follows, and without what an agent says of its crash."""
    whole = " ".join(text.removeprefix("* ").removeprefix("- ").split(" -> ")[0].split())
    return re.sub(r' \((crash|hang): ".*"\):$', r" (\1):", whole)


def check_head(archive, page, sections):
    head = [plain(text) for text in sections[""].sentences]
    whole = " ".join(head)
    for sentence in [s.title(archive), *s.violation_headlines(archive)]:
        if sentence not in whole:
            differ(f"{page}, head", sentence, whole[:2000])
    check_gates(archive, page, sections["Gates (acceptance criteria)"], head)


def check_conditions(archive, page, section):
    """Exactly these, in this order: one row each, or one sentence."""
    rows = [row[:2] for row in section.tables[0]] if page == "html" else \
        [plain(text).split(": ", 1) for text in section.sentences if text.strip()]
    expected = [list(each) for each in conditions(archive).items()]
    for one, other in zip_longest(expected, rows):
        if one != other:
            differ(f"{page}, Conditions", one, other)


def check_provenance(archive, page, section):
    """Each of these, as a row or a sentence."""
    said = [": ".join(row[:2]) for table in section.tables for row in table] + [plain(text) for text in section.sentences]
    for name, value in provenance(archive).items():
        if value and f"{name}: {value}" not in said:
            differ(f"{page}, Provenance", f"{name}: {value}", said)


def check_html(archive, sections):
    maps = sections["Failures, throughput and safe mode by radio quality"].drawings
    for label, expected in drawings.field_maps(archive).items():
        if label not in maps and len(archive.conditions()) > 1000:
            continue
        shown = maps.get(label, [])[:len(expected)]  # the names of the axes follow
        if shown != expected:
            differ(f"html, {label}", expected, maps.get(label))
    close = sections["How close the bodies came"]
    for label, expected in list(drawings.clearance_bars(archive).items())[:12]:
        shown = [text for text in close.drawings.get(label, []) if text.endswith(" runs")]
        if shown != expected:
            differ(f"html, {label}", expected, close.drawings.get(label))
    if archive.runs:
        # Agents whose gates decide stand first.
        rows = sorted(t.clearance_rows(archive))
        close.tables[0][1:] = sorted(close.tables[0][1:])
        same_rows("html", "How close the bodies came", close, rows)
    failures = Failures(archive)
    check_failing_head(failures, sections[""].failing)
    check_failures(failures, sections["Runs in which something went wrong, by the failure that leads"])
    legends = [plain(text) for text in sections["Would more runs tell more?"].sentences]
    for legend in discoveries(archive, failures) if archive.runs else []:
        if legend not in legends:
            differ("html, discoveries", legend, legends)


def check_comparison(old, new, page, section):
    """Both archives have the same agents and cells; whether their conditions are the same, the page says."""
    sentences = [plain(text) for text in section.sentences]
    said = " ".join(sentences)
    same_worlds = f"both ran in the same {min(old.replicates, new.replicates)} worlds" in said
    may_tell, in_doubt = "nothing can be told: the campaigns differ in" not in said, "Doubt: " in said
    agents = c.agents_under_test(new)
    expected = [c.row_of(old, new, agent, end_point, may_tell, in_doubt) for agent in agents for end_point in c.END_POINTS]
    same_rows(page, "Compared with the baseline", section, expected, 8)
    for agent in agents if same_worlds else []:
        failing, passing = c.newly_failing(old, new, agent)
        told = f"{agent}: newly failing: {count(len(failing), 'run')}; newly passing: {count(passing, 'run')}."
        if told not in sentences:
            differ(f"{page}, newly failing", told, sentences)
        for run in failing[:10]:
            if f"Newly failing: run {run}" not in sentences:
                differ(f"{page}, newly failing", f"run {run}", sentences)


def check_failures(failures, section):
    """Where the page kept too few digests to tell, it says ">=" and has a smaller number."""
    for table in section.tables[:1]:
        for row, expected in zip(table[1:], failures.rows()):
            row[4:6] = [cell.replace(" ", "") for cell in row[4:6]]
            if row[5].startswith(">=") and int(row[5][2:]) <= int(expected[5]):
                row[5] = expected[5]
    if failures.groups or section.tables:
        same_rows("html", "failing runs", section, failures.rows())


def check_failing_head(failures, shown):
    """The worst run of the first groups, at the top of the page."""
    rows = failures.rows()
    expected = [f"run {run}: {agent}, {cause}" + (f" (one of {runs} runs)" if runs != "1" else "")
                for agent, _, cause, _, runs, _, run in rows[:6]]
    if len(rows) > 6:
        expected.append(f"{len(rows) - 6} more kind{'s' if len(rows) > 7 else ''}")
    if shown != expected:
        differ("html, failing runs of the head", expected, shown)


def check_rest(archive, page, sections):
    """Every other sentence with digits is one whose numbers are computed or are constants of the method."""
    confidences = {"95", *(f"{100.0 * gate['confidence']:g}" for gate in archive.gates)}
    for title, section in sections.items():
        for table in section.tables if title not in ("Conditions", "Provenance") else ():
            if not set(re.findall(r"([0-9.]+) %", " ".join(table[0]))) <= confidences:
                differ(f"{page}, {title}", f"a head with {confidences} %", table[0])
        for text in section.sentences if title != "Conditions" else ():
            if title == "" and "Why " in text:
                wrong = unexplained(archive, REASONS[page], plain(text).split("Why ", 1)[1])
                if wrong:
                    differ(f"{page}, head", sorted(REASONS[page]), f"{wrong} in {plain(text)}")
            elif re.search(r"[0-9]", text) and not explained(archive, plain(text)):
                differ(f"{page}, {title}", "no such sentence, or other numbers", plain(text))


def recount(archive, text, html, baseline=None):
    DIFFERENCES.clear()
    for page, path, read in (("text", text, read_text), ("html", html, read_html)):
        REASONS[page] = set()
        sections = read(open(path, encoding="utf-8").read())
        check_head(archive, page, sections)
        check_tables(archive, page, sections)
        check_conditions(archive, page, sections["Conditions"])
        check_provenance(archive, page, sections["Provenance"])
        if page == "html":
            check_html(archive, sections)
        if baseline:
            check_comparison(baseline, archive, page, sections["Compared with the baseline"])
        check_rest(archive, page, sections)
    return f"{len(DIFFERENCES)} differences" if DIFFERENCES else "no difference"


def main():
    path, *pages = sys.argv[1:]
    if pages[0] == "--each":
        said = [recount(Archive(path), f"{folder}/page.txt", f"{folder}/page.html") for folder in pages[1:]]
        for folder, each in zip(pages[1:], said):
            print(f"{folder}: {each}")
        return int(any(each != "no difference" for each in said))
    said = recount(Archive(path), *pages[:2], *map(Archive, pages[2:]))
    print("\n".join(DIFFERENCES[:40]))
    print(said)
    return int(bool(DIFFERENCES))


if __name__ == "__main__":
    sys.exit(main())
