"""Run the quick tests, a film, a window and a notebook with each other Python that the machine has: `make pythons`.

Each gets a new environment in .venv/pythons, with the newest versions of all packages, and a cache of kernels.
`python -m tests.pythons newest` takes the newest of them alone, and only tests of what may depend on Python, for
`make newest`; `python -m tests.pythons lowest` prints the lowest versions of the dependencies as arguments of pip, for
`make lowest`.
The Pythons are those that pyproject.toml names, but for the one of .venv, with which `make test` runs all tests.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from tests.paths import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
FOLDER = Path(".venv/pythons")
TESTS = "QUICK=not window and not slow or each_python"  # the quick ones, a film, a window and a notebook
# Records and their copies, the compiler of formulas and of small kernels, forks, pictures, and each way to use miniRT.
OF_PYTHON = [f"tests/{name}.py" for name in (
    "test_records", "test_library", "test_goldens", "scene/test_save", "shapes/test_protocol", "kernel/test_compiler",
    "helpers/test_fork_safety", "formats/test_films", "cli/test_habits", "mlx/test_memory", "viewer/app/test_session",
    "viewer/app/test_real_window", "notebook/test_notebook",
)]  # fmt: skip
OF_NUMPY = "-k 'not hull and not equal_the_reference and not stored_goldens'"  # leaves out tests whose work numpy does


def named() -> list[str]:
    """Return the versions of Python that pyproject.toml names, such as 3.11."""
    return re.findall(r"Python :: (3\.\d+)", "\n".join(PROJECT["classifiers"]))


def lowest_versions(*extras: str) -> list[str]:
    """Return requirements such as `numpy==2.0`, one for each dependency of every platform and of some extras."""
    required = PROJECT["dependencies"] + [each for name in extras for each in PROJECT["optional-dependencies"][name]]
    everywhere = [each for each in required if ";" not in each]
    return [re.sub(r"^([\w-]+)>=([\d.]+).*$", r"\1==\2", each) for each in everywhere]


def find(version: str) -> Path | None:
    """Return the path of a Python on PATH or in pyenv; None where there is none that starts."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    on_path = shutil.which(f"python{version}")
    for path in ([Path(on_path)] if on_path else []) + sorted(pyenv.glob(f"{version}.*/bin/python")):
        started = subprocess.run([path, "-c", "import venv, ensurepip"], capture_output=True, check=False)
        if started.returncode == 0:  # pyenv's shims fail, but for the versions that are chosen
            return path
    return None


def passes(version: str, python: Path, newest: bool) -> bool:
    """Run the tests with a Python in a new environment; return whether all pass."""
    folder = FOLDER / version
    shutil.rmtree(ROOT / folder, ignore_errors=True)
    cache = ROOT / folder / "cache"
    cache.mkdir(parents=True)
    make = ["make", "--no-print-directory", "quick", f"VENV={folder}", f"PYTHON={python}"]
    make += ["QUICK=not window or each_python", f"TESTS={' '.join(OF_PYTHON)} {OF_NUMPY}"] if newest else [TESTS]
    environment = os.environ | {"XDG_CACHE_HOME": str(cache), "MAKEFLAGS": "", "OPENBLAS_NUM_THREADS": "2"}  # as users
    return subprocess.run(make, cwd=ROOT, env=environment, check=False).returncode == 0


def main(newest: bool) -> int:
    """Run the tests with each Python or the newest, and print what became of it; return 1 where some fail."""
    others = [version for version in named() if version != f"3.{sys.version_info.minor}"]
    told = dict.fromkeys(others, "not found on PATH or in pyenv")
    found = {version: python for version in others if (python := find(version))}
    for version, python in list(found.items())[-1 if newest else 0 :]:
        print(f"Python {version}: {python}", flush=True)
        told[version] = "passed" if passes(version, python, newest) else "FAILED"
    told |= dict.fromkeys([version for version in found if "not found" in told[version]], "left out")
    print(*(f"Python {version}: {what}" for version, what in told.items()), sep="\n")
    return int("FAILED" in told.values())


if __name__ == "__main__":
    if sys.argv[1:] == ["lowest"]:
        print(*lowest_versions("video", "report"))
    else:
        sys.exit(main(newest=sys.argv[1:] == ["newest"]))
