"""Lines that break and servers that go away: nothing is lost, nothing comes twice, nothing is done twice."""

import socket
import threading
import time

import pytest
from conftest import DATA, command
from proxy import Line

import trimtab
from trimtab import events


@pytest.fixture
def line(client):
    line = Line(client._connection.server)
    yield line
    line.close()


def test_events_come_each_once_over_a_line_that_breaks(client, fit, line):
    whole = [event.raw for event in client.follow(fit)]
    assert [event["seq"] for event in whole] == list(range(1, len(whole) + 1)) and whole[-1]["type"] == "succeeded"
    # within the head, within an event, between events
    line.cut_after(0, 100, 700, 1500, 2000)
    with trimtab.Client(line.url, retries=0) as broken:
        seen = [event.raw for event in broken.follow(fit.id)]
    assert seen == whole and line.connections >= 6


def test_events_behind_a_number_and_behind_the_last(client, fit):
    whole = list(client.follow(fit))
    assert [event.seq for event in client.follow(fit, after=3)] == list(range(4, len(whole) + 1))
    assert list(client.follow(fit, after=len(whole))) == []


def test_an_upload_whose_answer_is_lost_is_sent_again(client, line):
    line.cut_after(0)
    with trimtab.Client(line.url) as broken:
        assert broken.upload(DATA / "rudder.csv").samples > 100
    assert line.connections == 2


def test_a_job_whose_answer_is_lost_is_submitted_once(client, elevator, line):
    line.cut_after(0)
    with trimtab.Client(line.url) as broken:
        broken.fit("short-period", [elevator.id], tags=["once"], wait=False)
    jobs = list(client.jobs(tag="once"))
    assert len(jobs) == 1
    client.wait(jobs)


def test_what_is_sent_again_while_it_is_worked_on_is_waited_for(client, elevator):
    with trimtab.Client(client._connection.server, timeout=0.05, retries=15) as hasty:
        hasty.bulk("short-period", [elevator] * 200, tags=["hasty"], options={"max_iterations": 0}, wait=False)
    jobs = list(client.jobs(tag="hasty"))
    assert len(jobs) == 200
    client.wait(jobs)


def test_a_follower_is_patient_for_so_long_and_no_longer(monkeypatch):
    for name, seconds in [("_SILENCE", 0.2), ("_PATIENCE", 1.0), ("_PAUSE", 0.1)]:
        monkeypatch.setattr(events, name, seconds)
    with socket.create_server(("127.0.0.1", 0)) as mute, trimtab.Client(f"http://127.0.0.1:{mute.getsockname()[1]}") as client:
        began = time.monotonic()
        with pytest.raises(trimtab.Unreachable):
            list(client.follow("00000000-0000-0000-0000-000000000000"))
        assert 1.0 < time.monotonic() - began < 10.0


def test_a_restarted_server_is_waited_for(tmp_path, fit):
    with socket.create_server(("127.0.0.7", 0)) as free:
        listen = f"127.0.0.7:{free.getsockname()[1]}"
    seen = []
    at = {"database": tmp_path / "kept.db", "listen": listen}
    with trimtab.LocalServer(workers=0, **at) as first:
        url = first.url
        job = first.client.fit("short-period", [first.client.upload(DATA / "elevator.csv")], wait=False)
        # two lines of it are there: a follower waits for the third when the server goes
        following = threading.Thread(target=lambda: seen.extend(trimtab.Client(url).follow(job.id)))
        following.start()
    with trimtab.LocalServer(workers=1, **at) as second:
        following.join(60)
        assert not following.is_alive() and second.url == url
        events = [event.raw for event in second.client.follow(job.id)]
    assert [event.raw for event in seen] == events and events[-1]["type"] == "succeeded"


def test_names_may_have_any_letter(client, elevator):
    name = "nose\u2028up\x85 α"
    fit = client.fit("short-period", [trimtab.use(elevator, label=name)], options={"max_iterations": 0})
    prepared = [event.raw for event in fit.follow() if event.type == "prepared"]
    assert prepared[0]["segments"] == [name]


def test_bars_count_what_happens(client, fit, elevator, capsys):
    iterations = sum(event.type == "iteration" for event in fit.follow(progress=True))
    shown = capsys.readouterr().err
    assert f": {iterations} [" in shown
    assert "elevator, fitted" in shown and "converged" in shown
    client.bulk("short-period", [elevator] * 2, progress=True, options={"max_iterations": 0})
    assert "2/2" in capsys.readouterr().err


def test_no_server_and_no_program_are_told():
    with pytest.raises(trimtab.Unreachable, match="trimtab serve"):
        trimtab.Client("http://127.0.0.1:1", retries=0).ready()
    with pytest.raises(trimtab.ProgramFailed, match="TRIMTAB_PROGRAM"):
        trimtab.LocalServer(program="no-such-program")
    with pytest.raises(trimtab.ProgramFailed, match="no-such-directory"):
        trimtab.LocalServer(database="/no-such-directory/trimtab.db").start()


def test_a_key_is_sent(tmp_path):
    database = tmp_path / "locked.db"
    key = command("key", "new", "--scope", "read", "--database", str(database)).strip()
    with trimtab.LocalServer(database=database) as server:
        with pytest.raises(trimtab.Problem) as refused:
            list(server.client.jobs())
        assert refused.value.status == 401
        with trimtab.Client(server.url, key=key) as client:
            assert list(client.jobs()) == []
