"""chrome_trace.py TRACE...: reads traces of --chrome-trace by the rules by which Perfetto's trace processor reads JSON
(its src/trace_processor: importers/json, sorter, importers/common/slice_tracker and flow_tracker), and prints what it
would leave out, move or count as an error. Exit code 1 if there is anything."""
import json
import sys

LARGEST_DEPTH = 512
LARGEST_NAMED = 20
PHASES = "XiM"  # those that the program writes


class Row:
    """The slices that are open on a thread: (begin, duration, event)."""

    def __init__(self):
        self.open = []

    def place(self, begin, duration, event):
        """False: the slice lies across the end of an open one, and does not nest."""
        while self.open:
            since, lasts, _ = self.open[-1]
            end = since + lasts
            if end > begin or (end == begin and lasts == 0 and duration == 0):
                break
            self.open.pop()
        for since, lasts, _ in self.open:
            if begin < since + lasts < begin + duration:
                return False
        self.open.append((begin, duration, event))
        return True


class Reader:
    def __init__(self, events):
        self.errors, self.counts = [], {"slices": 0, "instants": 0, "flows": 0, "processes": 0, "threads": 0}
        self.rows, self.begun = {}, {}
        self.names = {}
        # At one instant: longer slices first, then all else, each in the order of the file.
        keys = [(self.instant(e), -self.ns(e, "dur") if e.get("ph") == "X" and "dur" in e else 0, i)
                for i, e in enumerate(events)]
        for _, _, i in sorted(keys):
            self.read(events[i])
        for row in self.rows:
            if row not in self.names:
                self.errors.append(f"thread {row} has no name")

    def ns(self, event, key):
        """Microseconds to whole nanoseconds, to the nearest."""
        value = event[key]
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            self.errors.append(f"{key} is no number: {event}")
            return 0
        return value * 1000 if isinstance(value, int) else int(value * 1000 + 0.5)

    def instant(self, event):
        if event.get("ph") == "M":
            return 0
        if "ts" not in event or self.ns(event, "ts") < 0:
            self.errors.append(f"no instant, or before the start: {event}")
            return 0
        return self.ns(event, "ts")

    def read(self, event):
        phase = event.get("ph")
        if not phase or phase not in PHASES:
            return self.errors.append(f"phase is not read: {event}")
        for key in ("pid", "tid"):
            if not isinstance(event.get(key), int) or not 0 <= event[key] < 2 ** 32:
                self.errors.append(f"{key} is no number of 32 bits: {event}")
        if event["pid"] == 0 or event["tid"] in (0, event["pid"]) and phase != "M":
            self.errors.append(f"this thread stands for a process, or is idle: {event}")
        row = (event["pid"], event["tid"])
        if phase == "M":
            return self.name(event, row)
        if not event.get("name"):
            self.errors.append(f"no name: {event}")
        track = self.rows.setdefault(row, Row())
        self.slice(event, track)
        if "bind_id" in event:
            self.flow(event)

    def flow(self, event):
        """The slice that was just opened is the topmost one of its row: the flow is bound to it."""
        flow = event["bind_id"]
        if isinstance(flow, bool) or not isinstance(flow, int) or event["ph"] != "X":
            self.errors.append(f"flow without a whole number, or not of a slice: {event}")
        if ("flow_out" in event) == ("flow_in" in event):
            self.errors.append(f"flow without a direction: {event}")
        elif "flow_out" in event:
            if flow in self.begun:
                self.errors.append(f"flow {flow} begins twice")
            self.begun[flow] = event
        elif flow not in self.begun:
            self.errors.append(f"flow {flow} ends and never began")
        else:
            self.counts["flows"] += 1
            self.same_message(self.begun[flow], event)

    def same_message(self, sent, received):
        """Both ends say of which message they are: its number begins with #."""
        numbers = [e["args"]["details"].split()[0] for e in (sent, received)]
        if numbers[0] != numbers[1]:
            self.errors.append(f"an arrow from {sent} to {received}")

    def slice(self, event, track):
        begin = self.instant(event)
        lasts = 0
        if event["ph"] == "X":
            if "dur" not in event:
                return self.errors.append(f"no duration: {event}")
            lasts = self.ns(event, "dur")
            if lasts < 0 or event["dur"] < 0:
                self.errors.append(f"negative duration: {event}")
        elif event.get("s") != "t":
            self.errors.append(f"an instant that is not of its thread: {event}")
        if not track.place(begin, lasts, event):
            self.errors.append(f"overlaps another slice without being in it: {event}")
        if len(track.open) > LARGEST_DEPTH:
            self.errors.append(f"too deep: {event}")
        self.counts["slices" if event["ph"] == "X" else "instants"] += 1

    def name(self, event, row):
        key = "sort_index" if event["name"].endswith("sort_index") else "name"
        if event.get("name") not in ("process_name", "thread_name", "process_sort_index", "thread_sort_index"):
            return self.errors.append(f"metadata that is not read: {event}")
        value = event.get("args", {}).get(key)
        if value in (None, "") or isinstance(value, str) == (key == "sort_index"):
            self.errors.append(f"metadata without a {key}: {event}")
        if event["name"] == "thread_name":
            self.names[row] = value
            self.counts["threads"] += 1
        self.counts["processes"] += event["name"] == "process_name"


def main(files):
    failed = False
    for path in files:
        with open(path, encoding="utf-8") as file:
            reader = Reader(json.load(file)["traceEvents"])
        print(", ".join(f"{number} {word}" for word, number in reader.counts.items()))
        for sentence in reader.errors[:LARGEST_NAMED]:
            print(f"ERROR: {sentence}")
        if reader.errors:
            print(f"{len(reader.errors)} errors")
        failed = failed or bool(reader.errors)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
