"""Configuration file: the user's own defaults of some options.

It is TOML, `minirt/config.toml` in the folder of the user's settings, with the long names of options:

    samples = 16
    size = "1920x1080"
    keys = "azerty"
    left-handed = true
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from minirt.errors import FileError

PICTURES = ("size", "samples", "quality", "depth", "precision", "dither", "metadata", "lenient", "left_handed")
NAMES = (*PICTURES, "keys", "watch", "threads", "memory", "verbose")
LARGEST = 2**16  # bytes


def default_path() -> Path:
    """Return the path of the configuration file where no other is named."""
    folder = os.environ.get("APPDATA" if os.name == "nt" else "XDG_CONFIG_HOME", "")
    return (Path(folder) if os.path.isabs(folder) else Path.home() / ".config") / "minirt" / "config.toml"  # noqa: PTH117


def with_configuration(
    parser: argparse.ArgumentParser, options: argparse.Namespace, argv: Sequence[str] | None
) -> argparse.Namespace:
    """Return the options with the defaults of the configuration file; FileError for a wrong one."""
    path = configuration_path(options.config)
    if path is None:
        return options
    parser.set_defaults(**read(parser, path))
    return parser.parse_args(argv)


def configuration_path(named: str | None) -> Path | None:
    """Return the path of the file to read: the one that is `named`, or the user's own if there is one."""
    if named is not None:
        return Path(named) if named else None
    try:
        path = default_path()
        return path if path.is_file() else None
    except (OSError, RuntimeError):  # RuntimeError: nobody's home
        return None


def read(parser: argparse.ArgumentParser, path: Path) -> dict[str, object]:
    """Return the defaults in a file by the names of options; FileError for what no option takes."""
    import tomllib

    from minirt.helpers import file_io

    try:
        table = tomllib.loads(file_io.read(path, LARGEST).decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is not TOML: {error}") from None
    actions = {action.dest: action for action in parser._actions if action.dest in NAMES}
    return {name.replace("-", "_"): value_of(actions, name, value, path) for name, value in table.items()}


def value_of(actions: dict[str, argparse.Action], name: str, value: object, path: Path) -> object:
    """Return a default as the option itself would parse it; FileError where it would not."""
    action = actions.get(name.replace("-", "_"))
    if action is None:
        from minirt.cli.suggestions import suggestion

        known = [each.replace("_", "-") for each in actions]
        raise FileError(path, f"no option '{name[:40]}' that has a default{suggestion(name, known)}")
    if action.nargs == 0:
        if not isinstance(value, bool):
            raise FileError(path, f"{name} must be true or false, got {value!r:.40}")
        return value
    try:
        result = action.type(str(value)) if callable(action.type) else str(value)
    except (ValueError, argparse.ArgumentTypeError) as error:
        raise FileError(path, f"{name} {error}") from None
    if action.choices and result not in action.choices:
        raise FileError(path, f"{name} must be one of {', '.join(map(str, action.choices))}, got {value!r:.40}")
    return result
