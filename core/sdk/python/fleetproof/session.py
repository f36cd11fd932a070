"""The process side of the protocol: reads lines, starts participants, writes what they do."""

from __future__ import annotations

import inspect
import json
import os
import sys
import traceback
from typing import Any, BinaryIO, Callable, Dict, List, Optional, Sequence, Union

from . import callbacks, straight
from .participant import Agv, Computer, Participant, Suspended
from .world import World, read_briefing, read_world

PROTOCOL = 1

# Made once, and text in place of bytes: a third of the time that a line takes.
_text_of = json.JSONEncoder(separators=(",", ":")).encode

Runner = Union[callbacks.Runner, straight.Runner]


class ProtocolError(Exception):
    """What the engine said is not what the protocol allows."""


def serve(
    name: str,
    *,
    vehicle: Optional[Callable[..., Any]] = None,
    computer: Optional[Callable[..., Any]] = None,
    description: str = "",
    deterministic: bool = True,
    faults: Sequence[str] = (),
    one_run: bool = False,
) -> None:
    """Serves as control software until fleetproof closes the standard input.

    ``name``: of the control software in results. ``vehicle``, ``computer``: the programs for AGVs and for computers,
    each a subclass of ``Callbacks`` or an ``async`` function of one argument. ``deterministic``: the promise that the
    same events lead to the same calls. ``faults``: the words of named faults that the program knows. ``one_run``: a new
    process for each run, for programs that leave something behind.
    """
    reader, writer = _take_standard_streams()
    hello = {
        "protocol": PROTOCOL,
        "name": name,
        "description": description,
        "deterministic": deterministic,
        "roles": [role for role, program in (("agv", vehicle), ("computer", computer)) if program is not None],
        "faults": list(faults),
        "runs": "one" if one_run else "many",
    }
    if not hello["roles"]:
        raise TypeError("serve: give a program as vehicle=..., computer=... or both")
    Session(reader, writer, hello, {"agv": vehicle, "computer": computer}).serve()


def _take_standard_streams() -> "tuple[BinaryIO, BinaryIO]":
    """What the program prints goes to standard error: standard output belongs to the protocol."""
    sys.stdout.flush()
    reader, writer = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    with open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(line_buffering=True)
    return reader, writer


class Session:
    """One process and all participants that it hosts. One activation at a time is under way."""

    def __init__(
        self,
        reader: BinaryIO,
        writer: BinaryIO,
        hello: Dict[str, Any],
        programs: Dict[str, Optional[Callable[..., Any]]],
    ) -> None:
        self._reader, self._writer, self._hello, self._programs = reader, writer, hello, programs
        self._world: Optional[World] = None
        self._runners: Dict[int, Runner] = {}
        self.calls: List[List[Any]] = []

    def serve(self) -> None:
        while (told := self._read()) is not None:
            if "event" in told:
                self._activate(told)
            elif "destroy" in told:
                self._close(told["destroy"])
            elif "run" in told:
                self._world = read_world(told["run"])
            elif "bye" in told:
                self._close_all()
                self._write({"bye": {}})
            elif "hello" in told:
                if told["hello"]["protocol"] != PROTOCOL:
                    raise ProtocolError(f"protocol {told['hello']['protocol']}; this package speaks {PROTOCOL}")
                self._write({"hello": self._hello})
            elif "answer" in told:
                raise ProtocolError("an answer to nothing")
        self._close_all()

    def ask(self, call: List[Any]) -> Dict[str, Any]:
        self._write({"calls": self.calls, "ask": call})
        self.calls.clear()
        answer = self._read()
        if answer is None or "answer" not in answer:
            raise ProtocolError(f"no answer to {call[0]}")
        return answer

    def _activate(self, told: Dict[str, Any]) -> None:
        self.calls.clear()
        try:
            if told["event"] == "start":
                self._close(told["self"])
                self._runners[told["self"]] = self._runner(told)
            self._runners[told["self"]].hear(told)
        except Suspended:
            pass
        except ProtocolError:
            raise
        except Exception as error:  # the participant fails, and the others go on
            traceback.print_exc()
            self.calls.append(["fail", False, f"{type(error).__name__}: {error}"])
        self._write({"calls": self.calls})

    def _runner(self, told: Dict[str, Any]) -> Runner:
        assert self._world is not None
        briefing = read_briefing(told)
        program = self._programs[briefing.role]
        if program is None:
            raise TypeError(f"no program for the role {briefing.role}")
        participant: Participant
        if inspect.iscoroutinefunction(program):
            kind = straight.StraightAgv if briefing.role == "agv" else straight.StraightComputer
            return straight.Runner(program, kind(self, self._world, briefing))
        participant = (Agv if briefing.role == "agv" else Computer)(self, self._world, briefing)
        return callbacks.Runner(program, participant)

    def _close(self, participant: int) -> None:
        runner = self._runners.pop(participant, None)
        if runner is None:
            return
        try:
            runner.close()
        except (Exception, Suspended):
            traceback.print_exc()

    def _close_all(self) -> None:
        for participant in list(self._runners):
            self._close(participant)

    def _read(self) -> Optional[Dict[str, Any]]:
        line = self._reader.readline()
        return json.loads(line.decode()) if line else None

    def _write(self, told: Dict[str, Any]) -> None:
        self._writer.write(_text_of(told).encode() + b"\n")
        self._writer.flush()
