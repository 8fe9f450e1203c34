"""Options that are not typed: defaults of the configuration file and settings that a picture carries.

Also the completion of arguments in shells, which is made from the parser's list of options.
"""

from __future__ import annotations

import argparse
import os
import shlex
from collections.abc import Sequence
from contextlib import suppress
from itertools import zip_longest
from pathlib import Path

from minirt.cli.arguments import DEFAULTS, MAX_SIDE
from minirt.errors import FileError, did_you_mean
from minirt.helpers import file_io, package

# Options that the configuration file may set, those that a picture carries, and those of them that windows use, where
# samples mean something else.
PICTURES = ("size", "samples", "quality", "depth", "precision", "dither", "metadata", "lenient", "left_handed")
CONFIGURABLE = (*PICTURES, "keys", "watch", "threads", "memory", "verbose")
CARRIED = ("size", "region", "samples", "error", "time", "depth", "precision", "dither", "camera", "left_handed")
IN_WINDOWS_TOO = ("size", "depth", "precision", "camera", "left_handed")
# Options that choose a command, the first of which counts, and the commands with which each option has an effect, where
# that is not all of them. Without such an option there is a window.
COMMANDS = {"check": "--check", "bench": "--bench", "report": "--report", "explain": "--explain"}
COMMANDS |= {"compare": "--compare", "replay": "--replay", "buffers": "--buffers", "output": "-o"}
EFFECTS = {
    name: set(commands.split())
    for names, commands in (
        ("region turntable frames resume error time strict cluster verbose", "output"),
        ("output", "compare replay buffers output"),
        ("bits quality metadata", "replay output"),
        ("samples dither", "replay output window"),
        ("depth", "explain replay output window"),
        ("precision", "bench replay output window"),
        ("size", "bench report explain replay buffers output window"),
        ("threads", "bench report replay buffers output window"),
        ("tone exposure", "bench report explain replay output window"),
        ("keys", "replay window"),
        ("fallback text_scale watch", "window"),
        ("quick ablation against", "report"),
        ("json", "check bench explain compare"),
        *((command, command) for command in COMMANDS if command != "output"),
    )
    for name in names.split()
}
LARGEST = 2**16  # bytes of a configuration file
ZSH = "autoload -Uz bashcompinit && bashcompinit && setopt KSH_GLOB\n"
FILES = {"output", "fallback", "replay", "report", "against", "compare", "config"}  # options whose value is a path
FISH_SCENES = "complete -c miniRT -k -xa '(__fish_complete_suffix .rt .png)'"


def with_configuration(
    parser: argparse.ArgumentParser, options: argparse.Namespace, argv: Sequence[str] | None
) -> argparse.Namespace:
    """Return the options with the defaults of the configuration file; FileError for a wrong one.

    It is TOML with the long names of options: `size = "1920x1080"`, `left-handed = true`.
    """
    path = configuration_path(options.config)
    if path is None:
        return options
    parser.set_defaults(**configuration(parser, path))
    return parser.parse_args(argv)


def configuration_path(named: str | None) -> Path | None:
    """Return the path of the file to read: the one that is `named`, or the user's own if there is one."""
    if named is not None:
        return Path(named) if named else None
    folder = Path(os.environ.get("APPDATA" if os.name == "nt" else "XDG_CONFIG_HOME", ""))
    with suppress(OSError, RuntimeError):  # RuntimeError: nobody's home
        path = (folder if folder.is_absolute() else Path.home() / ".config") / "minirt" / "config.toml"
        return path if file_io.is_file(path) else None
    return None


