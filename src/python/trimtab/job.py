"""A job: followed, waited for, and asked for its results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import events, plots, progress as bars
from .connection import Connection
from .diagnosis import Diagnosis
from .errors import Fault, JobFailed
from .events import Event
from .maneuver import Maneuver, ManeuverLike, use
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PARAMETERS = ["name", "segment", "unit", "start", "estimate", "standard_error", "conventional_standard_error", "fixed", "at_bound"]


class Job:
    """A job of a server; what it has of it is as old as the last call that asked for it (`refresh`, `wait`)."""

    def __init__(self, connection: Connection, raw: dict[str, Any]) -> None:
        self._connection = connection
        #: All of it, as the API has it.
        self.raw = raw

    def __repr__(self) -> str:
        return f"Job({self.id}, {self.title!r}, {self.outcome or self.status})"

    @property
    def id(self) -> str:
        """Its id, a UUID."""
        return str(self.raw["id"])

    @property
    def title(self) -> str:
        """Its name, or else its model and maneuvers."""
        return str(self.raw["title"])

    @property
    def tags(self) -> list[str]:
        """What it is found by."""
        return list(self.raw["tags"])

    @property
    def status(self) -> str:
        """`queued`, `running`, `cancelling`, `succeeded`, `failed` or `cancelled`."""
        return str(self.raw["status"])

    @property
    def outcome(self) -> str | None:
        """How good the result is: `converged`, `at_bound`, `singular`, `stalled`, `diverged`, `budget`, `cancelled`."""
        return self.raw.get("outcome")

    @property
    def reason(self) -> str | None:
        """The outcome in a sentence."""
        return self.raw.get("reason")

    @property
    def is_over(self) -> bool:
        """Whether it was over when last asked for."""
        return self.raw.get("finished") is not None

    @property
    def faults(self) -> list[Fault]:
        """Why it failed."""
        return [Fault.read(fault) for fault in self.raw["faults"]]

    def refresh(self) -> Job:
        """Asks the server how it stands."""
        self.raw = self._connection.json(f"/v1/jobs/{self.id}")
        return self

    def follow(self, after: int = 0, progress: bool = False) -> Iterator[Event]:
        """Its events behind the number `after`, live, each once, over lines that break; with a progress bar (tqdm)."""
        stream = events.follow(self._connection, self.id, after)
        return bars.shown(stream, self.title) if progress else stream

    def wait(self, progress: bool = False) -> Job:
        """Follows it to its end; raises `JobFailed` where there is no result."""
        for _ in self.follow(progress=progress):
            pass
        self.refresh()
        if not self.raw["has_result"]:
            raise JobFailed(self.id, self.status, self.faults)
        return self

    def cancel(self) -> Job:
        """Asks for its end; the best iterate is kept if there is one."""
        self.raw = self._connection.post(f"/v1/jobs/{self.id}/cancel").json()
        return self

    def delete(self) -> None:
        """Deletes it with its results; needs the scope `admin`."""
        self._connection.change("DELETE", f"/v1/jobs/{self.id}")

    def rerun(self) -> Job:
        """Runs the same spec with the same data again; the new job."""
        return Job(self._connection, self._connection.post(f"/v1/jobs/{self.id}/rerun").json())

    def spec(self) -> dict[str, Any]:
        """What was submitted."""
        return self._get("spec")

    def estimate(self) -> dict[str, Any]:
        """The whole estimate: parameters, fits, modes, identifiability, findings, as the API has it."""
        return self._get("estimate")

    def parameters(self) -> Table:
        """The parameter table; values and standard errors are in the unit of their row."""
        return Table.of_rows(self._get("parameters")["parameters"], _PARAMETERS)

    def correlation(self) -> Table:
        """Correlation of the errors of the free parameters, a row and a column of each."""
        table = self._get("parameters")
        free = [_label(row) for row in table["parameters"] if not row["fixed"]]
        rows = table["correlation"]
        free += [f"process noise {number}" for number in range(1, len(rows) - len(free) + 1)]
        return Table({"parameter": free[: len(rows)], **dict(zip(free, map(list, zip(*rows))))})

    def findings(self) -> Table:
        """What a reader of the numbers should know."""
        names = ["code", "severity", "recording", "channel", "parameters", "message", "remedy"]
        return Table.of_rows(self._get("estimate")["findings"], names)

    def time_histories(self, max_points: int | None = None) -> Table:
        """Inputs and outputs over time, SI: `alpha` as measured, `alpha_model`, `alpha_residual`; `max_points` of each segment."""
        segments = self._get("time-histories", {"max_points": max_points})["segments"]
        return _joined([_history(segment) for segment in segments])

    def residuals(self, max_points: int | None = None) -> Table:
        """Measured minus model over time, SI."""
        segments = self._get("residuals", {"max_points": max_points})["segments"]
        return _joined([_series(segment, segment["outputs"]) for segment in segments])

    def trajectories(self, names: Sequence[str] = (), max_points: int | None = None) -> Table:
        """States, definitions and outputs along the trajectory with standard errors (`alpha_standard_error`), SI."""
        query = {"names": ",".join(names) or None, "max_points": max_points}
        segments = self._get("trajectories", query)["segments"]
        return _joined([_series(segment, segment["quantities"]) for segment in segments])

    def predict(
        self, maneuvers: Sequence[ManeuverLike], draws: int | None = None, names: Sequence[str] = (), seed: int | None = None
    ) -> Table:
        """Simulates the estimate with the inputs of other recordings, SI.

        Columns are as in `trajectories`; with `draws` over the covariance of the parameters also `alpha_lower` and
        `alpha_upper`, between which 95 of 100 lie.
        """
        body: dict[str, Any] = {"maneuvers": [use(maneuver) for maneuver in maneuvers], "names": list(names)}
        if draws is not None:
            body["monte_carlo"] = {"draws": draws, **({} if seed is None else {"seed": seed})}
        answer = self._connection.post(f"/v1/jobs/{self.id}/predictions", body).json()
        return _joined([_series(segment, segment["quantities"]) for segment in answer["segments"]])

    def corrected(self) -> list[Maneuver]:
        """Makes recordings of what the model says of the motion, for the second of two steps."""
        answer = self._connection.post(f"/v1/jobs/{self.id}/corrected-maneuvers").json()
        return [Maneuver.read(raw) for raw in answer]

    def coefficients(self, aircraft: Mapping[str, float]) -> Table:
        """Nondimensional coefficients with standard errors, from the aircraft's constants and flight condition (SI)."""
        rows = self._connection.post(f"/v1/jobs/{self.id}/coefficients", dict(aircraft)).json()
        return Table.of_rows(rows, list(rows[0]) if rows else [])

    def diagnosis(self) -> Diagnosis:
        """Of a job of the kind `diagnose`."""
        return Diagnosis(self._get("diagnosis"))

    def get(self, resource: str, query: Mapping[str, str | int | float | bool | None] | None = None) -> dict[str, Any]:
        """Any other result by its name in the API, such as `linear-system` or `residual-analysis`."""
        return self._get(resource, query)

    def plot(self, max_points: int = 2000) -> Figure:
        """Measured against model over time, a row of each output (matplotlib)."""
        return plots.time_histories(self._get("time-histories", {"max_points": max_points})["segments"], self.title)

    def plot_correlation(self) -> Figure:
        """Correlations of the parameters' errors (matplotlib)."""
        return plots.correlation(self.correlation(), self.title)

    def _get(self, resource: str, query: Mapping[str, str | int | float | bool | None] | None = None) -> dict[str, Any]:
        answer: dict[str, Any] = self._connection.json(f"/v1/jobs/{self.id}/{resource}", query)
        return answer


