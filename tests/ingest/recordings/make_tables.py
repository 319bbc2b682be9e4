"""Writes the Parquet files beside this: python3 make_tables.py (pandas, pyarrow)."""

from datetime import date
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

here = Path(__file__).parent
time = np.arange(5) * 0.04
alpha = [1.5, 2.5, np.nan, 3.5, 4.5]
rate = [10.0, -20.0, 30.0, -40.0, 50.0]
epoch = [1795255200123456789 + k * 40_000_000 for k in range(5)]

frame = pd.DataFrame({"time [s]": time, "alpha [deg]": alpha, "q [deg/s]": rate})
for compression in ["snappy", "gzip", "lz4", "brotli"]:
    frame.to_parquet(here / f"{compression}.parquet", index=False, compression=compression)

# an index of time stamps, columns of every kind, three groups of rows, pages of version 2
kinds = pd.DataFrame(
    {
        "alpha [deg]": pd.array([1.5, 2.5, None, 3.5, 4.5], dtype="Float64"),
        "q [deg/s]": np.array(rate, dtype="int16"),
        "day": [date(2026, 11, 21)] * 5,
        "gear": pd.array([True, False, None, True, False], dtype="boolean"),
        "phase": pd.Categorical(["climb", "level", "climb", "level", "level"]),
        "mode": pd.array([1, 2, None, 4, 255], dtype="UInt8"),
        "count": np.array([1, 2, 3, 4, 2**63], dtype="uint64"),
        "torque [N*m]": np.array([1, 2, 3, 4, 5.5], dtype="float32"),
    },
    index=pd.date_range("2026-11-21 10:00", periods=5, freq="40ms"),
)
kinds.to_parquet(
    here / "kinds.parquet", data_page_version="2.0", compression="zstd", row_group_size=2
)

durations = frame.drop(columns="time [s]")
durations.index = pd.to_timedelta(time, unit="s")
durations.index.name = "elapsed"
durations.to_parquet(here / "durations.parquet")

nested = pa.table(
    {
        "time_ms": pa.array([0, 40, 80, 120, 160], pa.int64()),
        "alpha [deg]": pa.array([1.5, 2.5, None, 3.5, 4.5]),
        "list": pa.array([[1], [2, 3], [], None, [4]]),
        "air": pa.array([{"p": 1.0, "T": None}, {"p": 2.0, "T": 5}, None, {"p": 4.0, "T": 1}, {"p": 5.0, "T": 2}]),
        "mass": pa.array([1, 2, 3, 4, 5], pa.decimal128(10, 2)),
        "half": pa.array(np.array([1, 2, 3, 4, -5.5], np.float16)),
        "photo": pa.array([b"\0"] * 5, pa.binary()),
    }
)
pq.write_table(nested, here / "nested.parquet")
counts = [2**32 - 1, 0, 2**31, 5, 2**31 - 1]
deltas = nested.select(["time_ms", "alpha [deg]"])
deltas = deltas.append_column("count", pa.array(counts, pa.uint32()))
deltas = deltas.append_column("total", pa.array([2**32 * count for count in counts], pa.uint64()))
delta = dict.fromkeys(["time_ms", "count", "total"], "DELTA_BINARY_PACKED")
pq.write_table(
    deltas,
    here / "delta.parquet",
    use_dictionary=False,
    column_encoding={**delta, "alpha [deg]": "BYTE_STREAM_SPLIT"},
)
pq.write_table(
    pa.table(
        {
            "time": pa.array([f"10:00:00.{4 * k:02}" for k in range(5)]),
            "alpha [deg]": pa.array(["1.5", "2.5", None, "n/a", "4.5"]),
            "note": pa.array(["a", "b", None, "1", "c"]),
        }
    ),
    here / "texts.parquet",
)
pq.write_table(
    pa.table({"timestamp": pa.array(epoch), "alpha [deg]": pa.array(alpha)}),
    here / "epoch.parquet",
)
pq.write_table(
    pa.table({"timestamp": pa.array(epoch, pa.timestamp("ns")), "alpha [deg]": pa.array(alpha)}),
    here / "int96.parquet",
    use_deprecated_int96_timestamps=True,
)
