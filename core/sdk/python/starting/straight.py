"""my-agent: the software on board of an AGV, as straight-line code. It carries out its transports, and asks nobody.

Try it: name it in a campaign as { name = "my-agent", run = "python3 agent.py", way = "lockstep" }.
"""

import fleetproof
from fleetproof import StraightAgv


async def my_agent(agv: StraightAgv) -> None:
    await agv.wait_until_rest()  # after a restart, an action of the former boot may be under way
    station = agv.briefing.start_station or 0
    for lane in agv.world.map.lanes:
        if agv.briefing.start_segment in (lane.segment, lane.drive) and lane.origin == station:
            station = lane.destination
    while True:
        order = await agv.order()
        if agv.load() != order.id:
            station = await drive(agv, station, order.origin)
            if station != order.origin or not await agv.pick(None, order.id):
                continue
        station = await drive(agv, station, order.destination)
        if station == order.destination:
            await agv.drop()


async def drive(agv: StraightAgv, station: int, goal: int) -> int:
    """Drives to the goal. Returns the station at which the AGV ends."""
    for lane in agv.world.map.way(station, goal) or []:
        if not await agv.move(lane.drive):
            break
        station = lane.destination
    return station


if __name__ == "__main__":
    fleetproof.serve("my-agent", vehicle=my_agent)
