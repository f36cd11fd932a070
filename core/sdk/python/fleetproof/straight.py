"""Straight-line code: ``async def program(agv)``, one coroutine for each participant.

A call that is awaited leaves the coroutine until an event comes for which it waits; meanwhile simulated time passes.
Events alone schedule coroutines: there is no event loop, and what ``asyncio`` offers cannot be awaited here.

What comes while the program does not wait for it is kept, and returned by a later wait, oldest first. Timer 0 belongs
to the waits.
"""

from __future__ import annotations

import enum
import sys
import types
from collections import deque
from typing import Any, Awaitable, Callable, Deque, Dict, Generator, NamedTuple, Optional

from .participant import Line, Participant, Result, VehicleCalls
from .world import Briefing, Fault, Message, Order, World


class Kind(enum.Flag):
    """What a program waits for, or-ed; and what an event is. ``TIME_IS_UP``: nothing has come in time."""

    TIME_IS_UP = 0
    ORDER = enum.auto()
    MESSAGE = enum.auto()
    DONE = enum.auto()
    FAULT = enum.auto()
    WITHDRAWN = enum.auto()
    ANYTHING = ORDER | MESSAGE | DONE | FAULT | WITHDRAWN


_KINDS = {
    "order": Kind.ORDER,
    "message": Kind.MESSAGE,
    "action_done": Kind.DONE,
    "fault": Kind.FAULT,
    "withdrawn": Kind.WITHDRAWN,
}


class Event(NamedTuple):
    """One event; the member of its kind is set."""

    kind: Kind
    order: Optional[Order] = None
    message: Optional[Message] = None
    result: Optional[Result] = None
    """Of DONE: OK, or REFUSED if a contact has put the AGV out of order for good."""
    fault: Optional[Fault] = None
    withdrawn: Optional[int] = None


def _event(kind: Kind, told: Dict[str, Any]) -> Event:
    if kind is Kind.ORDER:
        return Event(kind, order=Order(told["order_id"], told["from"], told["to"]))
    if kind is Kind.DONE:
        return Event(kind, result=Result(told["result"]))
    if kind is Kind.FAULT:
        return Event(kind, fault=Fault(told["fault_word"], told["fault_number"], told["fault_length_ns"]))
    if kind is Kind.WITHDRAWN:
        return Event(kind, withdrawn=told["order_id"])
    return Event(kind)


class _Left:
    """What a coroutine yields when it waits; nothing else may come out of it."""


_LEFT = _Left()


@types.coroutine
def _leave() -> Generator[_Left, None, None]:
    yield _LEFT


class Waits(Participant):
    """The waits that AGVs and computers have in common. Durations are seconds of the own clock."""

    def __init__(self, line: Line, world: World, briefing: Briefing) -> None:
        super().__init__(line, world, briefing)
        self._kept: Deque[Event] = deque()
        self._wanted = Kind(0)
        self._under_way = 0  # actions of this boot
        self._deadline_ns: Optional[int] = None
        self._timer_ns: Optional[int] = None
        self._is_time_up = False

    async def wait(
        self, kinds: Kind, timeout_s: Optional[float] = None, *, until_ns: Optional[int] = None
    ) -> Event:
        """The next event of these kinds; one of TIME_IS_UP if none comes in time.

        ``timeout_s``: from now on. ``until_ns``: an instant of the own clock. Neither: it waits for ever. A time that
        has passed: what comes at this instant before a timer that is set here and now.
        """
        if timeout_s is not None:
            until_ns = self.now_ns + round(timeout_s * 1e9)
        deadline_ns = None if until_ns is None else max(until_ns, self.now_ns)
        event = self._take(kinds)
        if event is not None:
            return event
        if deadline_ns is not None and self._timer_ns != deadline_ns:
            self._timer_ns = deadline_ns
            self.set_timer(0, deadline_ns)
        self._wanted, self._deadline_ns, self._is_time_up = kinds, deadline_ns, False
        while event is None and not self._is_time_up:
            await _leave()
            event = self._take(kinds)
        self._wanted, self._deadline_ns = Kind(0), None
        return event if event is not None else Event(Kind.TIME_IS_UP)

    async def sleep(self, duration_s: float) -> None:
        await self.wait(Kind(0), duration_s)

    async def order(self) -> Order:
        """The next order, however long it takes."""
        event = await self.wait(Kind.ORDER)
        assert event.order is not None
        return event.order

    async def message(self, timeout_s: Optional[float] = None, *, until_ns: Optional[int] = None) -> Optional[Message]:
        """The next message; None: the time is up."""
        return (await self.wait(Kind.MESSAGE, timeout_s, until_ns=until_ns)).message

    def get_message(self) -> Optional[Message]:
        message = super().get_message()
        if message is None:
            self._forget(Kind.MESSAGE)
        return message

    def _forget(self, kind: Kind) -> None:
        self._kept = deque(event for event in self._kept if event.kind is not kind)

    def _hear(self, told: Dict[str, Any]) -> bool:
        """Takes note of an event. True: the program waits for it."""
        if told["event"] == "timer":
            self._timer_ns = None
            self._is_time_up = self._deadline_ns is not None and self.now_ns >= self._deadline_ns
            return self._is_time_up
        kind = _KINDS.get(told["event"])
        if kind is None:
            for each in told.get("refused", []):
                print(f"fleetproof: {each['name']} was {each['result']}", file=sys.stderr)
            return False
        if kind is Kind.DONE and self._under_way > 0:
            self._under_way -= 1
        # One event says that the inbox is not empty; it is kept until the inbox is.
        if kind is not Kind.MESSAGE or all(event.kind is not kind for event in self._kept):
            self._kept.append(_event(kind, told))
        return bool(self._wanted & kind)

    def _take(self, kinds: Kind) -> Optional[Event]:
        """The first kept event of these kinds."""
        for place, event in enumerate(self._kept):
            if not event.kind & kinds:
                continue
            if event.kind is not Kind.MESSAGE:
                del self._kept[place]
                return event
            message = self.get_message()
            return self._take(kinds) if message is None else Event(Kind.MESSAGE, message=message)
        return None


