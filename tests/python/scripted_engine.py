"""The engine's side of lockstep, as far as a test scripts it: no simulation, only lines."""

import json
import os
import subprocess
import sys
from typing import Any, Callable, Dict, List, Optional

FOLDER = os.path.dirname(os.path.abspath(__file__))
PACKAGE = os.path.join(FOLDER, "..", "..", "core", "sdk", "python")
EXAMPLES = os.path.join(FOLDER, "..", "examples")
sys.path.insert(0, PACKAGE)

SECOND = 1_000_000_000


def station(name: str, x_m: float, lanes: List[int]) -> Dict[str, Any]:
    purposes = ["routing", "storage"]
    where = {"name": name, "x_m": x_m, "y_m": 0.0, "purposes": purposes, "lanes": lanes}
    return {**where, "turning_forbidden": False, "heading": None}


def lane(segment: int, origin: int, destination: int, backward: bool = False) -> Dict[str, Any]:
    arc = {"start": [10.0 * origin, 0.0, 1.0, 0.0], "length_m": 10.0, "curvature_per_m": 0.0}
    ends = {"segment": segment, "from": origin, "to": destination, "length_m": 10.0, "arcs": [arc]}
    rules = {"blocks": [], "backward": backward, "permissions": [{"vehicle_type": None, "load": "any_load"}]}
    return {**ends, "speed_limit_mps": 0.0, "width_m": 0.0, **rules}


def run_line() -> Dict[str, Any]:
    """Three stations in a row; the way back is driven tail first; two AGVs and a server."""
    numbers = ["length_m", "width_m", "speed_mps", "acceleration_mps2", "deceleration_mps2", "turn_speed_radps"]
    numbers += ["turn_acceleration_radps2", "turn_deceleration_radps2", "loaded_length_m", "loaded_width_m"]
    numbers += ["speed_deviation", "centre_ahead_m", "reverse_speed_mps"]
    fleet = [{"name": f"AGV {i}", **{field: 1.5 for field in numbers}, "vehicle_type": 0} for i in range(2)]
    lanes = [lane(0, 0, 1), lane(1, 1, 2), lane(0, 1, 0, True), lane(1, 2, 1, True)]
    stations = [station("A", 0.0, [0]), station("B", 10.0, [1, 2]), station("C", 20.0, [3])]
    return {
        "seed": "00000000000000ff",
        "safety_distance_m": 0.1,
        "radio_range_m": None,
        "orders": "assigned",
        "fleet": fleet,
        "vehicle_type_names": ["usual"],
        "segment_names": ["A-B", "B-C"],
        "computers": [{"name": "server", "x_m": None, "y_m": None}],
        "map": {"stations": stations, "lanes": lanes, "blocks": []},
    }


class Engine:
    """A program in a process of its own. Each question that it asks is answered by `answers`, by its name."""

    def __init__(self, program: List[str], answers: Optional[Dict[str, Any]] = None) -> None:
        environment = {**os.environ, "PYTHONPATH": PACKAGE}
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            [sys.executable, *program], stdin=pipe, stdout=pipe, stderr=pipe, text=True, env=environment
        )
        self.answers: Dict[str, Any] = answers or {}
        self.hello: Dict[str, Any] = {}

    def introduce(self) -> None:
        self.hello = self.exchange({"hello": {"protocol": 1, "program": "test"}})["hello"]

    def tell(self, told: Dict[str, Any]) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(told) + "\n")
        self.process.stdin.flush()

    def exchange(self, told: Dict[str, Any]) -> Dict[str, Any]:
        self.tell(told)
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise EOFError(self.end()[1])
        answer: Dict[str, Any] = json.loads(line)
        return answer

    def event(self, kind: str, at_s: float = 0.0, self_id: int = 0, **more: Any) -> List[List[Any]]:
        """The calls of an activation; one that was asked stands in its place, as ["?", NAME, ...]."""
        told = {"event": kind, "self": self_id, "now_ns": round(at_s * SECOND), "messages": []}
        if self_id < 2:
            told.update(pose=[0.0, 0.0, 1.0, 0.0], battery_level=0.5, action="idle", load=None)
        if kind == "start":
            role, boot = ("agv" if self_id < 2 else "computer"), 0
            told.update(role=role, boot=boot, config="", start_station=0 if self_id < 2 else None)
            told.update(start_segment=None, next_segment=None)
        said, calls = self.exchange({**told, **more}), []
        while "ask" in said:
            calls += said["calls"] + [["?", *said["ask"]]]
            answer = self.answers.get(said["ask"][0], "ok")
            if isinstance(answer, Callable):  # type: ignore[arg-type]
                answer = answer(said["ask"])
            said = self.exchange(answer if isinstance(answer, dict) else {"answer": answer})
        return calls + said["calls"]

    def run(self) -> None:
        self.tell({"run": run_line()})

    def bye(self) -> Dict[str, Any]:
        return self.exchange({"bye": {}})

    def end(self) -> "tuple[int, str]":
        """Exit code and standard error."""
        _, err = self.process.communicate()
        return self.process.returncode, err

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()


def message(text: str, sender: int = 1) -> Dict[str, Any]:
    return {"sender": sender, "bytes": text}
