"""tools_test.py types|wheel|notebook: the package as Debian's own tools see it. A tool that is missing is told."""

import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Dict, List, Optional

SOURCE = Path(os.environ["PARALLAX_SOURCE"]).resolve()
PACKAGE = SOURCE / "tools" / "python"


def skip(what: str) -> None:
    print("SKIPPED: there is no %s" % what)
    sys.exit(0)


def has_module(name: str) -> bool:
    return subprocess.run([sys.executable, "-c", "import " + name], capture_output=True).returncode == 0


def run(command: List[str], folder: Path, env: Optional[Dict[str, str]] = None) -> None:
    done = subprocess.run(command, cwd=folder, env=env, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit("%s\n%s" % (" ".join(command), done.stdout))


def types(folder: Path) -> None:
    """mypy --strict and pyflakes say nothing."""
    if not has_module("mypy") or not has_module("pyflakes"):
        skip("mypy or pyflakes (Debian: mypy, python3-pyflakes)")
    run([sys.executable, "-m", "mypy", "--config-file", "pyproject.toml", "--cache-dir",
         str(folder), "parallax", "examples/kinematic_2d.py"], PACKAGE)
    run([sys.executable, "-m", "pyflakes", "parallax", "examples", str(SOURCE / "tests/tools/python")],
        PACKAGE)


def wheel(folder: Path) -> None:
    """The wheel has what the package needs, and what it has can be imported and asked."""
    if not has_module("build") or not has_module("wheel"):
        skip("python3-build or python3-wheel")
    shutil.copytree(PACKAGE, folder / "python")  # links become files
    run([sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder)],
        folder / "python")
    made = list(folder.glob("parallax-*-py3-none-any.whl"))
    assert len(made) == 1, made
    names = zipfile.ZipFile(made[0]).namelist()
    for name in ("parallax/__init__.py", "parallax/py.typed", "parallax_adapter.py"):
        assert name in names, names
    zipfile.ZipFile(made[0]).extractall(folder / "installed")
    (folder / "lamp.e").write_text("sort lamp\nlamp A\nfluent On(lamp)\nrange time 0 1\n")
    env = dict(os.environ, PYTHONPATH=str(folder / "installed"))
    run([sys.executable, "-c", "import parallax as px; px.adapter_check; print(px.__file__);"
         "assert int(px.Model('lamp.e').count()) == 2"], folder, env)


def notebook(folder: Path) -> None:
    """All cells run, and their pictures are there."""
    if not has_module("nbconvert") or not has_module("ipykernel"):
        skip("jupyter (Debian: jupyter-nbconvert, python3-ipykernel)")
    env = dict(os.environ, HOME=str(folder), IPYTHONDIR=str(folder), JUPYTER_DATA_DIR=str(folder),
               JUPYTER_RUNTIME_DIR=str(folder), JUPYTER_CONFIG_DIR=str(folder))
    run([sys.executable, "-m", "nbconvert", "--to", "html", "--execute",
         "--ExecutePreprocessor.timeout=300", "--output-dir", str(folder), "two_regions.ipynb"],
        PACKAGE / "examples", env)
    page = (folder / "two_regions.html").read_text(encoding="utf-8")
    kept = os.environ.get("PARALLAX_KEEP_PAGE")
    if kept:  # to look at it
        shutil.copy(folder / "two_regions.html", kept)
    for words in ("no errors, no warnings", "plan ended: done", "13824 traces; the first ones",
                  "holds up to horizon", "proof: checked", "after Place(r1) BoxIn(r1) is false",
                  "starts of 30 simulations", "box.x [m]", "Initiates(Place(region)",
                  "line 4 column 16 E2101 - replace"):
        assert words in page, words
    assert "Traceback" not in page


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made_here:
        {"types": types, "wheel": wheel, "notebook": notebook}[sys.argv[1]](Path(made_here))
