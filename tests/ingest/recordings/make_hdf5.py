"""Writes the HDF5 files beside this: python3 make_hdf5.py (h5py, pandas, tables)."""

import gzip
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

here = Path(__file__).parent
time = np.arange(5) * 0.04
alpha = np.array([1.5, 2.5, np.nan, 3.5, 4.5])
rate = np.array([10.0, -20.0, 30.0, -40.0, 50.0])
data = np.column_stack([time, alpha, rate])


def matlab(parent, name, values, kind="double"):
    """A variable as MATLAB stores it: its first dimension last, its class in an attribute."""
    stored = parent.create_dataset(name, data=np.asarray(values).T)
    stored.attrs["MATLAB_class"] = np.bytes_(kind)
    return stored


with h5py.File(here / "v73.mat", "w", userblock_size=512) as file:
    matlab(file, "t", time.reshape(1, 5))
    matlab(file, "data", data)
    matlab(file, "note", np.frombuffer(b"made", np.uint8).astype("u2").reshape(1, 4), "char")
    matlab(file, "nothing", np.zeros((2, 1), "u8")).attrs["MATLAB_empty"] = np.uint8(1)
    z = np.zeros((1, 5), [("real", "f8"), ("imag", "f8")])
    z["imag"] = np.arange(5)
    matlab(file, "z", z)
    rec = file.create_group("rec")
    rec.attrs["MATLAB_class"] = np.bytes_("struct")
    matlab(rec, "alpha", alpha.reshape(5, 1))
    matlab(rec, "q", rate.astype("i2").reshape(5, 1), "int16")
    matlab(rec.create_group("inner"), "q", rate.astype("f4").reshape(1, 5), "single")
with open(here / "v73.mat", "r+b") as file:
    file.write(b"MATLAB 7.3 MAT-file, as h5py writes it".ljust(124) + b"\x00\x02IM")


def datasets(file):
    file["time"] = time
    air = file.create_group("air")
    air["alpha"] = alpha
    air["pitch rate"] = rate
    file.create_dataset("gzip", data=data, chunks=(2, 2), compression="gzip")


with h5py.File(here / "datasets.h5", "w") as file:
    datasets(file)
    file.create_dataset("lzf", data=data, chunks=(5, 3), compression="lzf")
    file.create_dataset("shuffled", data=data, chunks=(3, 3), compression="gzip", shuffle=True, fletcher32=True)
    file["big_endian"] = data.astype(">f4")
    file.create_dataset("bomb", shape=(10**9,), chunks=(10**6,), dtype="f8", compression="gzip")

with h5py.File(here / "latest.h5", "w", libver="latest") as file:
    datasets(file)
    file.create_dataset("single", data=data, chunks=data.shape, compression="gzip")
    file.create_dataset("fixed", data=data, chunks=(2, 2))
    early = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    early.set_chunk((2, 2))
    early.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    space = h5py.h5s.create_simple(data.shape)
    implicit = h5py.h5d.create(file.id, b"implicit", h5py.h5t.NATIVE_DOUBLE, space, early)
    implicit.write(h5py.h5s.ALL, h5py.h5s.ALL, data)
    file.create_dataset("paged", data=np.arange(1100, dtype="u2"), chunks=(1,))

frame = pd.DataFrame({"alpha [deg]": alpha, "q [deg/s]": rate.astype("int16")})
frame.index = pd.Index(time, name="time_s")
frame.to_hdf(here / "fixed.h5", key="flight", mode="w")
frame.index = pd.date_range("2026-11-21 10:00", periods=5, freq="40ms")
frame.to_hdf(here / "packed.h5", key="flight", mode="w", format="table", index=False, complevel=5)

fields = np.zeros(5, [("time [s]", "f8"), ("alpha [deg]", "f4"), ("q [deg/s]", "i2"), ("phase", "S5")])
fields["time [s]"], fields["alpha [deg]"], fields["q [deg/s]"] = time, alpha, rate
fields["phase"] = b"climb"
with h5py.File(here / "fields.h5", "w") as file:
    file["flight"] = fields

