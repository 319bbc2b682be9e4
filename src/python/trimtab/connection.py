"""Requests to one server: what is refused raises, what may be sent again is."""

from __future__ import annotations

import time
import uuid
from collections.abc import Mapping
from typing import Any

import httpx

from .errors import Problem, Unreachable

#: A query's parameters; `None` is left out.
Query = Mapping[str, "str | int | float | bool | None"]

# what a server says that has too much to do, is being restarted, or waits for its database
_LATER = {429, 502, 503, 504}
_LONGEST_PAUSE = 30.0


class Connection:
    """An HTTP client with the server's address and key."""

    def __init__(self, server: str, key: str | None, timeout: float, retries: int) -> None:
        headers = {"authorization": f"Bearer {key}"} if key else {}
        self.server = server.rstrip("/")
        self.retries = retries
        self.http = httpx.Client(base_url=self.server, headers=headers, timeout=timeout)

    def close(self) -> None:
        """Gives its sockets back."""
        self.http.close()

    def get(self, path: str, query: Query | None = None, accept: str = "application/json") -> httpx.Response:
        """A GET, sent again where the line breaks."""
        return self._send("GET", path, query, {"accept": accept})

    def json(self, path: str, query: Query | None = None) -> Any:
        """The JSON of a GET."""
        return self.get(path, query).json()

    def post(
        self,
        path: str,
        body: Any = None,
        *,
        query: Query | None = None,
        content: bytes | None = None,
        content_type: str | None = None,
        accept: str = "application/json",
    ) -> httpx.Response:
        """A POST, sent again where the line breaks: with an `Idempotency-Key` it is done once."""
        headers = {"idempotency-key": str(uuid.uuid4()), "accept": accept}
        if content_type is not None:
            headers["content-type"] = content_type
        return self._send("POST", path, query, headers, body, content)

    def change(self, method: str, path: str, body: Any = None) -> httpx.Response:
        """A PATCH or DELETE, which is sent once."""
        return checked(self._once(method, path, {}, {}, body, None))

    def _send(
        self,
        method: str,
        path: str,
        query: Query | None,
        headers: Mapping[str, str],
        body: Any = None,
        content: bytes | None = None,
    ) -> httpx.Response:
        for attempt in range(self.retries + 1):
            last = attempt == self.retries
            try:
                response = self._once(method, path, query or {}, headers, body, content)
            except Unreachable:
                if last:
                    raise
                time.sleep(min(0.2 * 2**attempt, _LONGEST_PAUSE))
                continue
            if last or not (is_busy(response) or _is_in_hand(response)):
                return checked(response)
            time.sleep(_pause(response, attempt))
        raise AssertionError("the last attempt returns or raises")

    def _once(
        self,
        method: str,
        path: str,
        query: Query,
        headers: Mapping[str, str],
        body: Any,
        content: bytes | None,
    ) -> httpx.Response:
        params = {name: value for name, value in query.items() if value is not None}
        try:
            return self.http.request(method, path, params=params, headers=dict(headers), json=body, content=content)
        except httpx.TransportError as error:
            raise unreachable(self.server, error) from error


def is_busy(response: httpx.Response) -> bool:
    """Whether the server has too much to do now, is being restarted, or waits for its database."""
    return response.status_code in _LATER


def _is_in_hand(response: httpx.Response) -> bool:
    """Whether what was sent before its line broke is still being worked on."""
    return response.status_code == 409 and b'"idempotency_key_in_hand"' in response.content


def unreachable(server: str, error: Exception) -> Unreachable:
    """Says which server, and how one is started."""
    return Unreachable(f"{server} does not answer: {error or type(error).__name__}; start one with `trimtab serve`")


def checked(response: httpx.Response) -> httpx.Response:
    """The response, or a `Problem`."""
    if response.is_success:
        return response
    response.read()
    try:
        raw = response.json()
    except ValueError:
        raw = {"detail": f"the server answers {response.status_code}: {response.text[:200]}"}
    raise Problem(response.status_code, raw if isinstance(raw, dict) else {})


def _pause(response: httpx.Response, attempt: int) -> float:
    try:
        asked = float(response.headers.get("retry-after", ""))
    except ValueError:
        asked = 0.2 * 2**attempt
    return min(max(asked, 0.1), _LONGEST_PAUSE)
