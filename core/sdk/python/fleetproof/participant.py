"""The calls of agent.h, for one AGV or computer. Their contract stands in agent.h; here stands what differs.

What an event tells already (position, battery, action, load, messages) is not asked for again. The call is made all the
same, so that it counts and costs simulated time as it does for software in C.
"""

from __future__ import annotations

import enum
from collections import deque
from typing import Any, Deque, Dict, List, Optional, Protocol, Tuple

from .world import MESSAGE_BYTES_MAX, Briefing, Message, Occupancy, Pose, World


class Result(str, enum.Enum):
    """What a call returns."""

    OK = "ok"
    EMPTY = "empty"
    REFUSED = "refused"
    INVALID = "invalid"
    SUSPENDED = "suspended"

    def __bool__(self) -> bool:
        """True for OK: ``if not agv.move(segment): ...``."""
        return self is Result.OK


class Suspended(BaseException):
    """The participant made more calls than its limit, and is suspended to the end of the run. Leave it uncaught."""


class Line(Protocol):
    """How a participant reaches the engine in its activation."""

    calls: List[List[Any]]

    def ask(self, call: List[Any]) -> Dict[str, Any]:
        """Makes the calls so far and this one, and returns its answer."""


def _latin(data: bytes) -> str:
    return data.decode("latin-1")


class Participant:
    """What AGVs and computers have in common: messages, timers, randomness, disk and declarations.

    Calls that return nothing are made without waiting for their result. If the engine refuses one, the program is told
    afterwards (``Callbacks.on_refused``).
    """

    def __init__(self, line: Line, world: World, briefing: Briefing) -> None:
        self._line = line
        self.world = world
        """The same for all participants of the run."""
        self.briefing = briefing
        self.now_ns = 0
        """What the participant's own clock shows, in nanoseconds. It stands still during an activation."""
        self._told: Dict[str, Any] = {}
        self._unread: Deque[Dict[str, Any]] = deque()
        self._is_over = False
        self._conflicts: Dict[Tuple[Occupancy, Occupancy, float], bool] = {}

    @property
    def id(self) -> int:
        return self.briefing.self_id

    @property
    def now_s(self) -> float:
        """What the participant's own clock shows, in seconds."""
        return self.now_ns / 1e9

    # ---- messages

    def broadcast(self, data: bytes) -> None:
        """Sends to all that are in range."""
        self._call("send_broadcast", _latin(self._checked(data)))

    def send(self, data: bytes, receiver: int) -> None:
        """Sends to one AGV or computer."""
        self._call("send_unicast", _latin(self._checked(data)), receiver)

    def get_message(self) -> Optional[Message]:
        """The next message of the inbox; None: it is empty."""
        self._call("get_message")
        if not self._unread:
            return None
        first = self._unread.popleft()
        return Message(first["sender"], first["bytes"].encode("latin-1"))

    def describe(self, kind: str, *, content: str = "", asks: str = "", answers: str = "", about: str = "") -> None:
        """For people who look at a trace: the kind and content of the next message, as in ``"GRANT: answers 3"``.

        With fields, ``explain`` knows which request (``asks``) the message makes, and which (``answers``) it answers.
        """
        fields = {"kind": kind, "content": content, "asks": asks, "answers": answers, "about": about}
        given = {name: text for name, text in fields.items() if text}
        self._call("describe", kind if len(given) < 2 else given)

    # ---- services of the computer

    def set_timer(self, timer: int, at_ns: int) -> None:
        """An event at this instant of the own clock. A later call with the same number replaces it; < 0 clears it."""
        self._call("set_timer", timer, at_ns)

    def random(self, purpose: int, index: int) -> int:
        """64 uniform bits: a pure function of run, participant, purpose and index."""
        return int(self._ask("random", purpose, f"{index & 0xFFFFFFFFFFFFFFFF:016x}")["value"], 16)

    def declare_cost(self, seconds: float) -> None:
        """Thinking time: later calls of this activation act so much later."""
        self._call("declare_cost_ns", round(seconds * 1e9))

    def keep(self, record: int, data: bytes) -> Result:
        """Writes a record to the disk, which outlives restarts. Empty bytes delete it."""
        return Result(self._ask("keep", record, _latin(data))["answer"])

    def recall(self, record: int) -> Optional[bytes]:
        """A record of the disk; None: there is none."""
        answer = self._ask("recall", record)
        return answer["bytes"].encode("latin-1") if answer["answer"] == "ok" else None

    def conflict(self, a: Occupancy, b: Occupancy, margin_m: float = 0.0) -> bool:
        """Whether two vehicles may come closer than the safety distance plus the margin. False is certain.

        The answer never changes. So only the first question asks the engine.
        """
        question = (a, b, margin_m)
        if question not in self._conflicts:
            answer = self._ask("conflict", _occupancy(a), _occupancy(b), margin_m)
            if answer["answer"] != "ok":
                raise ValueError(f"conflict: {answer['answer']} for {a} and {b}")
            self._conflicts[question] = bool(answer["conflict"])
        return self._conflicts[question]

    # ---- what is told to people and to results

    def works_on(self, agv: int, order_id: Optional[int]) -> None:
        self._call("works_on", agv, order_id)

    def declare_waiting(self, agv: int, for_agv: Optional[int]) -> None:
        self._call("declare_waiting", agv, for_agv)

    def sometimes(self, probe: str) -> None:
        """A probe: "this was reached"."""
        self._call("sometimes", probe)

    def log(self, text: str) -> None:
        self._call("log", text)

    def declare_state(self, state: str) -> None:
        self._call("declare_state", state)

    def believe(self, agv: int, where: Pose, as_of_ns: int) -> None:
        self._call("believe", agv, list(where), as_of_ns)

    def fail(self, text: str, hang: bool = False) -> None:
        """Ends this participant: it is filed as crashed, or as hung, with the text."""
        self._call("fail", hang, text)

    # ---- for the styles

    def _begin_activation(self, told: Dict[str, Any]) -> None:
        self._told = told
        self._unread.extend(told["messages"])
        self.now_ns = told["now_ns"]

    def _call(self, *call: Any) -> None:
        if not self._is_over:
            self._line.calls.append(list(call))

    def _ask(self, *call: Any) -> Dict[str, Any]:
        if self._is_over:
            raise Suspended(f"{call[0]} after the end of this participant")
        answer = self._line.ask(list(call))
        if answer["answer"] == "suspended":
            raise Suspended("made more calls than its limit")
        return answer

    def _checked(self, data: bytes) -> bytes:
        if len(data) > MESSAGE_BYTES_MAX:
            raise ValueError(f"a message of {len(data)} bytes; {MESSAGE_BYTES_MAX} at most")
        return data