def _label(row: Mapping[str, Any]) -> str:
    segment = row.get("segment")
    return f"{row['name']} [{segment}]" if segment else str(row["name"])


def _history(segment: Mapping[str, Any]) -> Table:
    columns, units = _beginning(segment)
    for series in segment["inputs"]:
        columns[series["name"]], units[series["name"]] = series["values"], series["unit"]
    for series in segment["outputs"]:
        name = series["name"]
        parts = {name: "measured", f"{name}_model": "model", f"{name}_residual": "residual"}
        if series.get("declared"):
            parts[f"{name}_declared"] = "declared"
        for column, part in parts.items():
            columns[column], units[column] = series[part], series["unit"]
    return Table(columns, units)


def _series(segment: Mapping[str, Any], quantities: Sequence[Mapping[str, Any]]) -> Table:
    columns, units = _beginning(segment)
    parts = {"": "values", "_standard_error": "standard_errors", "_lower": "lower", "_upper": "upper"}
    for series in quantities:
        for ending, part in parts.items():
            if series.get(part):
                columns[series["name"] + ending], units[series["name"] + ending] = series[part], series["unit"]
    return Table(columns, units)


def _beginning(segment: Mapping[str, Any]) -> tuple[dict[str, list[Any]], dict[str, str]]:
    return {"segment": [segment["segment"]] * len(segment["time"]), "t": segment["time"]}, {"t": "s"}


def _joined(tables: Sequence[Table]) -> Table:
    """One below the other; what one does not have is `None` there."""
    units = {name: unit for table in tables for name, unit in table.units.items()}
    columns: dict[str, list[Any]] = {name: [] for name in units}
    for table in tables:
        for name, column in columns.items():
            column.extend(table.columns.get(name, [None] * len(table)))
    return Table(columns, units)
