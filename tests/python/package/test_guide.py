"""The Python in the guide: all blocks of a page, one behind the other."""

import os
import re

import pytest
from conftest import REPOSITORY

GUIDE = REPOSITORY / "src" / "guide"
PAGES = {page.stem: re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S) for page in sorted(GUIDE.glob("*.md"))}


@pytest.mark.parametrize("page", [page for page, blocks in PAGES.items() if blocks])
def test_the_python_of_a_page_runs(page, tmp_path, monkeypatch):
    os.symlink(REPOSITORY / "data", tmp_path / "data")
    monkeypatch.chdir(tmp_path)
    exec(compile("\n".join(PAGES[page]), f"{page}.md", "exec"), {"__name__": page})
