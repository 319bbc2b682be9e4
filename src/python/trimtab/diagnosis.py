"""What a diagnosis answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .table import Table


@dataclass(frozen=True)
class Effect:
    """An effect that the declared model lacks."""

    #: The word of the catalogue: `sensor_delay`, `backlash`, ...
    kind: str
    #: An output, an input, a state or a coefficient.
    target: str
    #: The effect with its size, in words.
    sentence: str
    #: What it added: each with `name`, `unit`, `estimate`, `standard_error`.
    parameters: list[dict[str, Any]]
    #: Candidates that the data cannot tell from it, itself included, the likeliest first.
    group: list[dict[str, Any]]
    raw: dict[str, Any]


class Diagnosis:
    """The answer of a job of the kind `diagnose`."""

    def __init__(self, raw: dict[str, Any]) -> None:
        #: All of it, as the API has it.
        self.raw = raw
        #: `named`, `named_group`, `nothing_missing`, `unexplained` or `not_testable`.
        self.verdict: str = raw["verdict"]
        #: The verdict in a sentence.
        self.sentence: str = raw["sentence"]
        #: What the reader should know of how it was decided.
        self.remarks: list[str] = raw["remarks"]
        #: What the model lacked, in the order in which it was found.
        self.effects = [_effect(effect) for effect in raw["effects"]]
        #: The declared model with the effects in it, to go on with: `Client.fit(diagnosis.model, ...)`.
        self.model: dict[str, Any] = raw["model"]

    def __repr__(self) -> str:
        return f"Diagnosis({self.verdict}: {self.sentence})"

    def refused(self) -> Table:
        """All other candidates, with the first test that each failed."""
        names = ["kind", "target", "term", "reason", "sentence", "likelihood_ratio", "visible_fraction"]
        return Table.of_rows(self.raw["refused"], names)

    def fits(self) -> Table:
        """RMS error (SI) and R² of each output with the declared model and with the effects, by role."""
        names = ["role", "segment", "output", "unit", "rms_before", "rms_after", "r_squared_before", "r_squared_after"]
        return Table.of_rows(map(_fit, self.raw["fits"]), names)

    def parameters(self) -> Table:
        """Declared parameters with the declared model and with the effects; `shift` is in standard errors."""
        names = ["name", "segment", "unit", "before", "after", "standard_error", "shift"]
        return Table.of_rows(self.raw["parameters"], names)


def _effect(raw: dict[str, Any]) -> Effect:
    return Effect(raw["kind"], raw["target"], raw["sentence"], raw["parameters"], raw["group"], raw)


def _fit(raw: dict[str, Any]) -> dict[str, Any]:
    before, after = raw["before"], raw["after"]
    return {
        "role": raw["role"],
        "segment": raw.get("segment"),
        "output": before["name"],
        "unit": before["unit"],
        "rms_before": before["rms"],
        "rms_after": after["rms"],
        "r_squared_before": before.get("r_squared"),
        "r_squared_after": after.get("r_squared"),
    }
