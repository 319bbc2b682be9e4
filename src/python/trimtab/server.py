"""A server of one's own on this machine, for as long as it is wanted."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
import threading
from pathlib import Path
from types import TracebackType
from typing import IO, Union

from .client import Client
from .errors import ProgramFailed

_READY_WITHIN = 30.0
_ENDED_WITHIN = 20.0


class LocalServer:
    """A Trimtab server on a free port of this machine, a context manager.

        with trimtab.LocalServer() as server:
            server.client.upload("elevator.csv")

    `program` is the path of `trimtab`; without it `TRIMTAB_PROGRAM`, then the search path. `database` is the file that
    keeps everything; without it, it goes with the server. `workers` run jobs; without it, one on each core. `arguments`
    are further ones of `trimtab serve`. Raises `ProgramFailed`.
    """

    def __init__(
        self,
        program: str | os.PathLike[str] | None = None,
        database: str | os.PathLike[str] | None = None,
        workers: int | None = None,
        arguments: tuple[str, ...] = (),
        listen: str = "127.0.0.1:0",
    ) -> None:
        self._program = _found(program)
        self._database = database
        self._arguments = ["--listen", listen, *([] if workers is None else ["--workers", str(workers)]), *arguments]
        self._directory: tempfile.TemporaryDirectory[str] | None = None
        self._process: subprocess.Popen[str] | None = None
        self._client: Client | None = None
        self._said: IO[str] | None = None
        #: Where it listens, as soon as it is started.
        self.url = ""

    @property
    def client(self) -> Client:
        """A client of it."""
        if self._client is None:
            raise ProgramFailed("the server is not started: `with trimtab.LocalServer() as server:`, or server.start()")
        return self._client

    def start(self) -> LocalServer:
        """Starts it, and waits until it listens."""
        self._directory = tempfile.TemporaryDirectory(prefix="trimtab-")
        folder = Path(self._directory.name)
        database = Path(self._database) if self._database is not None else folder / "trimtab.db"
        self._said = open(folder / "said", "w+", encoding="utf-8")
        command = [self._program, "serve", "--database", str(database), "--log", "warn", *self._arguments]
        # Ctrl-C is for the notebook: the server is ended with the context
        self._process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=self._said, text=True, start_new_session=os.name == "posix"
        )
        line = _first_line(self._process)
        if not line.startswith("listening on "):
            self._said.seek(0)
            said = self._said.read().strip()
            self.stop()
            raise ProgramFailed(f"{' '.join(command)} does not start: {said or line or 'it says nothing'}")
        self.url = line.removeprefix("listening on ").strip()
        self._client = Client(self.url)
        return self

    def stop(self) -> None:
        """Ends it as an operator would: what runs is put back into the queue of its database."""
        if self._client is not None:
            self._client.close()
            self._client = None
        if self._process is not None:
            _end(self._process)
            self._process = None
        if self._said is not None:
            self._said.close()
        if self._directory is not None:
            self._directory.cleanup()
            self._directory = None

    def __enter__(self) -> LocalServer:
        return self.start()

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.stop()


def _found(program: Union[str, "os.PathLike[str]", None]) -> str:
    wanted = os.fspath(program) if program is not None else os.environ.get("TRIMTAB_PROGRAM", "trimtab")
    found = shutil.which(wanted)
    if found is None:
        raise ProgramFailed(f"there is no program {wanted}: put `trimtab` on the search path, or its path into TRIMTAB_PROGRAM")
    return found


def _first_line(process: subprocess.Popen[str]) -> str:
    """What it prints when it listens; nothing if it ends, or is not ready in time."""
    lines: list[str] = []
    assert process.stdout is not None
    reader = threading.Thread(target=lambda out: lines.append(out.readline()), args=(process.stdout,), daemon=True)
    reader.start()
    reader.join(_READY_WITHIN)
    return lines[0] if lines else ""


def _end(process: subprocess.Popen[str]) -> None:
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
        try:
            process.wait(_ENDED_WITHIN)
        except subprocess.TimeoutExpired:
            process.kill()
    process.wait()
    if process.stdout is not None:
        process.stdout.close()
