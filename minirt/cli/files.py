"""Files that the command line names: scenes, also in pictures, standard input and examples; and outputs."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.cli.arguments import OPENING, Arguments, say, tell
from minirt.errors import FileError, RenderError, SceneError, counted
from minirt.formats.table import FORMATS, check_bits, check_quality, check_size, format_of
from minirt.helpers import file_io
from minirt.helpers.progress import WorkState, progress

if TYPE_CHECKING:
    from minirt.scene import Reading, Scene

OPENING_PICTURE = "miniRT-opening.png"  # of a program without arguments, where no window can be opened
STANDARD_INPUT = "standard input"
PLACE = "{name}"  # in an output, stands for the name of the scene's file without its extension


def read_scene(options: argparse.Namespace, new: bool = False, for_window: bool = False) -> Reading:
    """Return the scene that the options name, with notices about tolerated mistakes. `new`: an empty file is a scene.

    For a window a file that is not there is a new scene, unless there is a fallback. A file in another dialect, which
    the strict reader refuses, is then read as with --lenient, after its error is printed. `options.lenient` becomes the
    way in which the file is read. SceneError; RenderError where the scene has no camera of the number asked for.
    """
    from minirt.scene import Reading, files, load, parse
    from minirt.scene.examples import example
    from minirt.scene.parser import NEW, load_for_window

    path = options.scene[0]
    words = (options.cone, options.camera_as, options.up and f"{options.up}-up")
    options.lenient = " ".join(filter(None, words)) or options.lenient
    with progress(lambda: WorkState(f"reading {STANDARD_INPUT if path == '-' else path}")):
        if options.example:
            reading = Reading(example(options.example), ())
        elif is_nameless(path):  # pictures and meshes of a stream are looked for in the current folder
            name = STANDARD_INPUT if path == "-" else path
            reading = parse(stream_data(path, name), name, options.lenient, Path())
        else:
            try:
                if for_window and not options.fallback and files.is_absent(path):
                    reading = parse(NEW, path)
                elif for_window:
                    reading, refused = load_for_window(path, options.lenient, new=new)
                    if refused:
                        tell(f"Error\n{refused}\nThe window shows the scene as --lenient reads it")
                        options.lenient = True
                else:
                    reading = load(path, options.lenient, new=new)
            except SceneError as error:
                if not options.lenient:
                    add_hints(path, error)
                raise
    scene = reading.scene.mirrored() if options.left_handed else reading.scene
    if options.camera > len(scene.cameras):
        raise RenderError(f"{path} has {counted(len(scene.cameras), 'camera')}: there is no --camera {options.camera}")
    return Reading(scene.seen_by(options.camera), reading.notices)


def add_hints(path: str, error: SceneError) -> None:
    """Add notes to the error of a scene file: what its lines may mean, and that --lenient reads it where it does."""
    from minirt.scene import load
    from minirt.scene.dialect_tables import ABSENT, LEFT_OUT, LIGHTS, SETTINGS
    from minirt.scene.hints import suggestions

    for suggestion in suggestions(error.problems):
        error.add_note(suggestion)
    with suppress(SceneError):
        scene, notices = load(path, lenient=True)
        exceptions = f" without {len(scene.missing)} of its shapes" if scene.missing else ""
        if any(each.message.startswith((LEFT_OUT, LIGHTS, SETTINGS, ABSENT)) for each in notices):
            exceptions += ", leaves out some of it"
        error.add_note(f"--lenient reads this file{exceptions}, and tells what it makes of it")


def is_nameless(path: str) -> bool:
    """Whether a scene or an output is a stream: standard input or output, or one that a shell has opened."""
    return path == "-" or file_io.is_stream(path)


def stream_data(path: str, name: str) -> bytes:
    """Read the bytes of a scene from a stream: standard input for the path "-". SceneError, which calls the stream
    `name`, where that fails or there are more than MAX_BYTES."""
    from minirt.scene.files import MAX_BYTES, file_error

    try:
        if path != "-":
            return file_io.read_given(path, MAX_BYTES)
        data = sys.stdin.buffer.read(MAX_BYTES + 1)
        file_io.check_size(name, len(data), MAX_BYTES)
    except FileError as error:
        raise file_error(name, error.reason) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else None
        raise file_error(name, f"cannot be read: {reason or 'it is closed'}") from None
    return data


def with_camera_options(scene: Scene, options: argparse.Namespace) -> Scene:
    """Return the scene with the tone and the exposure that the options ask for."""
    given = {"tone": options.tone, "exposure": options.exposure}
    changes = {name: value for name, value in given.items() if value is not None}
    for camera in scene.cameras if changes else ():
        scene = scene.replace(camera, **changes)
    return scene


def choose_example(parser: Arguments, options: argparse.Namespace, arguments: Sequence[str]) -> None:
    """Let an example stand for the scene file where the options ask for one, or where there are no arguments.

    The window saves it to a new file in the current folder.
    """
    if not arguments:
        options.example, options.fallback = OPENING, OPENING_PICTURE
    if not options.example:
        return
    if options.scene:
        parser.error(f"--example shows a scene of its own, got {options.scene[0]}, too")
    names = (f"{options.example}{suffix}.rt" for suffix in ("", *(f"-{number}" for number in range(1, 1000))))
    options.scene = [next((name for name in names if not file_io.found(name)), f"{options.example}.rt")]


def output_for(scene: str, output: str) -> str:
    """Return the output of a scene: `out/{name}.png` is `out/demo.png` for `scenes/demo.rt`."""
    return output.replace(PLACE, "stdin" if scene == "-" else Path(scene).stem)


def format_name(output: str) -> str:
    """Return the name of the format of an output; RenderError for an unknown extension."""
    return "PNG" if is_nameless(output) else format_of(output)


def is_film(options: argparse.Namespace) -> bool:
    """Whether the output is one file of several pictures."""
    has_several = options.turntable or options.replay
    return bool(has_several and options.output and FORMATS[format_name(options.output)].is_film)


def needs_light(options: argparse.Namespace, output: str) -> bool:
    """Whether the file is made of linear light, and not of levels of 8 bits."""
    return (options.bits or FORMATS[format_name(output)].bits[0]) != 8


def check_format(options: argparse.Namespace) -> None:
    """Check that the format of the output fits the other options; RenderError otherwise."""
    for output in filter(None, (options.output, options.fallback)):
        if file_io.is_folder(output):
            raise RenderError(f"{output} is a folder: name a picture in it, such as {Path(output, 'picture.png')}")
        name = format_name(output)
        if not (options.turntable or options.replay or FORMATS[name].is_still):
            raise RenderError(f"{output}: a film needs --turntable or --replay, a picture is .png or .jpg")
        check_bits(name, options.bits)
        check_quality(name, options.quality)
        if options.replay and needs_light(options, output):
            raise RenderError(f"{output}: the frames of a replay have 8 bits a channel, try .png without --bits")


def check_output(output: str, width: int, height: int) -> None:
    """Check that a picture of this size can be written to a file; RenderError otherwise."""
    check_size(output, format_name(output), width, height)
    if is_nameless(output):
        return
    with file_io.told_errors(output):
        file_io.probe(output)


def write(data: bytes, output: str) -> None:
    """Write an encoded picture to a file as a whole, or to a stream; RenderError when that fails."""
    if output == "-":
        say(data)
        return
    with file_io.told_errors(output):
        if file_io.is_stream(output):
            Path(output).write_bytes(data)
        else:
            file_io.write(output, data)
