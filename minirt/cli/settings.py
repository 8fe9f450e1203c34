"""Settings of a picture, which it carries as options of the command line: size, samples, depth and the like."""

from __future__ import annotations

import argparse
from itertools import zip_longest

from minirt.cli.argument_values import MAX_SIDE, size
from minirt.errors import FileError
from minirt.scene import in_picture

NAMES = ("size", "region", "samples", "error", "time", "depth", "precision", "dither", "left_handed")
IN_WINDOWS_TOO = ("size", "depth", "precision", "left_handed")  # samples mean something else there


def settings_text(options: argparse.Namespace, width: int, height: int) -> str:
    """Return the settings of a picture of this size as options: `--size 640x480 --samples 16`."""
    values = {name: getattr(options, name) for name in NAMES} | {"size": f"{width}x{height}"}
    if values["precision"] == "double":
        values["precision"] = None
    given = {"--" + name.replace("_", "-"): value for name, value in values.items() if value not in (None, False)}
    return " ".join(option if value is True else f"{option} {value}" for option, value in given.items())


def with_settings(parser: argparse.ArgumentParser, options: argparse.Namespace) -> argparse.Namespace:
    """Return the options with the settings of the picture that is the scene, where none were given.

    They may come from anybody: what is unknown or out of range is left out.
    """
    scene = options.scene[0]
    if not in_picture.is_picture(scene):
        return options
    try:
        text = in_picture.settings(scene)
    except FileError as error:
        from minirt.scene.files import file_error

        raise file_error(error.path, error.reason) from None
    usable = NAMES if options.output else IN_WINDOWS_TOO
    changed = argparse.Namespace(**vars(options))
    for name, value in parsed(parser, text).items():
        if name in usable and getattr(options, name) == parser.get_default(name):
            setattr(changed, name, value)
    if not options.output or changed.samples != "auto":
        changed.error, changed.time = options.error, options.time
    if not options.region and not is_inside(changed):
        changed.region = None
    return changed


def is_inside(options: argparse.Namespace) -> bool:
    """Whether the region of a picture lies in a picture of the size that is asked for."""
    if not options.region or not options.size:
        return False
    (x, y, across, down), (width, height) = options.region, options.size
    return bool(x + across <= width and y + down <= height)


def parsed(parser: argparse.ArgumentParser, text: str) -> dict[str, object]:
    """Return the values of settings by their names; those that the parser would refuse are left out."""
    actions = {action.dest: action for action in parser._actions if action.dest in NAMES}
    found: dict[str, object] = {}
    words = text.split()
    for word, value in zip_longest(words, words[1:], fillvalue=""):
        action = actions.get(word.removeprefix("--").replace("-", "_")) if word.startswith("--") else None
        if action is None:
            continue
        if action.nargs == 0:
            found[action.dest] = True
            continue
        kind = action.type if callable(action.type) else str
        try:
            result = kind(value)
        except (ValueError, argparse.ArgumentTypeError):
            continue
        if action.dest == "size" and max(size(value)) > MAX_SIDE:
            continue
        if not action.choices or result in action.choices:
            found[action.dest] = result
    return found