def _occupancy(of: Occupancy) -> Dict[str, Any]:
    told = {key: value for key, value in of._asdict().items() if value is not None}
    if of.heading is not None:
        told["heading"] = list(of.heading)
    return told


class Computer(Participant):
    """A participant without a body: a server, a broker, a station PC."""


class VehicleCalls(Participant):
    """What an AGV perceives and declares, in all styles."""

    def __init__(self, line: Line, world: World, briefing: Briefing) -> None:
        super().__init__(line, world, briefing)
        self._has_acted = False

    def position(self) -> Pose:
        """Perceived: it may be late, and wrong."""
        self._call("get_position")
        return Pose(*self._told["pose"])

    def battery_level(self) -> float:
        """From 0 to 1."""
        self._call("get_battery_level")
        return float(self._told["battery_level"])

    def load(self) -> Optional[int]:
        """The order of the load on board; None: no load."""
        self._call("get_load")
        load = self._told["load"]
        return None if load is None else int(load)

    def is_loaded(self) -> bool:
        self._call("is_loaded")
        return self._told["load"] is not None

    def action(self) -> str:
        """ "idle", "driving", "turning", "picking", "dropping", "parked", "charging_now", "out_of_order", "stopped"."""
        if self._has_acted:
            return str(self._ask("get_action")["action"])
        self._call("get_action")
        return str(self._told["action"])

    def stop(self) -> Result:
        """Brakes the drive or turn under way, and holds the AGV until ``go_on``."""
        return self._act("stop")

    def go_on(self) -> Result:
        return self._act("go_on")

    def safe_mode(self, on: bool) -> None:
        """Declared: the AGV stands still because of the radio."""
        self._call("safe_mode", on)

    def waiting_for(self, agv: Optional[int]) -> None:
        """Declared: the AGV for which it waits."""
        self._call("waiting_for", agv)

    def _begin_activation(self, told: Dict[str, Any]) -> None:
        super()._begin_activation(told)
        self._has_acted = False

    def _act(self, *call: Any) -> Result:
        self._has_acted = True
        return Result(self._ask(*call)["answer"])

    def _begin(self, action: str, segment: Optional[int], order_id: Optional[int] = None) -> Result:
        if order_id is None:
            return self._act(action, segment)
        if action != "pick":
            raise ValueError(f"{action} takes no order")
        return self._act("pick_load", segment, order_id)


class Agv(VehicleCalls):
    """The AGV controller for the style of callbacks: actions begin, and ``on_action_done`` says when they have ended.

    ``segment``: the number of the segment to drive first, as ``Lane.drive`` has it; None: the AGV stays where it is.
    """

    def move(self, segment: int) -> Result:
        return self._begin("move", segment)

    def pick(self, segment: Optional[int] = None, order_id: Optional[int] = None) -> Result:
        """With an order: the load of this one. Without: of the oldest that waits there."""
        return self._begin("pick", segment, order_id)

    def drop(self, segment: Optional[int] = None) -> Result:
        return self._begin("drop", segment)

    def park(self, segment: Optional[int] = None) -> Result:
        return self._begin("park", segment)

    def charge(self, segment: Optional[int] = None) -> Result:
        return self._begin("charge", segment)
