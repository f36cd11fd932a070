"""The part of YAML in which Open-RMF writes its files: block maps and lists, with flow values at their ends."""
import re

TOKEN = re.compile(r'\s*("(?:[^"\\]|\\.)*"|\'(?:[^\']|\'\')*\'|[\[\]{},]|:(?=\s|$)|'
                   r'[^\[\]{},"\'\s](?:[^,\[\]{}:]|:(?!\s|$))*)')


def scalar(text):
    text = text.strip()
    if text[:1] == '"':
        return text[1:-1].replace('\\"', '"').replace("\\\\", "\\")
    if text[:1] == "'":
        return text[1:-1].replace("''", "'")
    if text in ("true", "True", "TRUE", "false", "False", "FALSE"):
        return text.lower() == "true"
    if text in ("", "~", "null"):
        return None
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            pass
    return text


class Flow:
    def __init__(self, text):
        self.tokens = TOKEN.findall(text)
        self.at = 0

    def is_open(self):
        return sum((token in "[{") - (token in "]}") for token in self.tokens) > 0

    def take(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def value(self):
        token = self.take()
        if token == "[":
            items = []
            while self.tokens[self.at] != "]":
                items.append(self.value())
                self.at += self.tokens[self.at] == ","
            self.at += 1
            return items
        if token == "{":
            items = {}
            while self.tokens[self.at] != "}":
                key = scalar(self.take())
                if self.tokens[self.at] == ":":
                    self.at += 1
                items[key] = self.value() if self.tokens[self.at] not in ",}" else None
                self.at += self.tokens[self.at] == ","
            self.at += 1
            return items
        return scalar(token)


def without_comment(line):
    for found in re.finditer(r"(^|\s)#", line):
        before = line[:found.start()]
        if before.count('"') % 2 == 0 and before.count("'") % 2 == 0:
            return before
    return line


def lines_of(text):
    for line in map(without_comment, text.splitlines()):
        if line.strip() and line.strip() not in ("---", "..."):
            yield len(line) - len(line.lstrip()), line.strip()


class Blocks:
    def __init__(self, text):
        self.lines = list(lines_of(text))
        self.at = 0

    def block(self, indent):
        """All lines from here on that stand at `indent`."""
        first = self.lines[self.at][1]
        return self.list(indent) if first == "-" or first.startswith("- ") else self.map(indent)

    def below(self, indent, in_list):
        """The value of a key or a dash without one on its line."""
        if self.at == len(self.lines):
            return None
        deeper, text = self.lines[self.at]
        # A list may stand as far left as its key.
        if deeper > indent or (not in_list and deeper == indent and text.startswith("-")):
            return self.flow(self.rest()) if text[0] in "[{" else self.block(deeper)
        return None

    def flow(self, text):
        """The flow value that begins with `text` and ends in the line that closes its brackets."""
        flow = Flow(text)
        while flow.is_open():
            text += " " + self.rest()
            flow = Flow(text)
        return flow.value()

    def rest(self):
        self.at += 1
        return self.lines[self.at - 1][1]

    def list(self, indent):
        items = []
        while self.at < len(self.lines) and self.lines[self.at][0] == indent and self.lines[self.at][1][0] == "-":
            text = self.lines[self.at][1][1:]
            inner = indent + 1 + len(text) - len(text.lstrip())
            text = text.strip()
            if not text:
                self.at += 1
                items.append(self.below(indent, True))
            elif text[0] not in "[{\"'" and re.search(r":(\s|$)", text) or text.startswith("- "):
                self.lines[self.at] = inner, text
                items.append(self.block(inner))
            else:
                self.at += 1
                items.append(self.flow(text))
        return items

    def map(self, indent):
        items = {}
        while self.at < len(self.lines) and self.lines[self.at][0] == indent:
            key, value = re.match(r'("[^"]*"|\'[^\']*\'|[^:]+?)\s*:(?:\s+(.*))?$', self.rest()).groups()
            items[scalar(key)] = self.below(indent, False) if not value else \
                self.flow(value) if value[0] in "[{" else scalar(value)
        return items


def load(text):
    blocks = Blocks(text)
    return blocks.block(blocks.lines[0][0])
