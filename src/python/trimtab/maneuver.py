"""Recordings: what is uploaded, what the server says of it, and how a job uses it."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard, Union

from .table import Table

if TYPE_CHECKING:
    import pandas
    import polars

    Frame = Union["pandas.DataFrame", "polars.DataFrame", Table]

#: What `Client.upload` takes for a file.
FilePath = Union[str, "os.PathLike[str]"]

_TYPES = {".csv": "text/csv", ".json": "application/json", ".mat": "application/x-matlab-data"}
_TEXT = {".txt", ".dat", ".asc", ".tsv", ".lvm"}
_TITLE = re.compile(r"\s*(.*?)\s*(?:\[(.*)\])?\s*")


@dataclass(frozen=True)
class Maneuver:
    """A recording that the server has."""

    #: SHA-256 of its content.
    id: str
    name: str
    #: How many samples each channel has.
    samples: int
    #: From the first sample to the last, s.
    duration: float
    #: Units of the channels by name, as they were recorded.
    channels: dict[str, str]
    #: What is odd about the data: each with `code`, `severity`, `message`, `remedy` and its place.
    findings: list[dict[str, Any]]
    #: All of it, as the API has it.
    raw: dict[str, Any]

    @classmethod
    def read(cls, raw: dict[str, Any]) -> Maneuver:
        """From the JSON of the API."""
        summary = raw["summary"]
        channels = {channel["name"]: channel["unit"] for channel in summary["channels"]}
        return cls(raw["id"], raw["name"], summary["samples"], summary["duration"], channels, summary["findings"], raw)

    @property
    def flown(self) -> dict[str, Any]:
        """What was said of the flight: aircraft, test point, mass, tags, ..."""
        flown: dict[str, Any] = self.raw["flown"]
        return flown


#: A maneuver, its id, or how a job uses it (`use`).
ManeuverLike = Union[Maneuver, str, Mapping[str, Any]]


def use(
    maneuver: ManeuverLike,
    *,
    label: str | None = None,
    role: str | None = None,
    seconds: Sequence[float] | None = None,
    rows: Sequence[int] | None = None,
    **more: Any,
) -> dict[str, Any]:
    """How a job uses a recording.

    `role` is `estimation`, `validation` or `final`; `seconds` or `rows` choose a part, both ends included. `more` are
    further fields of the API's `ManeuverUse`: `gaps`, `constants`, `channels`, `start`, `flown`.
    """
    if isinstance(maneuver, Mapping):
        use = dict(maneuver)
    elif isinstance(maneuver, Maneuver):
        use = {"id": maneuver.id, **({"label": maneuver.name} if maneuver.name else {})}
    else:
        use = {"id": maneuver}
    given = {"label": label, "role": role, "seconds": seconds, "rows": rows, **more}
    use.update({name: value for name, value in given.items() if value is not None})
    return use


def content_type(path: Path) -> str:
    """The media type of a recording by its name; its first bytes decide in the end."""
    ending = path.suffix.lower()
    return _TYPES.get(ending, "text/plain" if ending in _TEXT else "application/octet-stream")


def as_recording(frame: Frame, time: str | None = None, units: Mapping[str, str] | None = None) -> bytes:
    """A frame as the API's JSON recording.

    Units are in the names of the columns (`alpha[deg]`), in `units`, or in `attrs["units"]` of a frame of pandas; a
    column without one is a pure number. `time` names the column that has the time; else it is `t`, `time` or, of
    pandas, an index that has that name or has dates. Missing values are missing samples.
    """
    columns, known = _columns(frame)
    known.update(units or {})
    named = {}
    for title, values in columns.items():
        match = _TITLE.fullmatch(title)
        name, unit = (match.group(1), match.group(2)) if match else (title, None)
        if name in named:
            raise ValueError(f"two columns of the frame are called {name} without their units: rename or drop one")
        named[name] = (known.get(title, known.get(name, unit)), values)
    strange = [title for title in units or {} if title not in columns and title not in named]
    if strange:
        raise ValueError(f"`units` has {', '.join(strange)}, which the frame does not have; it has {', '.join(named)}")
    chosen = _time_column(named, time)
    unit, values = named.pop(chosen)
    recording = {"time": _times(chosen, unit, values), "channels": {}}
    for name, (unit, values) in named.items():
        recording["channels"][name] = {"unit": unit or "-", "values": _numbers(name, values)}
    return json.dumps(recording, allow_nan=False).encode()


def _columns(frame: Frame) -> tuple[dict[str, list[Any]], dict[str, str]]:
    if isinstance(frame, Table):
        return dict(frame.columns), dict(frame.units)
    if _is_pandas(frame):
        return _columns_of_pandas(frame)
    return {name: frame[name].to_list() for name in frame.columns}, {}


def _is_pandas(frame: pandas.DataFrame | polars.DataFrame) -> TypeGuard[pandas.DataFrame]:
    # without importing what may not be there
    return type(frame).__module__.split(".")[0] == "pandas" or hasattr(frame, "iloc")


def _columns_of_pandas(frame: pandas.DataFrame) -> tuple[dict[str, list[Any]], dict[str, str]]:
    if frame.columns.has_duplicates:
        raise ValueError("two columns of the frame have one name")
    columns = {str(name): frame[name].tolist() for name in frame.columns}
    units = {str(name): str(unit) for name, unit in frame.attrs.get("units", {}).items()}
    index = frame.index
    if index.name is not None or hasattr(type(index), "inferred_freq"):
        # it has a name, or dates
        columns = {str(index.name or "time"): index.tolist(), **columns}
    return columns, units


def _time_column(named: Mapping[str, Any], time: str | None) -> str:
    wanted = [time] if time else ["t", "time"]
    for name in wanted:
        match = _TITLE.fullmatch(name)
        bare = match.group(1) if match else name
        if bare in named:
            return bare
    raise ValueError(f"the frame has no column {' or '.join(wanted)} for the time; `time=` names it; there are {', '.join(named)}")


def _times(name: str, unit: str | None, values: list[Any]) -> dict[str, Any]:
    for row, value in enumerate(values, 1):
        # pandas' NaT and NaN differ from themselves
        if value is None or value != value:
            raise ValueError(f"row {row} of {name} has no time: leave it out of the frame")
    if values and all(isinstance(value, (datetime, timedelta)) for value in values):
        return {"unit": "s", "values": [(value - values[0]).total_seconds() for value in values]}
    if not unit:
        raise ValueError(f"the time has no unit: call the column {name}[s], or say units={{{name!r}: 's'}}")
    return {"unit": unit, "values": _numbers(name, values)}


def _numbers(name: str, values: list[Any]) -> list[float | None]:
    try:
        numbers = [None if value is None else float(value) for value in values]
    except (TypeError, ValueError) as error:
        raise ValueError(f"column {name} is not numbers: {error}; leave it out of the frame") from error
    return [None if number is None or not math.isfinite(number) else number for number in numbers]
