"""What a Python team would build for the same job: FastAPI, RQ on Redis, and the fastest peer solver.

    uvicorn service:app            the API:  POST /jobs (a CSV as tests/bench/load.rs sends it), GET /jobs/{id}
    python service.py              a worker: the solver is compiled once, jobs run in this process without a fork

PEERS names the folder of the peers, REDIS_PORT the port of a Redis.
"""
import os
import sys

from fastapi import FastAPI, Request, Response
from redis import Redis
from rq import Queue, SimpleWorker
from rq.job import Job

REDIS = Redis(port=int(os.environ["REDIS_PORT"]))
QUEUE = Queue(connection=REDIS)
app = FastAPI()


@app.post("/jobs", status_code=202)
async def submit(request: Request):
    job = QUEUE.enqueue("service.estimate", (await request.body()).decode(), result_ttl=3600)
    return {"id": job.id}


@app.get("/jobs/{job_id}")
def status(job_id: str, response: Response):
    job = Job.fetch(job_id, connection=REDIS)
    result = job.return_value() if job.is_finished else None
    return {"id": job_id, "status": job.get_status(), "finished": result}


SOLVER = {}


def estimate(text):
    """Parameters of the short period from a recording with t, de, alpha and q, in rad or deg."""
    import io

    import numpy as np
    import pandas as pd

    sys.path.insert(0, os.environ["PEERS"])
    import driver
    import models
    import peer_numba
    import problems

    table = pd.read_csv(io.StringIO(text))

    def column(name):
        header = next(header for header in table if header.startswith(name + "["))
        values = table[header].to_numpy()
        return np.radians(values) if "deg" in header else values

    t, de, alpha, q = (column(name) for name in ("t", "de", "alpha", "q"))
    before = t - t[0] < 1.0
    al, de0 = alpha[before].mean(), de[before].mean()
    start = [-1.0, 1.0, -0.1, -1.0, -1.0, -1.0, al, de0, 0.0]
    problem = problems._single(
        "P1", models.ShortPeriod, de[:, None], np.column_stack([alpha, q]), [al, 0.0], t[1] - t[0], start)
    if "peer" not in SOLVER:
        SOLVER["peer"] = peer_numba.Fused(problem, 1)
    peer = SOLVER["peer"]
    peer.pr = problem  # compiled for the model, not for the recording
    result = driver.solve(peer, problem, 1e-8)
    return {key: np.asarray(result[key]).tolist() for key in ("theta", "R", "cost", "converged")}


if __name__ == "__main__":
    # as jobs know it: compiled there, it is compiled for them
    from service import estimate as warm

    with open(os.environ["WARM_UP"]) as file:
        text = file.read()
    for _ in range(2):
        warm(text)
    SimpleWorker([QUEUE], connection=REDIS).work(logging_level="WARNING")
