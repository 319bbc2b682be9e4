"""What can be asked of a server."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Union

from . import events, progress as bars
from .connection import Connection
from .errors import TrimtabError
from .events import Event
from .job import Job
from .maneuver import FilePath, Maneuver, ManeuverLike, as_recording, content_type, use
from .table import Table

if TYPE_CHECKING:
    from .maneuver import Frame

#: A catalog name, the id of a stored model, or a document.
ModelLike = Union[str, Mapping[str, Any]]


class Client:
    """A Trimtab server.

    `server` is its address (without it `TRIMTAB_SERVER`, then this machine), `key` the key that it may need (without it
    `TRIMTAB_KEY`), `timeout` how many seconds an answer may take, `retries` how often a request is sent again where the
    line breaks or the server is busy: what is sent again is done once. Requests raise `Problem` where the server refuses
    them and `Unreachable` where there is none.
    """

    def __init__(self, server: str | None = None, key: str | None = None, timeout: float = 120.0, retries: int = 4) -> None:
        server = server or os.environ.get("TRIMTAB_SERVER") or "http://127.0.0.1:8300"
        self._connection = Connection(server, key or os.environ.get("TRIMTAB_KEY"), timeout, retries)

    def __repr__(self) -> str:
        return f"Client({self._connection.server!r})"

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Gives its sockets back."""
        self._connection.close()

    # recordings

    def upload(
        self,
        recording: FilePath | Frame,
        name: str | None = None,
        *,
        mapping: str | Mapping[str, Any] | None = None,
        time: str | None = None,
        units: Mapping[str, str] | None = None,
    ) -> Maneuver:
        """Uploads a file as it is, or a frame of pandas or polars, or a `Table`.

        Units of a frame stand in the names of its columns (`alpha[deg]`), in `units`, or in `attrs["units"]`; `time` names
        the column that has the time (without it `t` or `time`). `mapping` says of a file what it does not say itself: the
        name of one, or written out. The same content again is the same maneuver.
        """
        if isinstance(recording, (str, os.PathLike)):
            if time is not None or units is not None:
                raise ValueError("`time` and `units` are of frames; what a file does not say itself, a `mapping` says")
            path = Path(recording)
            content, kind, name = path.read_bytes(), content_type(path), name or path.stem
        else:
            content, kind = as_recording(recording, time, units), "application/json"
        said = mapping if mapping is None or isinstance(mapping, str) else json.dumps(mapping)
        query = {"name": name, "mapping": said}
        return Maneuver.read(self._connection.post("/v1/maneuvers", query=query, content=content, content_type=kind).json())

    def maneuvers(self, q: str | None = None, **wanted: str) -> Iterator[Maneuver]:
        """The recordings, newest first: those with each word of `q`, or with a `tag`, an `aircraft`, `registration`, `flight`, `test_point`."""
        return map(Maneuver.read, self._pages("/v1/maneuvers", "maneuvers", {"q": q, **wanted}))

    def maneuver(self, id: str) -> Maneuver:
        """A recording by its id."""
        return Maneuver.read(self._connection.json(f"/v1/maneuvers/{id}"))

    def describe(self, maneuver: Maneuver | str, flown: Mapping[str, Any] | None = None, name: str | None = None) -> Maneuver:
        """Says of a recording what was flown: a merge patch, in which `None` takes away."""
        given = {"flown": flown, "name": name}
        change = {key: value for key, value in given.items() if value is not None}
        return Maneuver.read(self._connection.change("PATCH", f"/v1/maneuvers/{_id(maneuver)}", change).json())

    def data(self, maneuver: Maneuver | str, max_points: int | None = None) -> Table:
        """The samples of a recording, SI."""
        raw = self._connection.json(f"/v1/maneuvers/{_id(maneuver)}/data", {"max_points": max_points})
        channels = {"t": raw["time"], **raw["channels"]}
        return Table({n: c["values"] for n, c in channels.items()}, {n: c.get("unit", "") for n, c in channels.items()})

    def segments(self, maneuver: Maneuver | str, **options: str | float) -> list[dict[str, Any]]:
        """How a recording is best cut: `name`, `kind` and `seconds` of each proposal; options as in the API."""
        answer: list[dict[str, Any]] = self._connection.json(f"/v1/maneuvers/{_id(maneuver)}/segments", options)["segments"]
        return answer

    def delete_maneuver(self, maneuver: Maneuver | str) -> None:
        """Deletes a recording that no job uses; needs the scope `admin`."""
        self._connection.change("DELETE", f"/v1/maneuvers/{_id(maneuver)}")

    # models

    def models(self, q: str | None = None) -> Iterator[dict[str, Any]]:
        """The models: `id`, `title`, `inputs`, `outputs`, `parameters` of each."""
        return self._pages("/v1/models", "models", {"q": q})

    def model(self, id: str) -> dict[str, Any]:
        """A model's document."""
        document: dict[str, Any] = self._connection.json(f"/v1/models/{id}")
        return document

    def add_model(self, document: str | Mapping[str, Any]) -> str:
        """Stores a model, written as TOML or as a document; its id is what `fit` and `diagnose` take."""
        toml = isinstance(document, str)
        content = document.encode() if isinstance(document, str) else json.dumps(document).encode()
        kind = "application/toml" if toml else "application/json"
        return str(self._connection.post("/v1/models", content=content, content_type=kind).json()["id"])

    def delete_model(self, id: str) -> None:
        """Deletes a stored model; jobs keep their copy. Needs the scope `admin`."""
        self._connection.change("DELETE", f"/v1/models/{id}")

    # jobs

    def submit(self, spec: Mapping[str, Any]) -> Job:
        """Submits a job as the API takes it (`JobSpec`)."""
        return Job(self._connection, self._connection.post("/v1/jobs", dict(spec)).json())

    def fit(
        self, model: ModelLike, maneuvers: Sequence[ManeuverLike], *, wait: bool = True, progress: bool = False, **spec: Any
    ) -> Job:
        """Estimates the parameters of a model from maneuvers, fitted together.

        `maneuvers` are those of `upload`, their ids, or what `use` makes of them (parts, roles, constants). `spec` has
        further fields of a job: `name`, `tags`, `channels`, `parameters`, `constants`, `edits`, `options`, `strict`.
        Waits for the end, and raises `JobFailed` where there is no result, unless `wait` is false.
        """
        return self._run({"model": model, "maneuvers": [use(maneuver) for maneuver in maneuvers], **spec}, wait, progress)

    def diagnose(
        self,
        model: ModelLike,
        maneuvers: Sequence[ManeuverLike],
        *,
        validation: Sequence[ManeuverLike] = (),
        final: Sequence[ManeuverLike] = (),
        wait: bool = True,
        progress: bool = False,
        **spec: Any,
    ) -> Job:
        """Finds what a model lacks: `job.diagnosis()`.

        `validation` flights take part in decisions and not in fits, `final` ones are predicted when all is decided. `spec`
        as in `fit`; also `candidates` and `knowledge`.
        """
        used = [use(maneuver) for maneuver in maneuvers]
        used += [use(maneuver, role="validation") for maneuver in validation]
        used += [use(maneuver, role="final") for maneuver in final]
        return self._run({"kind": "diagnose", "model": model, "maneuvers": used, **spec}, wait, progress)

    def bulk(
        self, model: ModelLike, maneuvers: Sequence[ManeuverLike], *, wait: bool = True, progress: bool = False, **spec: Any
    ) -> list[Job]:
        """A job of each maneuver, all or none, in the order of the maneuvers (500 at most); `spec` as in `fit`.

        Unlike `fit` it raises nothing where a job fails: see `status` and `faults` of each.
        """
        body = {"job": {"model": model, **spec}, "maneuvers": [use(maneuver) for maneuver in maneuvers]}
        answer = self._connection.post("/v1/jobs/bulk", body).json()
        jobs = [Job(self._connection, raw) for raw in answer["jobs"]]
        return self.wait(jobs, progress=progress) if wait else jobs

    def wait(self, jobs: Sequence[Job], progress: bool = False) -> list[Job]:
        """Follows jobs to their ends, with or without results; the jobs as they are then."""
        shown = bars.bar(f"{len(jobs)} jobs", len(jobs)) if progress else None
        for job in jobs:
            for _ in job.follow():
                pass
            job.refresh()
            if shown is not None:
                shown.update()
        if shown is not None:
            shown.close()
        return list(jobs)

    def follow(self, job: Job | str, after: int = 0, progress: bool = False) -> Iterator[Event]:
        """The events of a job behind the number `after`, live, each once, over lines that break; with a progress bar (tqdm)."""
        stream = events.follow(self._connection, job if isinstance(job, str) else job.id, after)
        return bars.shown(stream, str(job if isinstance(job, str) else job.title)) if progress else stream

    def jobs(self, q: str | None = None, **wanted: str) -> Iterator[Job]:
        """The jobs, newest first: those with each word of `q`, of a `status`, a `kind`, with a `tag`, `created_after`."""
        return (Job(self._connection, raw) for raw in self._pages("/v1/jobs", "jobs", {"q": q, **wanted}))

    def job(self, id: str) -> Job:
        """A job by its id."""
        return Job(self._connection, self._connection.json(f"/v1/jobs/{id}"))

    # many jobs

    def parameters(self, jobs: Iterable[Job]) -> Table:
        """The parameters of many jobs, one below the other: `job`, `title`, `name`, `segment`, `unit`, `estimate`, `standard_error`, `fixed`."""
        names = ["job", "title", "name", "segment", "unit", "estimate", "standard_error", "fixed"]
        rows = [{"job": job.id, "title": job.title, **row} for job in jobs if job.raw["has_result"] for row in job.parameters()]
        return Table.of_rows(rows, names)

    def campaign(
        self, tag: str, by: Sequence[str] = (), group: Sequence[str] = (), parameters: Sequence[str] = (), degree: int | None = None
    ) -> dict[str, Any]:
        """The jobs with a tag as polynomials of the conditions `by` (their tags `alpha=5`), with outliers: `curves`, `left_out`."""
        query = {
            "tag": tag,
            "by": ",".join(by) or None,
            "group": ",".join(group) or None,
            "parameters": ",".join(parameters) or None,
            "degree": degree,
        }
        answer: dict[str, Any] = self._connection.json("/v1/campaigns", query)
        return answer

    def simulate(self, scenario: Mapping[str, Any], model: ModelLike | None = None) -> str:
        """A recording as CSV of what a scenario says (`trimtab simulate` reads the same as TOML)."""
        body = {"scenario": scenario, **({} if model is None else {"model": model})}
        return self._connection.post("/v1/simulations", body, accept="text/csv").text

    def problems(self) -> Table:
        """What can go wrong: every code of a `Problem` with its meaning."""
        rows = self._connection.json("/v1/problems")["problems"]
        return Table.of_rows(rows, list(rows[0]))

    def ready(self) -> None:
        """Raises unless the server can serve requests."""
        status = self._connection.json("/health/ready")["status"]
        if status != "ok":
            raise TrimtabError(f"the server says of itself: {status}")

    def _run(self, spec: dict[str, Any], wait: bool, progress: bool) -> Job:
        job = self.submit(spec)
        return job.wait(progress=progress) if wait else job

    def _pages(self, path: str, items: str, wanted: Mapping[str, str | None]) -> Iterator[dict[str, Any]]:
        cursor: str | None = None
        while True:
            page = self._connection.json(path, {**wanted, "cursor": cursor})
            yield from page[items]
            cursor = page.get("next_cursor")
            if cursor is None:
                return


def _id(maneuver: Maneuver | str) -> str:
    return maneuver if isinstance(maneuver, str) else maneuver.id
