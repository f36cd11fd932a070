"""Reads the pages: sections by title, each with its tables, sentences and drawings."""
import re
import xml.etree.ElementTree as xml


class Section:
    def __init__(self):
        self.tables, self.sentences, self.drawings, self.failing = [], [], {}, []


def all_text(node):
    return "".join(node.itertext())


def says_what_it_folds(summary, details):
    """Whether a line such as "24 rows, 3 notes" counts what it hides."""
    rows, items = len(details.findall(".//tbody/tr")), len(details.findall("ul/li"))
    said = re.fullmatch(r"(?:([0-9]+) (?:row|fact)s?)?(?:, )?(?:([0-9]+) (?:note|sentence)s?)?", all_text(summary))
    return said is not None and (int(said[1] or 0), int(said[2] or 0)) == (rows, items)


def read_html(text):
    """title -> Section. The part above the first heading has the title "". Every text of the body is in a section."""
    page = xml.fromstring(text.split("\n", 1)[1])
    for node in page.iter():
        node.tag = node.tag.rpartition("}")[2]  # drawings have a namespace
    body = page.find("body/main")
    sections = {"": Section()}

    def visit(node, section):
        if node.tag == "table":
            section.tables.append([[all_text(cell) for cell in row] for row in node.iter("tr")])
        elif node.tag == "svg":
            texts = [all_text(each) for each in node.iter() if each.tag in ("text", "title")]
            section.drawings.setdefault(node.get("aria-label"), texts)
        elif node.tag == "div" and node.get("class") == "failing":
            section.failing = [all_text(each) for each in node.iter("li")]
        elif node.tag == "details":
            for child in node:
                if child.tag != "summary" or not says_what_it_folds(child, node):
                    visit(child, section)
        elif node.tag in ("p", "li", "h1", "h3", "figcaption", "strong", "summary"):
            whole = (node.text or "") + "".join(each.tail or "" for each in node)
            section.sentences.append(whole)
            for child in node:
                visit(child, section)
        else:
            for child in node:
                visit(child, section)

    for node in body:
        title = node.find("h2")
        section = sections[""] if title is None else sections.setdefault(all_text(title), Section())
        visit(node, section)
    return sections


def read_text(text):
    """title -> Section; rows are lists of words. Names of groups stand in front of their rows again."""
    lines = text.split("\n")
    sections, section = {"": Section()}, None
    section = sections[""]
    for i, line in enumerate(lines):
        if set(line) == {"-"} and i and len(lines[i - 1]) == len(line):
            section.sentences.pop()
            section = sections.setdefault(lines[i - 1], Section())
        else:
            section.sentences.append(line)
    for section in sections.values():
        rows, group, sentences, depth = [], [], [], 0
        for line in section.sentences:
            is_row = line.startswith("  ") and not line.startswith(("  * ", "    "))
            if re.match(r" [^ ]", line):
                group = line.split()
            elif is_row and not sentences:
                rows.append((group if rows else []) + line.split())
            elif line.startswith(("  * ", "    - ")) or not line.startswith("    "):
                sentences.append(line.strip())
            else:
                sentences[-1:] = [" ".join([*sentences[-1:], line.strip()])]
        if rows:
            section.tables.append(rows)
        section.sentences = sentences
    return sections
