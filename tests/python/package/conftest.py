"""The real program, with a server for all tests; TRIMTAB_PROGRAM says where it is."""

import json
import os
import subprocess
import tomllib
from pathlib import Path

import pytest

import trimtab

REPOSITORY = Path(__file__).parents[3]
DATA = REPOSITORY / "data"
PROGRAM = os.environ["TRIMTAB_PROGRAM"]


def command(*arguments):
    """What the program says on the command line, for comparison."""
    done = subprocess.run([PROGRAM, *arguments], cwd=REPOSITORY, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def truth(scenario):
    """The true values with which a bundled recording was simulated."""
    return tomllib.loads((DATA / f"{scenario}.toml").read_text())


@pytest.fixture(scope="session")
def client():
    with trimtab.LocalServer() as server:
        yield server.client


@pytest.fixture(scope="session")
def elevator(client):
    return client.upload(DATA / "elevator.csv")


@pytest.fixture(scope="session")
def fit(client, elevator):
    return client.fit("short-period", [elevator], name="elevator, fitted", tags=["package"])


@pytest.fixture(scope="session")
def fitted_by_the_command():
    return json.loads(command("fit", "data/elevator.csv", "-m", "short-period", "--json"))
