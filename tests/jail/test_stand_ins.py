"""Stand-ins for modules that the helper does not need: Pillow decodes with them, or gets the real ones."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from minirt.jail import decoder, helper, stand_ins
from minirt.jail.helper import Helper
from tests.cli.program import environment
from tests.jail.pictures import FILES
from tests.processes import run

LOAD = """
import sys
from minirt.jail import stand_ins
sys.modules.pop("typing", None)
stand_ins.install()
from minirt.jail import process
process.load_decoders()
stand_ins.remove()
print(*sorted({"PIL.Image", "typing", "logging", "subprocess", "decimal"} & sys.modules.keys()))
"""
DEMANDING = "import subprocess\nif subprocess.PIPE != -1: raise RuntimeError\n"


def test_pillow_needs_none_of_the_real_modules() -> None:
    start = helper.START.partition("from minirt.jail import stand_ins")[0]
    folder = Path(helper.__file__).parent
    command = [sys.executable, "-S", "-P", "-c", start + LOAD, str(folder.parent), str(folder)]
    ended = run(command, env=environment() | {"PYTHONPATH": ":".join(sys.path)}, text=True)
    assert ended.stdout == "PIL.Image\n", ended.stderr


def test_a_pillow_that_needs_a_real_module_gets_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "demanding.py").write_text(DEMANDING)
    monkeypatch.syspath_prepend(tmp_path)
    planted = "from minirt.jail import process\nprocess.MODULES += ('demanding',)\nprocess.main()"
    start = helper.START.replace("from minirt.jail.process import main\nmain()", planted)
    assert planted in start
    monkeypatch.setattr(helper, "COMMAND", (*helper.COMMAND[:4], start, *helper.COMMAND[5:]))
    used = Helper()
    process = used.start()
    for name, data in FILES.items():
        assert used.decode(data) == (decoder.decode(data), True), name
    assert used.process is process
    used.stop()


class Real(NamedTuple):
    """A named tuple."""

    first: int
    second: str = "x"

    def both(self) -> str:
        """Return both values."""
        return f"{self.first}{self.second}"


def test_named_tuples_are_those_of_typing() -> None:
    body = {name: value for name, value in vars(Real).items() if name in {"__doc__", "both"}}
    annotations = {"__annotations__": Real.__annotations__, "second": "x"}
    made = stand_ins.Named("Real", (stand_ins.NamedTuple,), body | annotations)
    assert made._fields == Real._fields
    assert made._field_defaults == Real._field_defaults
    assert made(1) == Real(1)
    assert made(1, second="y").both() == Real(1, "y").both()
    assert made.__doc__ == Real.__doc__


def test_an_absent_class_takes_all_parameters_and_no_error_is_one() -> None:
    absent = stand_ins.StandIn("logging").getLogger("name")
    assert absent.debug("%s", 1) is not None
    assert stand_ins.Absent["T", int] is stand_ins.Absent
    assert not isinstance(ValueError(), stand_ins.Absent)