def configuration(parser: argparse.ArgumentParser, path: Path) -> dict[str, object]:
    """Return the defaults in a file by the names of options; FileError where the file is not TOML, and for a name or a
    value that no option takes."""
    import tomllib

    try:
        table = tomllib.loads(file_io.read_given(path, LARGEST).decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is not TOML: {error}") from None
    actions = actions_of(parser, CONFIGURABLE)
    defaults = {}
    for written, value in table.items():
        name = written.replace("-", "_")
        if name not in actions:
            known = [each.replace("_", "-") for each in actions]
            raise FileError(path, f"no option '{written[:40]}' that has a default{did_you_mean(written, known)}")
        try:
            defaults[name] = value_of(actions[name], value)
        except ValueError as error:
            raise FileError(path, f"{written} {error}") from None
    return defaults


def actions_of(parser: argparse.ArgumentParser, names: Sequence[str]) -> dict[str, argparse.Action]:
    """Return some options of the parser by their names."""
    return {action.dest: action for action in parser._actions if action.dest in names}


def value_of(action: argparse.Action, value: object) -> object:
    """Return a value as the option itself would parse it; ValueError says why it would not."""
    if action.nargs == 0:
        if not isinstance(value, bool):
            raise ValueError(f"must be true or false, got {value!r:.40}")
        return value
    try:
        result = action.type(str(value)) if callable(action.type) else str(value)
    except argparse.ArgumentTypeError as error:
        raise ValueError(str(error)) from None
    if action.choices and result not in action.choices:
        raise ValueError(f"must be one of {', '.join(map(str, action.choices))}, got {value!r:.40}")
    return result


def without_effect(parser: argparse.ArgumentParser, options: argparse.Namespace) -> str:
    """Return a message about the first option that was given and has no effect on the command, which other options
    choose; '' if there is none.

    Defaults of the configuration file are for the commands that use them.
    """
    command = next((name for name in COMMANDS if getattr(options, name, None)), "window")
    commands = {command}
    if options.fallback:  # a picture is rendered where no window opens
        commands.add("output")
    for action in actions_of(parser, [*EFFECTS]).values():
        has_effect = EFFECTS[action.dest]
        is_given = getattr(options, action.dest) != parser.get_default(action.dest)
        if is_given and not commands & has_effect:
            if action.dest in COMMANDS:
                return f"{COMMANDS[action.dest]} does not go with {COMMANDS[command]}"
            needed = [COMMANDS[name] for name in COMMANDS if name in has_effect]
            where = f"with {COMMANDS[command]}" if "window" in has_effect else f"without {' or '.join(needed)}"
            return f"{action.option_strings[-1]} has no effect {where}"
    return ""


def settings_text(options: argparse.Namespace, width: int, height: int) -> str:
    """Return the settings of a picture of this size as options: `--size 640x480 --samples 16`."""
    values = {name: getattr(options, name) for name in CARRIED} | {"size": f"{width}x{height}"}
    values["region"] = options.region and ",".join(map(str, options.region))
    values |= {name: None for name, usual in DEFAULTS.items() if values.get(name) == usual}
    given = {"--" + name.replace("_", "-"): value for name, value in values.items() if value not in (None, False)}
    return " ".join(option if value is True else f"{option} {value}" for option, value in given.items())


def with_settings(parser: argparse.ArgumentParser, options: argparse.Namespace) -> argparse.Namespace:
    """Return the options; where the scene is a picture, with its settings for the options that were not given.

    A picture may come from anybody: settings that are unknown or out of range are left out.
    """
    from minirt.scene import files

    scene = options.scene[0]
    if not files.is_picture(scene):
        return options
    usable = actions_of(parser, CARRIED if options.output else IN_WINDOWS_TOO).values()
    actions = {option: action for action in usable for option in action.option_strings}
    changed = argparse.Namespace(**vars(options))
    words = files.picture_settings(scene).split()
    for word, value in zip_longest(words, words[1:], fillvalue=""):
        action = actions.get(word)
        if action and getattr(options, action.dest) == action.default:
            with suppress(ValueError):
                setattr(changed, action.dest, value_of(action, True if action.nargs == 0 else value))
    if max(changed.size or (0,)) > MAX_SIDE:  # only --cluster makes such pictures
        changed.size = options.size
    if changed.samples != "auto":  # the samples were given, and these two settings are only for "auto"
        changed.error, changed.time = options.error, options.time
    (x, y, across, down), (width, height) = changed.region or (0, 0, 1, 1), changed.size or (0, 0)
    if not options.region and (x + across > width or y + down > height):  # the size was given, or is unknown
        changed.region = None
    return changed


def completion(parser: argparse.ArgumentParser, shell: str) -> str:
    """Return the script for bash, zsh or fish."""
    actions = [action for action in parser._actions if action.option_strings]
    if shell == "fish":
        return "\n".join([*map(fish_line, actions), FISH_SCENES])
    cases = "\n".join(bash_case(action) for action in actions if action.nargs != 0)
    words = shlex.quote(" ".join(option for action in actions for option in action.option_strings))
    script = package.read(__name__, "completion.bash").decode().rstrip("\n")
    return (ZSH if shell == "zsh" else "") + script.replace("CASES", cases).replace("OPTIONS", words)


def bash_case(action: argparse.Action) -> str:
    """Return the case of an option that takes a value; one that is neither a choice nor a path is left to the user."""
    values = "-f" if action.dest in FILES else "-W " + words_of(action)
    return f'        {"|".join(action.option_strings)}) COMPREPLY=($(compgen {values} -- "$word")); return ;;'


def words_of(action: argparse.Action) -> str:
    """Return the choices of an option, in quotes for a shell."""
    return shlex.quote(" ".join(map(str, action.choices or ())))


def fish_line(action: argparse.Action) -> str:
    """Return the line for an option."""
    names = [f"-s {name[1:]}" if len(name) == 2 else f"-l {name[2:]}" for name in action.option_strings]
    value = "" if action.nargs == 0 else "-r" if action.dest in FILES else "-x"
    if action.choices:
        value += f" -a {words_of(action)}"
    about = (action.help or "").replace("%%", "%").partition(";")[0]
    return " ".join(["complete -c miniRT", *names, value, "-d", "'" + about.replace("'", "\\'") + "'"])
