"""Figures of results (matplotlib). Angles and their rates are drawn in degrees, all else in SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .errors import TrimtabError
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DEGREES = {"rad": "deg", "rad/s": "deg/s", "rad/s^2": "deg/s^2"}


def time_histories(segments: Sequence[Mapping[str, Any]], title: str = "") -> Figure:
    """Measured against model, a row of each output and a column of each segment; the inputs below."""
    rows = _names(segments, "outputs") + _names(segments, "inputs")
    outputs = len(_names(segments, "outputs"))
    figure, axes = _grid(len(rows), len(segments))
    for column, segment in enumerate(segments):
        known = {series["name"]: series for series in (*segment["outputs"], *segment["inputs"])}
        for row, name in enumerate(rows):
            if name in known:
                _draw(axes[row][column], segment["time"], known[name], row < outputs)
        axes[0][column].set_title(f"{segment['segment']} ({segment.get('role', 'estimation')})", fontsize="medium")
        axes[-1][column].set_xlabel("t [s]")
    axes[0][0].legend(fontsize="small")
    figure.suptitle(title)
    return figure


def correlation(table: Table, title: str = "") -> Figure:
    """A matrix of correlations, as of `Job.correlation`."""
    names = [name for name in table.columns if name != "parameter"]
    figure, axes = _grid(1, 1)
    drawn = axes[0][0].imshow([table[name] for name in names], vmin=-1, vmax=1, cmap="RdBu_r")
    axes[0][0].set_xticks(range(len(names)), names, rotation=90)
    axes[0][0].set_yticks(range(len(names)), names)
    figure.colorbar(drawn)
    figure.suptitle(title)
    return figure


def parameters(table: Table, names: Sequence[str] = ()) -> Figure:
    """Estimates of many jobs with error bars of two standard errors, as of `Client.parameters`: a panel of each parameter."""
    rows = [row for row in table if not names or row["name"] in names]
    chosen = list(names) or list(dict.fromkeys(row["name"] for row in rows if not row["fixed"]))
    figure, axes = _grid(len(chosen), 1)
    for axis, name in zip(axes, chosen):
        points = [row for row in rows if row["name"] == name]
        errors = [2 * (row["standard_error"] or 0.0) for row in points]
        axis[0].errorbar([_point(row) for row in points], [row["estimate"] for row in points], errors, fmt="o", capsize=3)
        axis[0].set_ylabel(f"{name} [{points[0]['unit']}]" if points else name)
        axis[0].tick_params(axis="x", rotation=60)
    return figure


def campaign(curve: Mapping[str, Any], over: str | None = None) -> Figure:
    """One curve of `Client.campaign` over a condition, or over the jobs: estimates and the curve, with two standard errors."""
    points = sorted(curve["points"], key=lambda point: point["conditions"].get(over, 0.0) if over else 0.0)
    where = [point["conditions"][over] for point in points] if over else list(range(1, len(points) + 1))
    figure, axes = _grid(1, 1)
    axis = axes[0][0]
    for outlier, colour in ((False, "C0"), (True, "C3")):
        chosen = [(x, point) for x, point in zip(where, points) if point["is_outlier"] == outlier]
        if chosen:
            values = [point["estimate"] for _, point in chosen]
            errors = [2 * point["standard_error"] for _, point in chosen]
            label = "outliers" if outlier else "jobs"
            axis.errorbar([x for x, _ in chosen], values, errors, fmt="o", color=colour, capsize=3, label=label)
    middle = [point["curve"] for point in points]
    wide = [2 * point["curve_standard_error"] for point in points]
    axis.plot(where, middle, color="C1", label="curve")
    axis.fill_between(where, [m - w for m, w in zip(middle, wide)], [m + w for m, w in zip(middle, wide)], color="C1", alpha=0.2)
    axis.set_xlabel(over or "job")
    axis.set_ylabel(f"{curve['parameter']} [{curve['unit']}]")
    axis.legend()
    return figure


def _grid(rows: int, columns: int) -> tuple[Figure, list[list[Axes]]]:
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise TrimtabError("a figure needs matplotlib: pip install 'trimtab[plots]'") from error
    figure = Figure(figsize=(max(6.4, 4.0 * columns), max(4.0, 1.9 * rows)), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex="col" if rows > 1 else False)
    return figure, [list(row) for row in grid]


def _draw(axis: Axes, time: Sequence[float], series: Mapping[str, Any], is_output: bool) -> None:
    unit = _DEGREES.get(series["unit"], series["unit"])
    factor = 180.0 / math.pi if unit != series["unit"] else 1.0
    scaled = {part: [math.nan if v is None else factor * v for v in series.get(part) or []] for part in _PARTS}
    if is_output:
        axis.plot(time, scaled["measured"], ".", markersize=2, color="0.4", label="measured")
        if scaled["declared"]:
            axis.plot(time, scaled["declared"], color="C1", linewidth=1, label="declared model")
        axis.plot(time, scaled["model"], color="C0", linewidth=1.2, label="model")
    else:
        axis.plot(time, scaled["values"], color="C2", linewidth=1.2)
    axis.set_ylabel(f"{series['name']} [{unit}]")


_PARTS = ("measured", "model", "declared", "values")


def _names(segments: Sequence[Mapping[str, Any]], kind: str) -> list[str]:
    return list(dict.fromkeys(series["name"] for segment in segments for series in segment[kind]))


def _point(row: Mapping[str, Any]) -> str:
    return f"{row['title']} [{row['segment']}]" if row.get("segment") else str(row["title"])
