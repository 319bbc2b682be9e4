"""The package itself: types, documentation, and the notebook that shows it."""

import ast
import subprocess
import sys
from pathlib import Path

import nbformat
from conftest import REPOSITORY
from nbclient import NotebookClient

import trimtab

SOURCE = REPOSITORY / "src" / "python"
INSTALLED = Path(trimtab.__file__).parent

USER = """
import pandas as pd
import polars as pl
import trimtab

client = trimtab.Client()
maneuver: trimtab.Maneuver = client.upload(pd.DataFrame({"t[s]": [0.0]}))
client.upload(pl.DataFrame({"t[s]": [0.0]}))
fit: trimtab.Job = client.fit("short-period", [maneuver], progress=True)
frame: pd.DataFrame = fit.parameters().pandas()
other: pl.DataFrame = fit.parameters().polars()
verdict: str = client.diagnose("short-period", [trimtab.use(maneuver, seconds=[0, 5])]).diagnosis().verdict
reveal_type(fit.outcome)
"""


def mypy(*arguments, cwd):
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", *arguments], cwd=cwd, capture_output=True, text=True)


def test_the_source_is_typed():
    checked = mypy("trimtab", cwd=SOURCE)
    assert checked.returncode == 0, checked.stdout


def test_the_installed_package_has_its_types(tmp_path):
    assert INSTALLED.parent != SOURCE and (INSTALLED / "py.typed").exists()
    (tmp_path / "user.py").write_text(USER)
    checked = mypy("user.py", cwd=tmp_path)
    assert checked.returncode == 0 and 'Revealed type is "str | None"' in checked.stdout.replace("Union[str, None]", "str | None"), checked.stdout
    (tmp_path / "wrong.py").write_text("import trimtab\ntrimtab.Client().fit(3, [])\n")
    assert 'Argument 1 to "fit"' in mypy("wrong.py", cwd=tmp_path).stdout


def test_all_that_is_public_is_documented():
    for file in SOURCE.glob("trimtab/*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.Module)):
                name = getattr(node, "name", file.name)
                assert name.startswith("_") or ast.get_docstring(node), f"{file.name}: {name}"


def test_the_notebook_runs(tmp_path):
    notebook = nbformat.read(SOURCE / "examples" / "campaign.ipynb", as_version=4)
    assert all(cell.cell_type != "code" or not cell.outputs for cell in notebook.cells), "it is kept without its outputs"
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(SOURCE / "examples")}}).execute()
    said = "".join(output.get("text", "") for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs)
    assert "there is play (backlash) behind de" in said and "outliers: ['flight 17']" in said, said
    pictures = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == 3
