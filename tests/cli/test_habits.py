"""The configuration file, and completion in shells."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from minirt.cli.arguments import argument_parser
from minirt.cli.options import completion
from tests import processes
from tests.cli.program import Run
from tests.cli.test_output import pixels


@pytest.fixture
def configure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Path]:
    """A function that writes the configuration file."""

    def write(text: str) -> Path:
        file = tmp_path / "settings" / "minirt" / "config.toml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "settings"))
        return file

    return write


def test_the_configuration_file_has_defaults(run: Run, configure: Callable[[str], Path]) -> None:
    configure('size = "33x21"\nsamples = 2\nleft-handed = true\nmetadata = false\n')
    shown = pixels(run("ball.rt", "-o", "-").out)
    assert shown.shape == (21, 33, 3)
    given = run("ball.rt", "-o", "-", "--config", "", "--size", "33x21", "--samples", "2", "--left-handed").out
    assert (pixels(given) == shown).all()
    assert b"miniRT scene" in given
    assert pixels(run("ball.rt", "-o", "-", "--size", "20x10").out).shape == (10, 20, 3)
    assert pixels(run("ball.rt", "-o", "-", "--config", "").out).shape == (720, 1280, 3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("size = 640", "size must be WIDTHxHEIGHT, like 640x480, got '640'"),
        ("sampels = 4", "no option 'sampels' that has a default, did you mean 'samples'?"),
        ('output = "x.png"', "no option 'output' that has a default"),
        ("dither = 1", "dither must be true or false, got 1"),
        ('keys = "dvorak"', "keys must be one of auto, qwerty, azerty, qwertz, got 'dvorak'"),
        ("size = ", "is not TOML: Invalid value"),
        ("\0", "is not TOML: "),
    ],
)
def test_a_wrong_configuration_is_an_error(run: Run, configure: Callable[[str], Path], text: str, message: str) -> None:
    file = configure(text)
    ended = run("ball.rt", "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith(f"Error\n{file}: {message}")
    assert run("ball.rt", "--check", "--config", "").status == 0


def test_a_named_configuration_must_exist(run: Run) -> None:
    ended = run("ball.rt", "--check", "--config", "none.toml")
    assert (ended.status, ended.err.startswith("Error\nnone.toml: cannot be read: ")) == (1, True)


COMPLETE = """
cd "$1"; shift
eval "$SCRIPT"
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
_miniRT
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--samp",), ["--samples"]),
        (("--tone", ""), ["plain", "srgb", "filmic"]),
        (("--tone", "f"), ["filmic"]),
        (("ba",), ["ball.rt"]),
        (("-o", ""), ["ball.rt", "notes.txt"]),
        (("--size", ""), [""]),
    ],
)
def test_bash_completes_options_choices_and_files(folder: Path, words: tuple[str, ...], expected: list[str]) -> None:
    bash = shutil.which("bash")
    if not bash:
        pytest.skip("no bash")
    (folder / "notes.txt").touch()
    command = [bash, "-c", COMPLETE, "bash", str(folder), "miniRT", *words]
    script = completion(argument_parser(), "bash")
    found = processes.run(command, env={"SCRIPT": script}, text=True)
    assert (found.returncode, found.stderr) == (0, "")
    assert found.stdout.split("\n")[:-1] == expected


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_names_every_option(run: Run, shell: str) -> None:
    ended = run("--completion", shell)
    assert (ended.status, ended.err) == (0, "")
    for action in argument_parser()._actions:
        for option in action.option_strings:
            name = option if shell != "fish" else f"-l {option[2:]}" if option.startswith("--") else f"-s {option[1:]}"
            assert name in ended.out.decode()
    if shutil.which(shell):
        checked = processes.run([shell, "-n", "-c", ended.out.decode()])
        assert (checked.returncode, checked.stderr) == (0, b"")
