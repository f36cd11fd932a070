"""Stands between the engine and a program, writes down every line of both, and tests them against the schema.

overheard.py record FILE WORD...: starts the program and passes every line on; FILE gets them, "<" before those to it.
overheard.py check FILE: how many lines of each kind there are; exit code 1, with the line, if the schema refuses one,
or if it takes one for a line of the other direction.
"""
import collections
import json
import os
import re
import subprocess
import sys
import threading

HERE = os.path.dirname(os.path.abspath(__file__))
SCHEMA = os.path.join(HERE, "..", "..", "..", "core", "sdk", "lockstep.schema.json")
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def record(path, words):
    child = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    with open(path, "ab", buffering=0) as file:

        def pass_on(mark, source, target):
            for line in iter(source.readline, b""):
                file.write(mark + line)
                target.write(line)
                target.flush()
            target.close()

        def pass_on_to_it():
            pass_on(b"<", sys.stdin.buffer, child.stdin)

        threading.Thread(target=pass_on_to_it, daemon=True).start()
        pass_on(b">", child.stdout, sys.stdout.buffer)
    os._exit(child.wait())


def is_of_type(value, name):
    if name in ("number", "integer"):
        whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
        return not isinstance(value, bool) and (whole if name == "integer" else isinstance(value, (int, float)))
    return isinstance(value, TYPES[name])


def same(value, other):
    return value == other and isinstance(value, bool) == isinstance(other, bool)


class Schema:
    """Those words of JSON Schema (2020-12) that the schema of lockstep uses; it fails at every other word."""

    def __init__(self, root):
        self.root = root

    def holds(self, value, schema):
        return all(getattr(self, "of_" + word.lstrip("$"))(value, schema[word], schema) for word in schema)

    def of_ref(self, value, path, _):
        found = self.root
        for part in path.split("/")[1:]:
            found = found[part]
        return self.holds(value, found)

    def of_oneOf(self, value, schemas, _):
        return sum(self.holds(value, schema) for schema in schemas) == 1

    def of_not(self, value, schema, _):
        return not self.holds(value, schema)

    def of_type(self, value, names, _):
        return any(is_of_type(value, name) for name in ([names] if isinstance(names, str) else names))

    def of_const(self, value, wanted, _):
        return same(value, wanted)

    def of_enum(self, value, wanted, _):
        return any(same(value, one) for one in wanted)

    def of_properties(self, value, schemas, _):
        return not isinstance(value, dict) or all(self.holds(value[k], s) for k, s in schemas.items() if k in value)

    def of_required(self, value, keys, _):
        return not isinstance(value, dict) or all(key in value for key in keys)

    def of_additionalProperties(self, value, allowed, schema):
        assert allowed is False
        return not isinstance(value, dict) or all(key in schema["properties"] for key in value)

    def of_prefixItems(self, value, schemas, _):
        return not isinstance(value, list) or all(self.holds(v, s) for v, s in zip(value, schemas))

    def of_items(self, value, schema, whole):
        rest = value[len(whole.get("prefixItems", [])):] if isinstance(value, list) else []
        return all(self.holds(one, schema) for one in rest)

    def of_minItems(self, value, least, _):
        return not isinstance(value, list) or len(value) >= least

    def of_maxItems(self, value, most, _):
        return not isinstance(value, list) or len(value) <= most

    def of_minLength(self, value, least, _):
        return not isinstance(value, str) or len(value) >= least

    def of_maxLength(self, value, most, _):
        return not isinstance(value, str) or len(value) <= most

    def of_pattern(self, value, pattern, _):
        return not isinstance(value, str) or re.search(pattern, value) is not None

    def of_minimum(self, value, least, _):
        return not is_of_type(value, "number") or value >= least

    def of_maximum(self, value, most, _):
        return not is_of_type(value, "number") or value <= most

    def of_description(self, *_):
        return True


def kind_of(line):
    kinds = ("hello", "run", "bye", "destroy", "answer", "ask", "calls")
    return line["event"] if "event" in line else next(kind for kind in kinds if kind in line)


def check(path):
    with open(SCHEMA, encoding="utf-8") as file:
        schema = Schema(json.load(file))
    counts = collections.Counter()
    with open(path, encoding="utf-8") as file:
        for text in file:
            line, to_program = json.loads(text[1:]), text[0] == "<"
            names = ("to_program", "of_program") if to_program else ("of_program", "to_program")
            right, wrong = (schema.holds(line, schema.root["$defs"][name]) for name in names)
            is_told_apart = "bye" in line or not wrong
            if not right or not is_told_apart:
                print("refused:" if not right else "taken for a line of the other direction:", text)
                return 1
            counts[text[0] + kind_of(line)] += 1
    print(" ".join(sorted(counts)))
    return 0


if __name__ == "__main__":
    if sys.argv[1] == "record":
        record(sys.argv[2], sys.argv[3:])
    else:
        sys.exit(check(sys.argv[2]))
