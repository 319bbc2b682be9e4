"""A client that a generator made of openapi/trimtab.json: it runs a fit and a diagnosis, and says nothing of what it cannot do but this."""

import os
import subprocess
import sys

import trimtab
from conftest import REPOSITORY, command

# types of bodies that the generator does not know: metrics are for Prometheus, and a model may be sent as JSON, too
KNOWN = {
    "Unsupported content_type application/openmetrics-text",
    "Unsupported content type application/toml",
    # what a simulator reads: a file to be kept, not an answer to be parsed
    "Unsupported content_type application/zip, application/xml",
}


def test_a_generated_client_runs_a_fit_and_a_diagnosis(tmp_path):
    generate = ["generate", "--path", REPOSITORY / "openapi" / "trimtab.json", "--meta", "none"]
    output = tmp_path / "trimtab_client"
    made = subprocess.run(
        [sys.executable, "-m", "openapi_python_client", *generate, "--output-path", output], capture_output=True, text=True
    )
    assert made.returncode == 0, made.stdout + made.stderr
    said = [line for line in (made.stdout + made.stderr).splitlines() if line.startswith(("Unsupp", "Cannot", "Unable", "Fail", "Invalid"))]
    assert all(any(known in line for known in KNOWN) for line in said), said
    database = tmp_path / "trimtab.db"
    key = command("key", "new", "--scope", "read", "--scope", "submit", "--database", str(database)).strip()
    with trimtab.LocalServer(database=database) as server:
        environment = {**os.environ, "PYTHONPATH": str(tmp_path), "TRIMTAB_SERVER": server.url, "TRIMTAB_KEY": key}
        example = [sys.executable, REPOSITORY / "tests" / "python" / "example.py"]
        ran = subprocess.run(example, env=environment, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert "run again: the same numbers" in ran.stdout
