"""Progress bars (tqdm): of one job by its events, of many by how many are over."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from .errors import TrimtabError
from .events import Event

if TYPE_CHECKING:
    from tqdm import tqdm


def bar(title: str, total: int | None = None) -> tqdm[None]:
    """A bar; in a notebook that has widgets it is the notebook's own."""
    try:
        made: Any = import_module("tqdm.auto" if find_spec("ipywidgets") else "tqdm").tqdm
    except ImportError as error:
        raise TrimtabError("a progress bar needs tqdm: pip install 'trimtab[progress]'") from error
    shown: tqdm[None] = made(total=total, desc=title, unit="")
    return shown


def shown(stream: Iterable[Event], title: str) -> Iterator[Event]:
    """The events of a job, while a bar says how far it is."""
    with bar(title) as shown:
        for event in stream:
            _advance(shown, event)
            yield event


def _advance(shown: tqdm[None], event: Event) -> None:
    raw = event.raw
    if event.type == "iteration":
        shown.update()
        shown.set_postfix_str(f"-ln L {raw['cost']:.6g}")
    elif event.type == "diagnosis" and raw["step"] == "screened":
        shown.reset(total=raw["visible"])
        shown.set_postfix_str(f"round {raw['round']}")
    elif event.type == "diagnosis" and raw["step"] == "tried":
        shown.update()
    elif event.type == "finding":
        shown.total = raw["of"]
        shown.update()
    elif event.is_last:
        shown.set_postfix_str(str(raw.get("outcome", event.type)))
