"""A notebook's worth of Trimtab in Python, with a client generated from openapi/trimtab.json: see tests/python/run.

    TRIMTAB_SERVER, TRIMTAB_KEY   where the server is, and the key if it needs one
"""
import os
from pathlib import Path

from trimtab_client import AuthenticatedClient
from trimtab_client.api.jobs import get_job, list_events, list_jobs, rerun_job, submit_job
from trimtab_client.api.maneuvers import get_maneuver, upload_file
from trimtab_client.api.results import get_diagnosis, get_parameters
from trimtab_client.models import DiagnosisEvent, IterationEvent, JobKind, JobSpec, ManeuverUse, Problem, Role, SucceededEvent
from trimtab_client.types import File

DATA = Path(__file__).parents[2] / "data"
server = AuthenticatedClient(os.environ.get("TRIMTAB_SERVER", "http://127.0.0.1:8300"),
                             token=os.environ.get("TRIMTAB_KEY", "none"), timeout=90)


def upload(file):
    """A recording, as it is."""
    with file.open("rb") as payload:
        return upload_file.sync(client=server, body=File(payload=payload), name=file.stem).id


def run(spec):
    """Submits a job and waits for its end; a Problem says what is wrong with it, and where."""
    job = submit_job.sync(client=server, body=spec, prefer="wait=60")
    if isinstance(job, Problem):
        raise SystemExit(f"{job.detail}\n" + "\n".join(f"{fault.pointer}: {fault.message}" for fault in job.errors))
    while job.finished is None:
        job = get_job.sync(id=job.id, client=server)
    return job


# a fit
elevator = upload(DATA / "elevator.csv")
print(get_maneuver.sync(id=elevator, client=server).name)
fit = run(JobSpec(model="short-period", maneuvers=[ManeuverUse(id=elevator)], tags=["notebook"]))
print(fit.status, fit.reason)
for row in get_parameters.sync(id=fit.id, client=server).parameters:
    error = "fixed" if row.standard_error is None else f"± {row.standard_error:.5f}"
    print(f"{row.name:8} {row.estimate:10.5f} {error} {row.unit}")

# its log: each event is of its own kind
events = list_events.sync(id=fit.id, client=server).events
costs = [event.cost for event in events if isinstance(event, IterationEvent)]
assert costs == sorted(costs, reverse=True) and isinstance(events[-1], SucceededEvent)
print(f"{len(costs)} iterations, -ln L from {costs[0]:.1f} to {costs[-1]:.1f}")

# a mistake, and what is said of it
wrong = submit_job.sync(client=server, body=JobSpec(model="short-perod", maneuvers=[ManeuverUse(id=elevator)]))
assert isinstance(wrong, Problem) and wrong.errors[0].pointer == "/model", wrong

# what the model lacks
roles = {"fit": Role.ESTIMATION, "check": Role.VALIDATION, "final": Role.FINAL}
flights = [ManeuverUse(id=upload(DATA / "effects" / f"elevator-backlash-{name}.csv"), role=role) for name, role in roles.items()]
found = run(JobSpec(kind=JobKind.DIAGNOSE, model="short-period", maneuvers=flights))
diagnosis = get_diagnosis.sync(id=found.id, client=server)
print(diagnosis.verdict, "-", diagnosis.sentence)
assert diagnosis.effects[0].kind == "backlash"
accepted = [event for event in list_events.sync(id=found.id, client=server).events
            if isinstance(event, DiagnosisEvent) and event.step == "accepted"]
assert [event.name for event in accepted] == ["backlash of de"]

# the same numbers again
again = rerun_job.sync(id=fit.id, client=server)
while again.finished is None:
    again = get_job.sync(id=again.id, client=server)
both = [get_parameters.sync(id=job.id, client=server).to_dict() for job in (fit, again)]
assert both[0] == both[1]
assert len(list_jobs.sync(client=server, tag="notebook").jobs) == 2
print("run again: the same numbers")
