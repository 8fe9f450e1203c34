"""Command line of miniRT: parse the arguments, run the command, return an exit status.

This is the only place that prints errors. The commands are imported after the arguments are parsed, so that `--help`
and `--version` come at once.
"""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from signal import SIGINT

from minirt.cli.arguments import FAILED, MAX_SIDE, OK, Arguments, argument_parser, prepare_streams, say, tell
from minirt.errors import MiniRTError, counted

NAME = "the name of a file: -o spin.gif"
NO_MEMORY = "not enough memory; a smaller picture, smaller files or fewer shapes need less"
NO_THREADS = "the system allows no more threads; 'ulimit -u' shows how many threads and processes a user may have"


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program with the arguments `argv` and return its exit status. Errors of miniRT and of memory are printed;
    others are raised.

    With None they are the arguments of this process, which is the program's own then: a signal ends it here.
    """
    prepare_streams()
    if argv is None:  # a program of its own
        if not sys.warnoptions:  # nobody has asked Python for the warnings of libraries, which are for developers
            warnings.simplefilter("ignore")
        # Threads of numpy would spin for 20 to 40 ms of the start, and the program multiplies only small matrices.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        return run(argument_parser(), argv)
    except BrokenPipeError:  # the reader of standard output has closed it
        return FAILED
    except KeyboardInterrupt as error:  # SIGINT, or another signal, whose number it has
        return interrupted(error, int(*error.args or [SIGINT]), is_program=argv is None)
    except Exception as error:
        from minirt.helpers.signals import ended

        if ended:  # Python, or a library, has turned the interrupt into another error
            return interrupted(error, ended[0], is_program=argv is None)
        message = NO_MEMORY if isinstance(error, MemoryError) else ""
        if str(error) == "can't start new thread":  # the RuntimeError that Python raises
            message = NO_THREADS
        if not (message or isinstance(error, MiniRTError)):
            raise
        return failed(error, message)


def interrupted(error: BaseException, number: int, is_program: bool) -> int:
    """Print what is kept of the work that a signal has ended; end the program, or return the exit status."""
    tell_notes(error)
    if is_program:
        from minirt.helpers.signals import leave

        leave(128 + number)
    return 128 + number


def failed(error: BaseException, message: str = "") -> int:
    """Print an error, or another message about it, and its notes; return the exit status."""
    tell(f"Error\n{message or error}")
    tell_notes(error)
    return FAILED


def tell_notes(error: BaseException) -> None:
    """Print what is kept of the work that an error has ended."""
    for note in getattr(error, "__notes__", ()):
        tell(note)


def run(parser: Arguments, argv: Sequence[str] | None) -> int:
    """Parse `argv`, or the program's own arguments, and run the command that they select, for each scene.

    Return the greatest exit status of the scenes. A scene that fails does not end the others.
    """
    options = parser.parse_args(argv)
    if text := asked_text(parser, options):
        say(text)
        return OK
    from minirt.cli import files
    from minirt.cli.options import with_configuration
    from minirt.helpers import system

    options = with_configuration(parser, options, argv)
    options.command = sys.argv[1:] if argv is None else list(argv)
    files.choose_example(parser, options, options.command)
    check_options(parser, options)
    system.limit_memory(options.memory)
    statuses = []
    for scene in options.scene:
        try:
            statuses.append(run_scene(parser, options, scene))
        except MiniRTError as error:  # the other scenes are read and rendered all the same
            statuses.append(failed(error))
    return max(statuses)


def asked_text(parser: Arguments, options: argparse.Namespace) -> str:
    """Return the text that an option asks for in place of any work, or ''."""
    if options.version:
        from minirt import __version__

        return f"miniRT {__version__}"
    if options.list_keys:
        from minirt.viewer.bindings import keys_text
        from minirt.viewer.language import translated

        return keys_text(translate=translated)
    if options.completion:
        from minirt.cli.options import completion

        return completion(parser, options.completion)
    return ""


def run_scene(parser: Arguments, options: argparse.Namespace, scene: str) -> int:
    """Read the scene of this name and run the command for it; return its exit status. MiniRTError if either fails."""
    from minirt.helpers.signals import ended_by_signals
    from minirt.helpers.system import gc_paused

    with gc_paused():  # looking for garbage among new modules takes an eighth of a warm start
        from minirt.cli.commands import check, check_as_json, command_for, replay, show
        from minirt.cli.files import output_for, read_scene, with_camera_options
        from minirt.cli.options import with_settings
    with ended_by_signals():
        output = output_for(scene, options.output) if options.output else options.output
        # The options of this scene alone: those that its picture carries are not for the next one.
        options = argparse.Namespace(**vars(options) | {"scene": [scene], "output": output})
        options = with_settings(parser, options)
        command = command_for(options)
        if options.json and command is check:
            return check_as_json(options)
        with gc_paused():
            read, notices = read_scene(options, new=command in (show, replay), for_window=command is show)
        for notice in notices:
            # Standard output may get a picture, but not from a window; standard error stays empty without errors then.
            tell(f"notice: {notice}", sys.stdout if command is show else sys.stderr)
        if command is show:  # the window also gets the scene without options, to tell whether it differs from the file
            return show(with_camera_options(read, options), options, read)
        return command(with_camera_options(read, options), options)


def check_options(parser: Arguments, options: argparse.Namespace) -> None:
    """Exit with a message when the options do not go together; RenderError for an unknown or unfit picture format."""
    check_scenes(parser, options)
    from minirt.cli.files import check_format, is_nameless

    check_format(options)  # before the work, not after it
    output, replay, auto = options.output, options.replay, options.samples == "auto"
    nameless = not output or is_nameless(output)
    last = options.frames.stop - 1 if options.frames else 0  # the last picture of the turntable to render; 0: all are
    is_beyond_turntable = bool(options.turntable) and last > options.turntable
    makes_film_here = options.turntable and not options.cluster
    makes_one = output and not (options.buffers or replay or makes_film_here)
    cannot_resume = replay or auto or nameless
    side, made = max(options.size or (0,)), counted(options.turntable, "picture")  # the longer side; 0: the scene's
    is_too_large = side > MAX_SIDE and not options.cluster
    wrong = (
        (options.turntable and nameless, f"--turntable needs {NAME}"),
        (last and not options.turntable, "--frames needs --turntable"),
        (is_beyond_turntable, f"--frames: --turntable makes {made}, got {last}"),
        (options.resume and cannot_resume, f"--resume needs {NAME}, and no --replay or --samples auto"),
        ((options.error or options.time) and not auto, "--error and --time need --samples auto"),
        (options.strict and not options.error, "--strict needs --error"),
        (auto and not makes_one, "--samples auto makes one picture: it needs -o, and no --replay or --turntable"),
        (options.cluster and options.time, "--cluster has no effect with --time"),
        (options.buffers and not output, f"--buffers needs {NAME.replace('spin.gif', 'normals.png')}"),
        (is_too_large, f"argument --size: must be a whole number from 1 to {MAX_SIDE}, got '{side}'; see --cluster"),
    )
    for is_wrong, message in wrong:
        if is_wrong:
            parser.error(message)
    from minirt.cli.options import without_effect

    if message := without_effect(parser, options):
        parser.error(message)


def check_scenes(parser: Arguments, options: argparse.Namespace) -> None:
    """Exit with a message when the scenes do not go with the other options."""
    from minirt.cli.files import PLACE, is_nameless, output_for

    scenes, output = options.scene, options.output
    if not scenes:
        parser.error("expected a scene file, such as scene.rt, or --example")
    commands = options.check, options.bench, options.report, options.explain, options.compare
    is_headless = output or any(commands)
    streams = [*filter(is_nameless, scenes)]
    is_read_twice = not is_headless or options.replay or len(streams) > len(set(streams))
    if streams and is_read_twice:
        parser.error(f"{streams[0]} is a stream, which is read once: it needs -o, --explain or --check")
    if len(scenes) == 1 or options.check:
        return
    suggestion = "" if scenes[-1].endswith(".rt") else f"; did you mean -o {scenes[-1]}?"
    too_many = f"expected one scene file, got {len(scenes)}: {' '.join(scenes)}{suggestion}"
    needs_one = not output or options.bench or options.report or options.compare or options.replay
    if needs_one:
        parser.error(too_many)
    if PLACE not in output:
        parser.error(f"{too_many}; several need -o with {PLACE}, such as -o out/{PLACE}.png")
    outputs = [output_for(scene, output) for scene in scenes]
    if twice := next((each for each in outputs if outputs.count(each) > 1), ""):
        parser.error(f"two scenes would be written to {twice}")
