"""Client of Trimtab, a service that estimates aircraft parameters from flight-test maneuvers.

    client = trimtab.Client("http://127.0.0.1:8300")
    elevator = client.upload("elevator.csv")
    fit = client.fit("short-period", [elevator])
    fit.parameters().pandas()

`Client` has a method for each thing that is asked of a server, `Job` one for each result, `Table` is what results
come as, `LocalServer` starts a server of one's own. What goes wrong is a `TrimtabError`.
"""

from .client import Client
from .diagnosis import Diagnosis, Effect
from . import plots
from .errors import Fault, JobFailed, Problem, ProgramFailed, TrimtabError, Unreachable
from .events import Event
from .job import Job
from .maneuver import Maneuver, use
from .server import LocalServer
from .table import Table

__all__ = [
    "Client",
    "Diagnosis",
    "Effect",
    "Event",
    "Fault",
    "Job",
    "JobFailed",
    "LocalServer",
    "Maneuver",
    "Problem",
    "ProgramFailed",
    "Table",
    "TrimtabError",
    "Unreachable",
    "plots",
    "use",
]

__version__ = "0.1.0"
