"""Acts that a confined process cannot do, tried by a process that does them well before."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from minirt.kernel.machine_code.fingerprint import is_linux_on_x86_64
from tests.cli.program import environment
from tests.jail.breakouts import ACTS, landlock_version, outcomes
from tests.lines import next_line
from tests.processes import is_running, run, started
from tests.waiting import until

IS_ROOT = hasattr(os, "geteuid") and os.geteuid() == 0
# What the control may be refused by other guards of the system: containers, Yama, settings of the kernel.
GUARDED = {"use io_uring", "trace the parent", "write into the parent", "open the parent's memory"}

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are confined on Linux")


def refused(outcomes: dict[str, str]) -> set[str]:
    """Return the acts that were refused."""
    assert set(outcomes.values()) <= {"refused", "done"}
    return {name for name, outcome in outcomes.items() if outcome == "refused"}


def test_without_confinement_all_acts_are_possible(tmp_path: Path) -> None:
    assert refused(outcomes(tmp_path, None)) <= GUARDED


@pytest.mark.skipif(not is_linux_on_x86_64(), reason="the filter of system calls is for x86-64")
@pytest.mark.parametrize("without", [(), ("Landlock",)], ids=["whole", "without Landlock"])
def test_a_confined_process_can_do_nothing_else(tmp_path: Path, without: tuple[str, ...]) -> None:
    assert refused(outcomes(tmp_path, without)) == set(ACTS)


@pytest.mark.parametrize("without", [("filter",), ("filter", "Landlock")], ids=["without filter", "limits alone"])
def test_parts_of_the_confinement_refuse_what_they_should(tmp_path: Path, without: tuple[str, ...]) -> None:
    version = 0 if "Landlock" in without else landlock_version()
    expected = {
        name
        for name, act in ACTS.items()
        if act.by_limits or act.landlock <= version or (act.by_limits_unless_root and not IS_ROOT)
    }
    found = refused(outcomes(tmp_path, without))
    assert found >= expected
    assert "wait for long" not in found  # what only the filter refuses


@pytest.mark.skipif(not IS_ROOT, reason="only root can become another user")
def test_limits_refuse_processes_and_threads_to_all_but_root(tmp_path: Path) -> None:
    nobody = 65534
    assert not refused(outcomes(tmp_path, None, nobody)) - {"raise a limit"}
    found = outcomes(tmp_path, ("filter", "Landlock"), nobody)
    assert refused(found) == set(found)


def test_a_confined_process_ends_when_its_time_is_up(tmp_path: Path) -> None:
    source = "from minirt.jail import confinement\nconfinement.CPU_TIME = 1\nconfinement.confine()\nwhile True: pass"
    assert run([sys.executable, "-c", source], env=environment()).returncode == -signal.SIGXCPU


def test_lower_limits_of_the_caller_stay() -> None:
    source = (
        "import resource\nfrom minirt.jail import confinement\n"
        "resource.setrlimit(resource.RLIMIT_CPU, (7, 7))\n"
        "confinement.forbid_system_calls = lambda library: None\n"
        "confinement.confine()\nprint(*resource.getrlimit(resource.RLIMIT_CPU))"
    )
    assert run([sys.executable, "-c", source], env=environment(), text=True).stdout == "7 7\n"


ORPHAN = """
import subprocess, sys
source = "from minirt.jail import confinement\\nconfinement.confine()\\nprint('ready', flush=True)\\nwhile True: pass"
child = subprocess.Popen([sys.executable, "-c", source], stdout=subprocess.PIPE)
child.stdout.readline()
print(child.pid, flush=True)
child.wait()
"""


def test_a_confined_process_ends_with_its_parent() -> None:
    with started([sys.executable, "-c", ORPHAN], env=environment(), stdout=subprocess.PIPE, text=True) as parent:
        child = int(next_line(parent))
        assert is_running(child)
        parent.kill()
        until(lambda: not is_running(child), "the end of the confined process")
