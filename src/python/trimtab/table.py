"""Columns with units, and how they become frames of pandas and polars."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import os

    import pandas
    import polars


class Table:
    """Columns of equal length with units.

    `table["alpha"]` is a column, `table.units["alpha"]` its unit (SI; `""` where it has none, as text and counts).
    """

    def __init__(self, columns: Mapping[str, Sequence[Any]], units: Mapping[str, str] | None = None) -> None:
        self.columns = {name: list(values) for name, values in columns.items()}
        self.units = {name: (units or {}).get(name, "") for name in self.columns}
        lengths = {len(values) for values in self.columns.values()}
        if len(lengths) > 1:
            raise ValueError(f"columns of {sorted(lengths)} rows are no table")

    @classmethod
    def of_rows(cls, rows: Iterable[Mapping[str, Any]], names: Sequence[str], units: Mapping[str, str] | None = None) -> Table:
        """From records; what a record does not have is `None`."""
        rows = list(rows)
        return cls({name: [row.get(name) for row in rows] for name in names}, units)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), []))

    def __getitem__(self, name: str) -> list[Any]:
        return self.columns[name]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Row by row."""
        for values in zip(*self.columns.values()):
            yield dict(zip(self.columns, values))

    def __repr__(self) -> str:
        return f"Table({len(self)} rows: {', '.join(self.titles())})"

    def titles(self) -> list[str]:
        """Names with units: `alpha[rad]`. A table with these can be uploaded as it is."""
        return [f"{name}[{unit}]" if unit else name for name, unit in self.units.items()]

    def pandas(self, titles: bool = False) -> pandas.DataFrame:
        """As a frame of pandas; units are in `attrs["units"]`, and with `titles` in the names of the columns."""
        import pandas as pd

        frame = pd.DataFrame(self.columns)
        frame.attrs["units"] = dict(self.units)
        if titles:
            frame.columns = pd.Index(self.titles())
        return frame

    def polars(self, titles: bool = False) -> polars.DataFrame:
        """As a frame of polars, which knows no units: with `titles` they are in the names of the columns."""
        import polars as pl

        names = self.titles() if titles else list(self.columns)
        return pl.DataFrame(dict(zip(names, self.columns.values())), strict=False)

    def to_csv(self, file: str | os.PathLike[str]) -> None:
        """Writes it as CSV with names and units in the header."""
        with open(file, "w", newline="", encoding="utf-8") as out:
            writer = csv.writer(out)
            writer.writerow(self.titles())
            writer.writerows(zip(*self.columns.values()))
