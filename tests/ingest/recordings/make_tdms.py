"""Writes the TDMS files beside this: python3 make_tdms.py (npTDMS); `daqmx.tdms` by hand, as npTDMS reads it."""

import struct
from pathlib import Path

import numpy as np
from nptdms import ChannelObject, GroupObject, RootObject, TdmsFile, TdmsWriter

here = Path(__file__).parent
time = np.arange(5) * 0.04
alpha = np.array([1.5, 2.5, np.nan, 3.5, 4.5])
rate = np.array([10, -20, 30, -40, 50], dtype="int16")
start = np.datetime64("2026-11-21T10:00:00.000000")


def waveform(step, offset=0.0, **more):
    return {"wf_increment": step, "wf_start_offset": offset, "wf_start_time": start, **more}


# two groups of different rates, in two segments each, and what is not read
with TdmsWriter(here / "waveforms.tdms") as file:
    for part in (slice(0, 3), slice(3, 5)):
        file.write_segment([
            RootObject({"author": "Trimtab"}),
            GroupObject("Air Data"),
            ChannelObject("Air Data", "alpha", alpha[part], waveform(0.04, unit_string="deg")),
            ChannelObject("IMU", "Pitch Rate (deg/s)", rate[part], waveform(0.04)),
            ChannelObject("Fuel", "mass", np.array([100.0, 99.5][part.start // 3 :][:1], "float32"), waveform(0.1, 0.02, unit_string="kg")),
            ChannelObject("Fuel", "phase", ["climb"] * 2),
        ])
# times in a channel, in big-endian halves of a file
with TdmsWriter(here / "times.tdms") as file:
    file.write_segment([
        ChannelObject("Log", "Time", time * 1000, {"unit_string": "ms"}),
        ChannelObject("Log", "alpha", alpha, {"NI_UnitDescription": "deg"}),
        ChannelObject("Log", "q", rate, {"unit_string": "deg/s"}),
    ])
with TdmsWriter(here / "stamps.tdms") as file:
    stamps = start + (np.arange(5) * 40_000).astype("timedelta64[us]")
    file.write_segment([
        ChannelObject("Log", "Stamp", stamps),
        ChannelObject("Log", "alpha", alpha, {"unit_string": "deg"}),
        ChannelObject("Log", "q", rate.astype("float32"), {"unit_string": "deg/s"}),
        ChannelObject("Log", "on", np.array([True, False] * 2 + [True])),
    ])


def text(value):
    return struct.pack("<I", len(value)) + value


def number(name, value):
    return text(name) + struct.pack("<Id", 10, value)


def daqmx(name, at, slope, unit):
    """A channel of a device that measures two, each scaled by a straight line."""
    index = struct.pack("<IIIQ", 0x1269, 0xFFFFFFFF, 1, 5)
    index += struct.pack("<IIIIII", 1, 3, 0, at, 0, 0) + struct.pack("<II", 1, 4)
    properties = [
        number(b"wf_increment", 0.04),
        text(b"unit_string") + struct.pack("<I", 0x20) + text(unit),
        text(b"NI_Number_Of_Scales") + struct.pack("<II", 7, 2),
        text(b"NI_Scale[1]_Scale_Type") + struct.pack("<I", 0x20) + text(b"Linear"),
        number(b"NI_Scale[1]_Linear_Slope", slope),
        number(b"NI_Scale[1]_Linear_Y_Intercept", 0.5),
        text(b"NI_Scale[1]_Linear_Input_Source") + struct.pack("<II", 7, 0),
    ]
    return text(name) + index + struct.pack("<I", len(properties)) + b"".join(properties)


meta = struct.pack("<I", 2) + daqmx(b"/'AI'/'alpha'", 0, 0.5, b"deg") + daqmx(b"/'AI'/'q'", 2, 10.0, b"deg/s")
raw = struct.pack("<10h", *[value for row in range(5) for value in (2 + 2 * row, row - 2)])
head = b"TDSm" + struct.pack("<IIQQ", 0b1000_1110, 4713, len(meta) + len(raw), len(meta))
(here / "daqmx.tdms").write_bytes(head + meta + raw)
read = TdmsFile.read(here / "daqmx.tdms")["AI"]
assert list(read["alpha"][:]) == [1.5, 2.5, 3.5, 4.5, 5.5], read["alpha"][:]
assert list(read["q"][:]) == [-19.5, -9.5, 0.5, 10.5, 20.5], read["q"][:]
# the same numbers row by row, the highest byte first
meta = struct.pack(">I", 2)
for name in [b"/'AI'/'alpha'", b"/'AI'/'q'"]:
    meta += struct.pack(">I", len(name)) + name + struct.pack(">IIIQ", 20, 10, 1, 5)
    meta += struct.pack(">I", 1) + struct.pack(">I", 12) + b"wf_increment" + struct.pack(">Id", 10, 0.04)
raw = struct.pack(">10d", *[value for row in zip(alpha, rate) for value in row])
head = b"TDSm" + struct.pack("<I", 0b110_1110) + struct.pack(">IQQ", 4713, len(meta) + len(raw), len(meta))
(here / "rows.tdms").write_bytes(head + meta + raw)
read = TdmsFile.read(here / "rows.tdms")["AI"]
assert list(read["q"][:]) == [10, -20, 30, -40, 50], read["q"][:]
