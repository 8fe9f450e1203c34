"""The manual page is as generated, is installed, and roff has nothing to object to."""

from __future__ import annotations

import shutil
import tomllib

import pytest

from minirt.cli.arguments import argument_parser
from tests.manual_page import PAGE, manual_page
from tests.pages import read
from tests.paths import ROOT
from tests.processes import run


def test_it_is_as_generated() -> None:
    assert PAGE.read_text(encoding="utf-8") == manual_page(), "write it anew: python -m tests.make_tables"


def test_a_wheel_installs_it() -> None:
    shared = tomllib.loads(read("pyproject.toml"))["tool"]["hatch"]["build"]["targets"]["wheel"]["shared-data"]
    assert shared == {PAGE.relative_to(ROOT).as_posix(): "share/man/man1/miniRT.1"}


def formatted(source: str) -> tuple[str, str]:
    """Return a page as roff shows it, in lines of 80 characters, and its warnings."""
    groff = shutil.which("groff")
    if not groff:
        pytest.skip("no groff")
    command = [groff, "-man", "-Tascii", "-ww", "-P-c", "-rHY=0"]
    done = run(command, source, text=True)
    assert done.returncode == 0
    return done.stdout, done.stderr


def test_roff_shows_every_option_without_a_warning() -> None:
    text, warnings = formatted(PAGE.read_text(encoding="utf-8"))
    assert warnings == ""
    plain = without_overstrikes(text)
    for action in argument_parser()._actions:
        assert all(option in plain for option in action.option_strings)
    assert "EXIT STATUS" in plain


def without_overstrikes(text: str) -> str:
    """Return a text without the characters that are struck over to look bold or underlined."""
    kept: list[str] = []
    for character in text:
        if character == "\b":
            kept.pop()
        else:
            kept.append(character)
    return "".join(kept)


def test_a_planted_mistake_is_warned_of() -> None:
    assert formatted(PAGE.read_text(encoding="utf-8") + ".NOSUCH macro\n")[1]
