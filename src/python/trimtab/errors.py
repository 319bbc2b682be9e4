"""What can go wrong, as exceptions: each says where, and what would put it right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


class TrimtabError(Exception):
    """Anything that this package raises of its own."""


class Unreachable(TrimtabError):
    """The server does not answer, or no longer."""


class ProgramFailed(TrimtabError):
    """The program `trimtab` is not found, or a local server does not start."""


@dataclass(frozen=True)
class Fault:
    """One fault of a recording, a model document or a job."""

    #: Where: a JSON pointer, or `/columns/alpha`, `/rows/12/alpha` of a table; empty: the whole.
    pointer: str
    #: A stable word for programs.
    code: str
    #: What is wrong, and what would put it right.
    message: str

    @classmethod
    def read(cls, raw: Mapping[str, Any]) -> Fault:
        """From the JSON of the API."""
        return cls(raw["pointer"], raw["code"], raw["message"])

    def __str__(self) -> str:
        return f"{self.pointer}: {self.message}" if self.pointer else self.message


class Problem(TrimtabError):
    """The server refused a request (`application/problem+json`, RFC 9457)."""

    def __init__(self, status: int, raw: Mapping[str, Any]) -> None:
        #: The HTTP status.
        self.status = status
        #: A stable word; `Client.problems` explains each.
        self.code = str(raw.get("code", ""))
        #: What is wrong with this request.
        self.detail = str(raw.get("detail") or raw.get("title") or f"the server answers {status}")
        #: Every place that is wrong.
        self.faults = [Fault.read(fault) for fault in raw.get("errors", [])]
        #: Of a recording that was refused: the draft of a mapping that makes the choices it leaves open.
        self.mapping: Mapping[str, Any] | None = raw.get("mapping")
        #: Under which the server's log has it.
        self.request_id = str(raw.get("request_id", ""))
        unsaid = [str(fault) for fault in self.faults if fault.message not in self.detail]
        super().__init__("\n".join([self.detail, *unsaid]))


class JobFailed(TrimtabError):
    """A job that was waited for has no result."""

    def __init__(self, job: str, status: str, faults: list[Fault]) -> None:
        #: Its id.
        self.job = job
        #: `failed` or `cancelled`.
        self.status = status
        #: Why.
        self.faults = faults
        super().__init__("\n".join([f"job {job} {status}", *map(str, faults)]))