class StraightComputer(Waits):
    """A computer whose program is straight-line code."""


class StraightAgv(VehicleCalls, Waits):
    """The AGV controller for straight-line code.

    ``segment``: the number of the segment to drive first, as ``Lane.drive`` has it; None: the AGV stays where it is.
    The awaited actions return when they have ended, or at once what the controller says if it does not accept them.
    They also wait for an action that was begun before.
    """

    async def move(self, segment: int) -> Result:
        return await self._carry_out("move", segment)

    async def pick(self, segment: Optional[int] = None, order_id: Optional[int] = None) -> Result:
        """With an order: the load of this one. Without: of the oldest that waits there."""
        return await self._carry_out("pick", segment, order_id)

    async def drop(self, segment: Optional[int] = None) -> Result:
        return await self._carry_out("drop", segment)

    async def park(self, segment: Optional[int] = None) -> Result:
        return await self._carry_out("park", segment)

    async def charge(self, segment: Optional[int] = None) -> Result:
        return await self._carry_out("charge", segment)

    def begin(self, action: str, segment: Optional[int], order_id: Optional[int] = None) -> Result:
        """Begins "move", "pick", "drop", "park" or "charge". If the result is OK, an event of DONE follows."""
        result = self._begin(action, segment, order_id)
        if result is Result.OK:
            self._under_way += 1
        return result

    async def done(self, timeout_s: Optional[float] = None) -> Optional[Result]:
        """How the next action that was begun has ended; None: the time is up."""
        return (await self.wait(Kind.DONE, timeout_s)).result

    async def wait_until_rest(self) -> None:
        """Until no action is under way: after a restart, one of the former boot may be. Then that one is over.

        An AGV that ``stop`` holds is not at rest.
        """
        while self.action() not in ("idle", "parked", "charging_now"):
            await self.wait(Kind.DONE, 1.0)
        self._forget(Kind.DONE)

    async def _carry_out(self, action: str, segment: Optional[int], order_id: Optional[int] = None) -> Result:
        result = self.begin(action, segment, order_id)
        if result is not Result.OK:
            return result
        self._forget(Kind.DONE)
        while True:
            ended = (await self.wait(Kind.DONE)).result
            if self._under_way == 0:
                assert ended is not None
                return ended


class Runner:
    """One coroutine with its participant, as a session drives it."""

    def __init__(self, program: Callable[[Any], Awaitable[None]], participant: Waits) -> None:
        self.participant = participant
        self._coroutine: Any = program(participant)
        self._has_begun = self._has_ended = False

    def hear(self, told: Dict[str, Any]) -> None:
        if self._has_ended:
            return
        self.participant._begin_activation(told)
        if self._has_begun and not self.participant._hear(told):
            return
        self._has_begun = True
        try:
            if self._coroutine.send(None) is not _LEFT:
                self._coroutine.close()
                self._has_ended = True
                raise TypeError("the program awaits something that no event ends, such as a function of asyncio")
        except StopIteration:
            self._has_ended = True

    def close(self) -> None:
        self.participant._is_over = True
        self._coroutine.close()
