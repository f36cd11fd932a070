"""my-agent: a server that gives each open order to one vehicle, and the vehicle that carries it out. Nobody asks
before it drives.

Try it: name it in a campaign as { run = "python3 agent.py", way = "lockstep" }, once as vehicle and once as computer.
"""

import json
from typing import Dict

import fleetproof
from fleetproof import Computer, Kind, Master, Message, StraightAgv


class MyMaster(Master):
    tick_s = 1.0

    def __init__(self, computer: Computer) -> None:
        super().__init__(computer)
        self.work: Dict[int, int] = {}  # which order was given to which vehicle

    def on_message(self, message: Message) -> None:
        said = json.loads(message.data)  # {"done": order}: the vehicle has put the load down
        self.done(said["done"])
        self.work = {vehicle: order for vehicle, order in self.work.items() if order != said["done"]}

    def on_tick(self) -> None:
        for order in self.orders.values():
            free = [vehicle for vehicle in self.vehicles if vehicle not in self.work]
            if order.id not in self.work.values() and free:
                self.work[free[0]] = order.id
                self.computer.works_on(free[0], order.id)
        for vehicle, number in self.work.items():  # again and again: messages are lost
            if number in self.orders:
                order = self.orders[number]
                trip = {"order": order.id, "origin": order.origin, "destination": order.destination}
                self.computer.send(json.dumps(trip).encode(), vehicle)


async def my_vehicle(agv: StraightAgv) -> None:
    await agv.wait_until_rest()  # after a restart, an action of the former boot may be under way
    station, server = agv.briefing.start_station or 0, len(agv.world.fleet)
    for lane in agv.world.map.lanes:
        if agv.briefing.start_segment in (lane.segment, lane.drive) and lane.origin == station:
            station = lane.destination
    delivered = set()
    while True:
        message = (await agv.wait(Kind.MESSAGE)).message
        trip = json.loads(message.data) if message is not None else {}
        if trip.get("order") is None:
            continue
        if trip["order"] not in delivered and agv.load() != trip["order"]:
            station = await drive(agv, station, trip["origin"])
            await agv.pick(None, trip["order"])
        if agv.load() == trip["order"]:
            station = await drive(agv, station, trip["destination"])
            if station == trip["destination"] and await agv.drop():
                delivered.add(trip["order"])
        if trip["order"] in delivered:
            agv.send(json.dumps({"done": trip["order"]}).encode(), server)


async def drive(agv: StraightAgv, station: int, goal: int) -> int:
    """Drives to the goal. Returns the station at which the AGV ends."""
    for lane in agv.world.map.way(station, goal) or []:
        if not await agv.move(lane.drive):
            break
        station = lane.destination
    return station


if __name__ == "__main__":
    fleetproof.serve("my-agent", vehicle=my_vehicle, computer=MyMaster)
