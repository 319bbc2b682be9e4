"""Uploads: a frame is the recording that the file is. Its id is the SHA-256 of the content, so that equal ids are equal samples."""

import pandas as pd
import polars as pl
import pytest
from conftest import DATA

import trimtab


def test_a_file_and_frames_of_it_are_one_recording(client, elevator):
    file = DATA / "elevator.csv"
    assert (elevator.samples, elevator.name) == (626, "elevator")
    assert elevator.channels["q"] == "deg/s"
    frame = pd.read_csv(file)
    assert client.upload(frame, name="frame").id == elevator.id
    assert client.upload(pl.read_csv(file), name="polars").id == elevator.id
    bare = frame.rename(columns=lambda title: title.split("[")[0])
    units = {title.split("[")[0]: title.split("[")[1].rstrip("]") for title in frame.columns}
    assert client.upload(bare, units=units).id == elevator.id
    bare.attrs["units"] = units
    assert client.upload(bare.set_index("t")).id == elevator.id
    assert client.upload(trimtab.Table({name: bare[name].tolist() for name in bare}, units)).id == elevator.id


def test_times_and_gaps_of_frames(client):
    at = pd.date_range("2026-11-21T10:15:00Z", periods=40, freq="50ms")
    frame = pd.DataFrame({"q[deg/s]": [float(k % 7) for k in range(40)]}, index=at)
    frame.iloc[3, 0] = float("nan")
    maneuver = client.upload(frame, name="dates")
    assert maneuver.duration == pytest.approx(39 * 0.05, abs=1e-9)
    samples = client.data(maneuver)
    assert samples.units["q"] == "rad/s" and samples["q"][3] is None
    assert samples["q"][5] == pytest.approx(5 * 3.141592653589793 / 180, rel=1e-12)


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        ({"t": [0.0, 0.1], "q[deg/s]": [1.0, 2.0]}, "no unit"),
        ({"q[deg/s]": [1.0, 2.0]}, "no column t or time"),
        ({"t[s]": [0.0, 0.1], "note": ["up", "down"]}, "column note is not numbers"),
        ({"t[s]": [0.0, 0.1], "q[deg/s]": [1.0, 2.0], "q[rad/s]": [0.0, 0.0]}, "two columns of the frame are called q"),
        ({"t": [pd.Timestamp(0), pd.NaT], "q": [1.0, 2.0]}, "row 2 of t has no time"),
    ],
)
def test_what_a_frame_does_not_say_is_asked_for(client, frame, words):
    with pytest.raises(ValueError, match=words):
        client.upload(pd.DataFrame(frame))


def test_units_of_a_column_that_is_not_there_are_asked_about(client):
    with pytest.raises(ValueError, match="`units` has alhpa"):
        client.upload(pd.DataFrame({"t[s]": [0.0, 0.1], "alpha": [1.0, 2.0]}), units={"alhpa": "deg"})


def test_a_refused_file_says_where_and_what_to_do(client, tmp_path):
    file = tmp_path / "logger.csv"
    file.write_text("Channel 0,Channel 1\n0,1\n1,2\n")
    with pytest.raises(trimtab.Problem) as refused:
        client.upload(file)
    assert refused.value.status == 422 and refused.value.faults
    assert refused.value.mapping is not None and "channels" in refused.value.mapping


def test_what_was_flown_is_said_and_found(client, elevator):
    said = client.describe(elevator, {"registration": "D-ADAM", "mass": {"value": 17600, "unit": "kg"}})
    assert said.flown["registration"] == "D-ADAM"
    assert [found.id for found in client.maneuvers(registration="D-ADAM")] == [elevator.id]
    assert list(client.maneuvers(registration="D-NONE")) == []
    assert "registration" not in client.describe(elevator, {"registration": None}).flown
