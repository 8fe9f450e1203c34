"""Parser of scene files: text -> Scene, and back. One run finds all errors of a file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from minirt.element import Element
from minirt.errors import Problem, SceneError
from minirt.helpers.system import gc_paused
from minirt.scene import fast, files, writer
from minirt.scene.arguments import check_scene
from minirt.scene.line_reader import read_line
from minirt.scene.lines import MAX_ERRORS, Log, line_from
from minirt.scene.pages import PAGE_LENGTH, Crowd, Item, kinds_of, pages_of
from minirt.scene.required import check_required
from minirt.scene.scene import Scene

# A new scene: elements like any others, which one may change and delete.
NEW = b"""A 0.4 255,255,255
C 0,3,9 0,-0.12,-0.992774 70
L -6,12,8 0.7 255,255,255

# sky
bg 150,190,235

# ground
pl 0,0,0 0,1,0 125,150,110
"""


class Reading(NamedTuple):
    """A scene and the notices about its file."""

    scene: Scene
    notices: tuple[Problem, ...]


def load(
    path: str | os.PathLike[str], lenient: bool | str = False, left_handed: bool = False, new: bool = False
) -> Reading:
    """Read a scene file; SceneError with all of its errors.

    `left_handed` mirrors its pictures; `new`: a file that holds nothing is the beginning of a scene.
    """
    data = files.read(path)
    if new and not data.strip():
        data = NEW
    scene, notices = parse(data, path, lenient, files.picture_folder(path) if files.is_picture(path) else None)
    return Reading(scene.mirrored() if left_handed else scene, notices)


def load_for_window(
    path: str | os.PathLike[str], lenient: bool | str = False, left_handed: bool = False, new: bool = False
) -> tuple[Reading, SceneError | None]:
    """Return what was read of a scene file; and None, or the error of a first attempt.

    If the file cannot be read as asked, and has lines in a dialect of another program, it is read leniently. SceneError
    where no line is in a dialect, or where the file is no scene even so.
    """
    try:
        return load(path, lenient, left_handed, new), None
    except SceneError as error:
        from minirt.scene.dialect_tables import DIALECT

        with suppress(SceneError):
            reading = load(path, True, left_handed, new)
            # Some notices are of other ways to write, and not of mistakes.
            if any(notice.message.startswith(DIALECT) for notice in reading.notices):
                return reading, error
        raise


def parse(
    text: str | bytes, file: str | os.PathLike[str] = "", lenient: bool | str = False, folder: Path | None = None
) -> Reading:
    """Return the scene of a text, with notices; SceneError with all errors of the text. `file` is the name they show.

    Textures and meshes are looked for in `folder`, by default that of the file.

    `lenient` translates lines of older scenes (several `L`, blanks around commas) and of other programs, with notices
    (`minirt.scene.dialects`). Words in place of True, such as "base z-up", do so, too, and read fields as the words
    say, see `minirt.load`.
    """
    name = os.fspath(file) or "scene"
    if isinstance(text, str):
        text = text.encode("utf-8", "surrogatepass")  # a lone surrogate is reported as a byte that is not UTF-8
    log = Log(name, lenient, folder)
    sources = files.decode(text, name).split("\n")
    with gc_paused(freeze=False):  # a reader makes no cycles, and the search for them takes a quarter of its time
        runs = read_lines(sources, log)
    log.tell_changes()
    if log.errors:
        from minirt.scene.hints import with_hints

        errors = sorted(log.errors, key=lambda error: (error.line, error.column))
        raise SceneError(tuple(errors if lenient else with_hints(errors, sources, log, read_lines)))
    place = Path(file) if file else None
    scene = Scene.of_pages(tuple(pages_of(runs)), folder / place.name if folder and place else place)
    return Reading(scene, tuple(log.notices))


def loads(text: str | bytes, lenient: bool | str = False) -> Scene:
    r"""Read a scene from the text of a file; SceneError, with all of its problems, if the text is no valid scene.

    Textures and meshes are looked up in the current folder. `lenient` is as for `load`.

        scene = minirt.loads("A 0.2 255,255,255\nC 0,0,-9 0,0,1 60\nsp 0,0,0 2 255,0,0")
    """
    return parse(text, lenient=lenient).scene


def dumps(scene: Scene) -> str:
    """Return a scene as the text of a file, the same as `Scene.save` writes.

    Comments and unchanged lines are as they were read.

        print(minirt.dumps(scene))
    """
    check_scene(scene, "dumps")
    return writer.text_of(scene.pages)


def read_lines(sources: list[str], log: Log) -> list[Sequence[Item]]:
    """Return all lines of a file, run by run: elements, comments and blank lines.

    Errors go into the log, and lines with errors are left out; SceneError for a file that has no element at all. With
    too many errors the rest of the file is not read.
    """
    runs: list[Sequence[Item]] = []
    # Identifier: the number of a line that has it, or seems to mean it; the first one, of kinds that may stand once.
    seen: dict[str, int] = {}
    if log.lenient:
        from minirt.scene import dialect_files, dialects

        colours = dialects.colours_of_materials(sources)
    for start in range(0, len(sources), PAGE_LENGTH):
        # The fast reader leaves lines that it cannot read as None. Only for a long file does it load compiled code.
        block: Any = fast.read(sources[start : start + PAGE_LENGTH], len(sources))
        seen.update((kind.code, start + 1) for kind in kinds_of(block) if issubclass(kind, Element))
        if isinstance(block, Crowd):
            runs.append(block)
            continue
        for at in [at for at, item in enumerate(block) if item is None]:
            line = line_from(start + at + 1, sources[start + at])
            block[at] = dialects.read_leniently(line, seen, log, colours) if log.lenient else read_line(line, seen, log)
            if len(log.errors) + (dialect_files.unread_lines(log) if log.lenient else 0) >= MAX_ERRORS:
                log.error(line, "too many errors: the rest of the file is not read", line.end + 1)
                return runs
        runs.append([item for item in block if item is not None])
    if log.lenient:
        items = [*chain.from_iterable(runs)]
        dialect_files.complete(items, seen, log)
        runs = [items]
    check_required(seen, sources, runs, log)
    return runs