with h5py.File(here / "dense.h5", "w", libver="latest") as file:
    air = file.create_group("air", track_order=True)
    for name, values in {"time": time, "alpha": alpha, "q": rate}.items():
        air[name] = values
    air["alpha"].attrs["units"] = np.bytes_("deg")
    for number in range(1300):
        air[f"alpha again, {number}"] = air["alpha"]
(here / "dense.h5.gz").write_bytes(gzip.compress((here / "dense.h5").read_bytes(), mtime=0))
(here / "dense.h5").unlink()


def referred(file, values, kind="double"):
    """What MATLAB puts an element of an array of structs, or a cell, into."""
    refs = file.require_group("#refs#")
    return matlab(refs, f"e{len(refs)}", np.asarray(values), kind).ref


def references(parent, name, all):
    return parent.create_dataset(name, data=np.array(all, h5py.ref_dtype).reshape(-1, 1), dtype=h5py.ref_dtype)


with h5py.File(here / "v73_structs.mat", "w", userblock_size=512) as file:
    run = file.create_group("run")
    run.attrs["MATLAB_class"] = np.bytes_("struct")
    references(run, "t", [referred(file, time.reshape(5, 1)) for _ in range(2)])
    references(run, "alpha", [referred(file, factor * alpha.reshape(5, 1)) for factor in (-1, 1)])
    inner = file.require_group("#refs#").create_group("inner")
    inner.attrs["MATLAB_class"] = np.bytes_("struct")
    matlab(inner, "q", rate.reshape(5, 1))
    references(run, "inner", [referred(file, np.zeros((1, 1))), inner.ref])
    sample = file.create_group("sample")
    sample.attrs["MATLAB_class"] = np.bytes_("struct")
    for name, values in {"t": time, "alpha": alpha, "q": rate}.items():
        references(sample, name, [referred(file, [[value]]) for value in values])
    sample_note = [referred(file, np.array([[ord("a")]], "u2"), "char") for _ in time]
    references(sample, "note", sample_note)
    cells = references(file, "c", [referred(file, values.reshape(5, 1)) for values in (time, alpha, rate)])
    cells.attrs["MATLAB_class"] = np.bytes_("cell")
with open(here / "v73_structs.mat", "r+b") as file:
    file.write(b"MATLAB 7.3 MAT-file, as h5py writes it".ljust(124) + b"\x00\x02IM")
# of the second struct nothing is said, as of an element that was never written
with h5py.File(here / "v73_nothing.mat", "w", userblock_size=512) as file:
    run = file.create_group("run")
    run.attrs["MATLAB_class"] = np.bytes_("struct")
    for name, values in {"t": time, "alpha": alpha, "q": rate}.items():
        dataset = run.create_dataset(name, (3, 1), dtype=h5py.ref_dtype)
        for place, factor in {0: -1, 2: 1}.items():
            dataset[place, 0] = referred(file, factor * values.reshape(5, 1))
    single = run.create_dataset("single", (3, 1), dtype=h5py.ref_dtype)
    for place in (0, 2):
        single[place, 0] = referred(file, [[place]])
with open(here / "v73_nothing.mat", "r+b") as file:
    file.write(b"MATLAB 7.3 MAT-file, as h5py writes it".ljust(124) + b"\x00\x02IM")

# numbers in two bytes, as netCDF packs them
with h5py.File(here / "packed.nc", "w") as file:
    file["time"] = time
    stored = {"alpha": [115, 215, -9999, 315, 415], "q": [120, 90, 140, 70, 160]}
    attributes = {"alpha": (0.01, 0.35, -9999, "deg"), "q": (1.0, -110.0, -32768, "deg/s")}
    for name, numbers in stored.items():
        file[name] = np.array(numbers, "i2")
        factor, offset, fill, unit = attributes[name]
        said = {"scale_factor": factor, "add_offset": offset, "_FillValue": np.int16(fill), "units": np.bytes_(unit)}
        file[name].attrs.update(said)
