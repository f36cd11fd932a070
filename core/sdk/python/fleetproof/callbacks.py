"""The style of callbacks: one object for each participant, and a function for each kind of event."""

from __future__ import annotations

from typing import Any, Dict, Generic, List, TypeVar

from .participant import Agv, Computer, Participant, Result
from .world import Fault, Message, Order

Self = TypeVar("Self", bound=Participant)


class Callbacks(Generic[Self]):
    """Override what you need. An object lives until its participant restarts or the run ends.

    ``self.agv`` is the AGV (or the computer: then ``self.computer`` is the same).
    """

    def __init__(self, participant: Self) -> None:
        self.agv = participant
        self.computer = participant

    def on_start(self) -> None:
        """The run begins, or the participant begins again: ``briefing.boot`` is then above 0."""

    def on_order(self, order: Order) -> None:
        """A transport was released. After a restart, those that are not done are told again."""

    def on_message(self, message: Message) -> None:
        """For each message, oldest first. Messages are lost, late, doubled and reordered."""

    def on_timer(self, timer: int) -> None:
        """A timer went off."""

    def on_action_done(self, result: Result) -> None:
        """The action that was accepted first has ended. REFUSED: a contact has put the AGV out of order for good."""

    def on_withdrawn(self, order_id: int) -> None:
        """A transport was withdrawn."""

    def on_fault(self, fault: Fault) -> None:
        """A fault begins whose word was given to ``serve``."""

    def on_refused(self, call: str, result: Result) -> None:
        """A call of the function before, whose result nobody asked for, was refused."""

    def on_activation_end(self) -> None:
        """After each of these functions, and once after all messages: what the program does whatever has come."""

    def on_end(self) -> None:
        """The participant restarts, or the run is over. Calls do nothing any more."""

    def _hear(self, told: Dict[str, Any]) -> None:
        kind = told["event"]
        if kind == "start":
            self.on_start()
        elif kind == "order":
            self.on_order(Order(told["order_id"], told["from"], told["to"]))
        elif kind == "message":
            while (message := self.agv.get_message()) is not None:
                self.on_message(message)
        elif kind == "timer":
            self.on_timer(told["timer"])
        elif kind == "action_done":
            self.on_action_done(Result(told["result"]))
        elif kind == "withdrawn":
            self.on_withdrawn(told["order_id"])
        elif kind == "fault":
            self.on_fault(Fault(told["fault_word"], told["fault_number"], told["fault_length_ns"]))
        elif kind == "refused":
            for each in told["refused"]:
                self.on_refused(each["name"], Result(each["result"]))


class Master(Callbacks[Computer]):
    """The program of a computer that plans for a fleet. It keeps the open orders, and ticks.

    Set ``tick_s`` in your class. Timer 0 belongs to the tick. After a restart of the computer ``orders`` fills again by
    itself, also with orders that an AGV carries: ask the AGVs where they are before you plan.
    """

    tick_s = 1.0

    def __init__(self, participant: Computer) -> None:
        super().__init__(participant)
        self.orders: Dict[int, Order] = {}
        """The open orders by their id, in the order in which they were released."""

    @property
    def vehicles(self) -> List[int]:
        """The ids of the AGVs."""
        return list(range(len(self.computer.world.fleet)))

    def on_tick(self) -> None:
        """Every ``tick_s`` seconds of the computer's clock, and at its start."""

    def done(self, order_id: int) -> None:
        """Forgets an order: a vehicle has said that it was delivered."""
        self.orders.pop(order_id, None)

    def on_start(self) -> None:
        self.on_timer(0)

    def on_order(self, order: Order) -> None:
        self.orders[order.id] = order

    def on_withdrawn(self, order_id: int) -> None:
        self.done(order_id)

    def on_timer(self, timer: int) -> None:
        if timer == 0:
            self.computer.set_timer(0, self.computer.now_ns + round(self.tick_s * 1e9))
            self.on_tick()


class Runner:
    """One object of callbacks with its participant, as a session drives it."""

    def __init__(self, program: Any, participant: Participant) -> None:
        self.participant = participant
        self._object: Callbacks[Any] = program(participant)

    def hear(self, told: Dict[str, Any]) -> None:
        self.participant._begin_activation(told)
        self._object._hear(told)
        self._object.on_activation_end()

    def close(self) -> None:
        self.participant._is_over = True
        self._object.on_end()


Vehicles = Callbacks[Agv]
