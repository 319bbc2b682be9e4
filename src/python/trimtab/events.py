"""A job's events, each once and in order, over lines that break."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import httpx

from .connection import Connection, checked, is_busy, unreachable

_LAST = {"succeeded", "failed", "cancelled"}
# the server sends a comment every 15 s: a line that is silent for longer is dead
_SILENCE = 45.0
_CONNECT = 10.0
_PAUSE = 0.5
_PATIENCE = 30.0


@dataclass(frozen=True)
class Event:
    """One entry of a job's log."""

    #: Its number, from 1, without holes.
    seq: int
    #: When it was recorded, RFC 3339.
    at: str
    #: `queued`, `claimed`, `prepared`, `start`, `iteration`, `diagnosis`, `succeeded`, ...
    type: str
    #: All of it, as the API has it.
    raw: dict[str, Any]

    @property
    def is_last(self) -> bool:
        """Whether nothing follows."""
        return self.type in _LAST


def follow(connection: Connection, job: str, after: int = 0) -> Iterator[Event]:
    """The events of a job behind the number `after`, as they come, up to the last.

    A line that breaks, and a server that is restarted, are tried again for half a minute from the first failure; with `Last-Event-ID` nothing is
    lost and nothing comes twice. Raises `Unreachable`, and `Problem` if there is no such job.
    """
    lost: float | None = None
    while True:
        error: Exception = TimeoutError("its event stream ends again and again")
        try:
            for event in _one_line(connection, job, after):
                after = event.seq
                lost = None
                yield event
                if event.is_last:
                    return
        except _Over:
            return
        except httpx.TransportError as broken:
            error = broken
        now = time.monotonic()
        lost = now if lost is None else lost
        if now - lost > _PATIENCE:
            raise unreachable(connection.server, error) from error
        time.sleep(_PAUSE)


class _Over(Exception):
    """There is nothing behind the last event that was asked for."""


def _one_line(connection: Connection, job: str, after: int) -> Iterator[Event]:
    headers = {"accept": "text/event-stream", **({"last-event-id": str(after)} if after else {})}
    usual = connection.http.timeout
    timeout = httpx.Timeout(connect=_CONNECT, read=_SILENCE, write=usual.write, pool=usual.pool)
    with connection.http.stream("GET", f"/v1/jobs/{job}/events", headers=headers, timeout=timeout) as response:
        if response.status_code == 204:
            raise _Over
        if is_busy(response) or response.status_code >= 500:
            return
        for data in messages(lines(checked(response).iter_text())):
            raw = json.loads(data)
            yield Event(raw["seq"], raw["at"], raw["type"], raw)


def lines(texts: Iterator[str]) -> Iterator[str]:
    """Lines as the standard of server-sent events has them: U+2028 and its like, which data may have in them, end none."""
    rest = ""
    for text in texts:
        *whole, rest = (rest + text).split("\n")
        for line in whole:
            yield line.removesuffix("\r")


def messages(lines: Iterator[str]) -> Iterator[str]:
    """The data of server-sent events; one that the end of the stream cuts off is none."""
    data: list[str] = []
    for line in lines:
        if line.startswith("data:"):
            data.append(line[5:].removeprefix(" "))
        elif not line and data:
            yield "\n".join(data)
            data = []
