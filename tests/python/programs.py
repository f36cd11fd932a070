"""Small programs for test_package.py: `programs.py NAME` serves one of them."""

import sys
from typing import Optional

import fleetproof
from fleetproof import Agv, Callbacks, Computer, Fault, Kind, Master, Message, Occupancy, Order, Pose, Result


class Told(Callbacks[Agv]):
    """Logs all that it is told."""

    def on_start(self) -> None:
        self.agv.log(f"start {self.agv.briefing.boot} {self.agv.world.map.lanes[2].drive - fleetproof.BACKWARD}")

    def on_order(self, order: Order) -> None:
        self.agv.log(f"{order}")

    def on_message(self, message: Message) -> None:
        self.agv.log(f"{message}")

    def on_timer(self, timer: int) -> None:
        self.agv.log(f"timer {timer} at {self.agv.now_s}")

    def on_action_done(self, result: Result) -> None:
        self.agv.log(f"done {result.value}")

    def on_withdrawn(self, order_id: int) -> None:
        self.agv.log(f"withdrawn {order_id}")

    def on_fault(self, fault: Fault) -> None:
        self.agv.log(f"{fault}")

    def on_refused(self, call: str, result: Result) -> None:
        self.agv.log(f"{call} {result.value}")

    def on_end(self) -> None:
        print("end of", self.agv.id)
        self.agv.log("never said")


class Calls(Callbacks[Agv]):
    """Makes every call once."""

    def on_start(self) -> None:
        agv = self.agv
        print("on_start prints")
        agv.broadcast(b"\x00\xff")
        agv.describe("HI")
        agv.describe("HI", content="for q", asks="1.0")
        agv.send(b"", 1)
        agv.set_timer(3, agv.now_ns + 5)
        agv.declare_cost(0.001)
        agv.safe_mode(True)
        agv.waiting_for(None)
        agv.works_on(0, 7)
        agv.declare_waiting(0, 1)
        agv.sometimes("probe")
        agv.declare_state("state")
        agv.believe(1, Pose(1.0, 2.0, 0.0, 1.0), 9)
        seen = [agv.position().x_m, agv.battery_level(), agv.is_loaded(), agv.load(), agv.action()]
        agv.log(f"{seen} {agv.get_message()} {agv.random(1, -1)} {agv.recall(1)!r} {agv.recall(2)!r}")
        stand, drive = Occupancy(0, station=1, heading=(1.0, 0.0)), Occupancy(0, lane=0)
        agv.log(f"{agv.conflict(stand, drive, 0.5)} {agv.keep(1, bytes([200]))!r}")
        results = [agv.move(0), agv.pick(), agv.pick(1, 7), agv.drop(), agv.park(1), agv.charge()]
        results += [agv.stop(), agv.go_on()]
        agv.log(f"{[bool(result) for result in results]} {agv.action()}")


class Ends(Callbacks[Agv]):
    def on_message(self, message: Message) -> None:
        self.agv.log("message")

    def on_activation_end(self) -> None:
        self.agv.log("end")


class AsksTwice(Callbacks[Agv]):
    def on_start(self) -> None:
        stand, drive, turn = Occupancy(0, station=1), Occupancy(0, lane=0), Occupancy(0, station=2)
        self.agv.log(f"{[self.agv.conflict(stand, other) for other in (turn, drive, turn, drive)]}")


class Wrong(Callbacks[Agv]):
    def on_start(self) -> None:
        self.agv.sometimes("before")
        if self.agv.id == 0:
            raise ValueError("no map of this floor")

    def on_timer(self, timer: int) -> None:
        if timer == 1:
            self.agv.broadcast(bytes(1025))
        while not self.agv.move(7):
            pass


class Depot(Master):
    tick_s = 0.5

    def on_tick(self) -> None:
        self.computer.log(f"{list(self.orders)} {self.vehicles} {self.computer.world.id_of('server')}")

    def on_message(self, message: Message) -> None:
        self.done(int(message.data))


async def waits(agv: fleetproof.StraightAgv) -> None:
    try:
        agv.log(f"{await agv.message(2.0)} {agv.now_s}")
        agv.log(f"{await agv.message(2.0)} {agv.now_s}")
        agv.log(f"move {(await agv.move(0)).value} {agv.now_s}")
        agv.log(f"{await agv.order()} {await agv.message(0.0)} {agv.now_s}")
        agv.begin("move", 1)
        event = await agv.wait(Kind.DONE | Kind.WITHDRAWN)
        agv.log(f"{event.kind} {event.withdrawn}")
        agv.log(f"pick {(await agv.pick(None, 7)).value} {agv.now_s}")
        await agv.sleep(3.0)
        agv.log(f"{await agv.wait(Kind.FAULT, until_ns=0)}")
        await agv.order()
    finally:
        print("freed", agv.id)
        agv.log("never said")


async def restarts(agv: fleetproof.StraightAgv) -> None:
    await agv.message(1.0)
    await agv.wait_until_rest()
    agv.log(f"rests {agv.now_s} {await agv.done(0.0)}")


async def sleeps_elsewhere(agv: fleetproof.StraightAgv) -> None:
    import asyncio

    await asyncio.sleep(0)


async def holds_on(agv: fleetproof.StraightAgv) -> None:
    while True:
        try:
            await agv.order()
        except GeneratorExit:
            pass


async def echo(computer: fleetproof.StraightComputer) -> None:
    while True:
        message: Optional[Message] = await computer.message()
        assert message is not None
        computer.send(message.data, message.sender)


class Refuses(Callbacks[Computer]):
    pass


PROGRAMS = {
    "told": dict(vehicle=Told, faults=["dirt"]),
    "calls": dict(vehicle=Calls),
    "wrong": dict(vehicle=Wrong),
    "ends": dict(vehicle=Ends),
    "asks twice": dict(vehicle=AsksTwice),
    "master": dict(computer=Depot),
    "waits": dict(vehicle=waits, computer=echo, one_run=True, deterministic=False, description="waits a lot"),
    "restarts": dict(vehicle=restarts),
    "sleeps_elsewhere": dict(vehicle=sleeps_elsewhere),
    "holds_on": dict(vehicle=holds_on),
    "nothing": {},
}

if __name__ == "__main__":
    fleetproof.serve(sys.argv[1], **PROGRAMS[sys.argv[1]])  # type: ignore[arg-type]
