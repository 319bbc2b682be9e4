"""Fits, diagnoses and many jobs, beside the truth that the bundled recordings were simulated with, and beside the command line."""

import itertools
import math

import pytest
from conftest import DATA, truth

import trimtab


def test_a_fit_finds_the_truth_and_is_that_of_the_command_line(fit, fitted_by_the_command):
    assert (fit.status, fit.outcome) == ("succeeded", "converged")
    table = fit.parameters()
    true = truth("elevator")["truth"]
    free = [row for row in table if not row["fixed"]]
    assert len(free) == 9
    for row in free:
        assert abs(row["estimate"] - true[row["name"]]) < 4 * row["standard_error"], row
    command = {p["name"]: p["estimate"] for p in fitted_by_the_command["estimate"]["parameters"]}
    assert {row["name"]: row["estimate"] for row in table} == pytest.approx(command, rel=1e-9)


def test_results_are_frames_with_units(fit):
    histories = fit.time_histories()
    frame = histories.pandas()
    assert len(frame) == 626 and frame.attrs["units"]["alpha_model"] == "rad"
    assert (frame["alpha"] - frame["alpha_model"] - frame["alpha_residual"]).abs().max() < 1e-15
    titled = histories.polars(titles=True)
    assert titled.columns[:2] == ["segment", "t[s]"] and "q_residual[rad/s]" in titled.columns
    assert titled["q[rad/s]"].to_list() == frame["q"].tolist()
    assert fit.residuals()["q"] == histories["q_residual"]
    along = fit.trajectories(["alpha"])
    assert list(along.columns) == ["segment", "t", "alpha", "alpha_standard_error"]
    assert fit.time_histories(max_points=50).pandas().shape[0] < 200
    correlation = fit.correlation()
    assert len(correlation) == 9 and all(correlation[name][k] == 1 for k, name in enumerate(correlation["parameter"]))


def test_tables_are_written_and_read_again(client, fit, tmp_path):
    file = tmp_path / "along.csv"
    table = fit.trajectories(["alpha", "q"])
    trimtab.Table({k: v for k, v in table.columns.items() if k != "segment"}, table.units).to_csv(file)
    samples = client.data(client.upload(file))
    assert samples["alpha"] == table["alpha"] and samples.units["t"] == "s"


def test_a_prediction_follows_the_recording(client, fit, elevator):
    predicted = fit.predict([elevator], draws=200, names=["alpha"], seed=1)
    measured = client.data(elevator)["alpha"]
    noise = math.radians(truth("elevator")["outputs"]["alpha"]["noise"])
    rms = math.sqrt(sum((m - p) ** 2 for m, p in zip(measured, predicted["alpha"])) / len(measured))
    assert noise * 0.9 < rms < noise * 1.1
    assert all(low <= high for low, high in zip(predicted["alpha_lower"], predicted["alpha_upper"]))


def test_a_diagnosis_names_what_was_put_in(client):
    flights = {role: client.upload(DATA / "effects" / f"elevator-backlash-{role}.csv") for role in ("fit", "check", "final")}
    job = client.diagnose("short-period", [flights["fit"]], validation=[flights["check"]], final=[flights["final"]])
    found = job.diagnosis()
    assert found.verdict == "named" and found.effects[0].kind == "backlash" and found.effects[0].target == "de"
    (size,) = found.effects[0].parameters
    true = truth("effects/elevator-backlash-fit")["effects"][0]["value"]
    assert abs(size["estimate"] - true) < 4 * size["standard_error"]
    final = [row for row in found.fits() if row["role"] == "final" and row["output"] == "q"]
    assert final[0]["rms_after"] < 0.5 * final[0]["rms_before"]
    assert "reason" in found.refused().columns and len(found.refused()) > 20
    again = client.fit(found.model, [flights["final"]], wait=True)
    assert again.outcome == "converged"


def test_many_jobs_are_compared(client):
    scenario = truth("elevator")
    maneuvers = []
    for seed, q in enumerate([-1.2, -1.6, -2.0]):
        csv = client.simulate({**scenario, "seed": seed, "truth": {**scenario["truth"], "Mq": q}})
        frame = trimtab.Table(*_read(csv))
        maneuvers.append(client.upload(frame, name=f"Mq {q}"))
    jobs = client.bulk("short-period", maneuvers, tags=["three"])
    assert [job.outcome for job in jobs] == ["converged"] * 3
    rows = [row for row in client.parameters(jobs) if row["name"] == "Mq"]
    assert [row["title"] for row in rows] == [job.title for job in jobs]
    for row, true in zip(rows, [-1.2, -1.6, -2.0]):
        assert abs(row["estimate"] - true) < 4 * row["standard_error"]
    (curve,) = client.campaign("three", parameters=["Mq"])["curves"]
    assert len(curve["points"]) == 3 and curve["probability"] < 1e-6
    assert {job.id for job in client.jobs(tag="three")} == {job.id for job in jobs}


def _read(csv):
    titles, *rows = [line.split(",") for line in csv.strip().splitlines()]
    names, units = zip(*(title.rstrip("]").split("[") for title in titles))
    return dict(zip(names, map(list, zip(*(map(float, row) for row in rows))))), dict(zip(names, units))


def test_a_list_has_all_its_pages(client, elevator):
    jobs = client.bulk("short-period", [elevator] * 60, wait=False, tags=["pages"], options={"max_iterations": 0})
    found = list(itertools.islice(client.jobs(tag="pages"), 100))
    assert {job.id for job in found} == {job.id for job in jobs} and len(found) == 60
    client.wait(jobs)


def test_models_are_stored_and_used(client, elevator):
    document = {**client.model("short-period"), "name": "mine"}
    id = client.add_model(document)
    assert "mine" in {model["name"] for model in client.models()}
    assert client.fit(id, [elevator]).outcome == "converged"
    client.delete_model(id)
    assert "mine" not in {model["name"] for model in client.models()}


def test_faults_are_told_with_their_places(client, elevator):
    with pytest.raises(trimtab.Problem) as refused:
        client.fit("short-perod", [elevator])
    assert (refused.value.code, refused.value.faults[0].pointer) == ("invalid_job", "/model")
    assert str(refused.value).count("/v1/models lists both") == 1
    with pytest.raises(trimtab.Problem) as refused:
        client.bulk("short-period", [elevator, "0" * 64])
    assert refused.value.faults[0].pointer == "/maneuvers/1/id"


def test_a_job_without_a_result_raises():
    with trimtab.LocalServer(workers=0) as server:
        job = server.client.fit("short-period", [server.client.upload(DATA / "elevator.csv")], wait=False)
        assert job.cancel().status == "cancelled"
        with pytest.raises(trimtab.JobFailed, match="cancelled"):
            job.wait()


def test_a_job_is_deleted_and_run_again(client, fit):
    again = fit.rerun().wait()
    assert again.parameters().columns == fit.parameters().columns
    again.delete()
    with pytest.raises(trimtab.Problem) as gone:
        client.job(again.id)
    assert gone.value.code == "unknown_job"


def test_figures_show_what_was_fitted(client, fit, tmp_path):
    figure = fit.plot()
    lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
    assert set(lines) == {"measured", "model"}
    assert list(lines["model"].get_ydata()) == pytest.approx([math.degrees(v) for v in fit.time_histories()["alpha_model"]])
    for number, drawn in enumerate([figure, fit.plot_correlation(), trimtab.plots.parameters(client.parameters([fit]))]):
        file = tmp_path / f"{number}.png"
        drawn.savefig(file)
        assert file.stat().st_size > 5000
