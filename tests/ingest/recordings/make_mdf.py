"""Writes the MDF 4 files beside this: python3 make_mdf.py (asammdf); `unsorted.mf4` by hand, as asammdf reads it."""

import struct
from pathlib import Path

import numpy as np
from asammdf import MDF, Signal
from asammdf.blocks.conversion_utils import from_dict

here = Path(__file__).parent
time = np.arange(5) * 0.04
alpha = np.array([1.5, 2.5, np.nan, 3.5, 4.5])
rate = np.array([10, -20, 30, -40, 50], dtype="int16")

file = MDF(version="4.10")
file.append(
    [
        Signal(alpha, time, unit="deg", name="alpha"),
        Signal((rate - 1) * 2, time, unit="deg/s", name="q", conversion={"a": 0.5, "b": 1.0}),
        Signal(np.array([1, 0, 1, 0, 1], "uint8"), time, name="gear",
               conversion=from_dict({"val_0": 0, "text_0": "up", "val_1": 1, "text_1": "down"})),
        Signal(np.array([0, 1, 2, 3, 4], "uint8"), time, unit="N", name="stick force",
               conversion=from_dict({"raw_0": 0, "phys_0": 0.0, "raw_1": 2, "phys_1": 10.0, "raw_2": 4, "phys_2": 12.0, "interpolation": True})),
        Signal(np.array([b"climb"] * 5), time, name="phase", encoding="utf-8"),
        Signal(rate.astype(">f4"), time, unit="m/s", name="V", invalidation_bits=np.array([0, 0, 1, 0, 0], bool)),
    ],
    acq_name="IMU",
)
file.append([Signal(np.array([100.0, 99.5]), np.array([0.02, 0.12]), unit="kg", name="mass")], acq_name="Fuel")
file.save(here / "groups.mf4", overwrite=True)

# numbers, one of which stands for a text: asammdf gives the text there, and numbers elsewhere
file = MDF(version="4.10")
raw = np.array([100, 200, 255, 255, 300], "uint16")
file.append(
    [
        Signal(raw, time, unit="deg", name="alpha",
               conversion=from_dict({"val_0": 255, "text_0": "SNA", "default_addr": {"a": 0.01, "b": -5.0}})),
        Signal(raw, time, unit="deg", name="beta",
               conversion=from_dict({"lower_0": 250, "upper_0": 299, "text_0": "SNA", "default_addr": {"a": 0.02, "b": 1.0}})),
    ],
    acq_name="ADC",
)
file.save(here / "texts.mf4", overwrite=True)

long = np.arange(3000) * 0.01
for compression, name in [(1, "deflated"), (2, "transposed")]:
    file = MDF(version="4.11")
    file.append([Signal(np.round(long * 2), long, unit="deg", name="alpha")])
    file.configure(write_fragment_size=16000)
    file.save(here / f"{name}.mf4", overwrite=True, compression=compression)


def block(kind, links, data):
    head = b"##" + kind + b"\0" * 4 + struct.pack("<QQ", 24 + 8 * len(links) + len(data), len(links))
    return head + struct.pack(f"<{len(links)}Q", *links) + data


class Writer:
    """Blocks one behind the other; each is written before those that lead to it, but for the header."""

    def __init__(self):
        self.bytes = b"MDF     4.10    trimtab\0" + b"\0" * 4 + struct.pack("<H", 410) + b"\0" * 34
        self.bytes += block(b"HD", [0] * 6, b"\0" * 32)

    def add(self, kind, links, data):
        self.bytes += b"\0" * (-len(self.bytes) % 8)
        self.bytes += block(kind, links, data)
        return len(self.bytes) - len(block(kind, links, data))

    def text(self, text):
        return self.add(b"TX", [], text + b"\0")

    def channel(self, following, name, unit, kind, of_data, at, bits):
        sync = 1 if kind == 2 else 0
        data = struct.pack("<BBBBIIII", kind, sync, of_data, 0, at, bits, 0, 0) + b"\0" * 52
        links = [following, 0, self.text(name), 0, 0, 0, self.text(unit) if unit else 0, 0]
        return self.add(b"CN", links, data)

    def group(self, following, name, first, number, count, length):
        data = struct.pack("<QQHH4xII", number, count, 0, 0, length, 0)
        return self.add(b"CG", [following, first, self.text(name), 0, 0, 0], data)


writer = Writer()
mass = writer.channel(0, b"mass", b"kg", 0, 4, 8, 32)
slow = writer.group(0, b"Fuel", writer.channel(mass, b"t", b"s", 2, 4, 0, 64), 7, 2, 12)
q = writer.channel(0, b"q", b"deg/s", 0, 2, 16, 16)
angle = writer.channel(q, b"alpha", b"deg", 0, 4, 8, 64)
fast = writer.group(slow, b"IMU", writer.channel(angle, b"t", b"s", 2, 4, 0, 64), 3, 5, 18)
records = b""
for row in range(5):
    records += b"\3" + struct.pack("<ddh", time[row], alpha[row], rate[row])
    if row in (0, 3):
        records += b"\7" + struct.pack("<df", 0.02 + time[row], 100 - row)
parts = [writer.add(b"DT", [], records[:40]), writer.add(b"DT", [], records[40:])]
data = writer.add(b"DL", [0, *parts], struct.pack("<BBBBIQQ", 0, 0, 0, 0, 2, 0, 40))
group = writer.add(b"DG", [0, fast, data, 0], b"\1" + b"\0" * 7)
unsorted = bytearray(writer.bytes)
unsorted[64 + 24 : 64 + 32] = struct.pack("<Q", group)
(here / "unsorted.mf4").write_bytes(unsorted)
with MDF(here / "unsorted.mf4") as read:
    assert list(read.get("q").samples) == list(rate), read.get("q").samples
    assert np.allclose(read.get("mass").timestamps, [0.02, 0.14]), read.get("mass").timestamps
