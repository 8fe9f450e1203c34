"""Parser of scene files: text -> Scene. One run finds all errors of a file. Also the example scenes of the library."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from minirt.element import Element
from minirt.errors import FileError, Problem, SceneError, nearest
from minirt.helpers import file_io
from minirt.helpers.system import gc_paused
from minirt.scene import fast, files
from minirt.scene.element_reader import assign_words, identify, parse_slots, split_line, tell_useless
from minirt.scene.lines import MAX_ERRORS, Line, Log, Word, line_from
from minirt.scene.pages import PAGE_LENGTH, Crowd, Item, kinds_of, pages_of
from minirt.scene.registry import nearest_element
from minirt.scene.required import check_required
from minirt.scene.scene import MISSING, Scene

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
    """Read a scene file as asked. If that fails on a dialect, read it leniently, and return the first error, too.

    SceneError where no line is in a dialect, or where the file is no scene even so.
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
    """Parse the text of a scene; SceneError with all of its errors. `file` is the name that they show.

    Textures and meshes are looked for in `folder`, by default that of the file.

    `lenient` translates lines of older scenes (several `L`, blanks around commas) and of other programs, with notices
    (`minirt.scene.dialects`). A text of words does so, too, and reads fields as the words say, see `minirt.load`.
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


def read_lines(sources: list[str], log: Log) -> list[Sequence[Item]]:
    """Return all lines of a file, run by run: elements, comments and blank lines.

    Errors go into the log; SceneError for a file that has no element at all.
    """
    runs: list[Sequence[Item]] = []
    # Identifier: a line that has it, or seems to mean it; the first one, of kinds that may stand once.
    seen: dict[str, int] = {}
    if log.lenient:
        from minirt.scene import dialects

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
            block[at] = read_leniently(line, seen, log, colours) if log.lenient else read_line(line, seen, log)
            if len(log.errors) + (dialects.unread_lines(log) if log.lenient else 0) >= MAX_ERRORS:
                log.error(line, "too many errors: the rest of the file is not read", line.end + 1)
                return runs
        runs.append([item for item in block if item is not None])
    if log.lenient:
        items = [*chain.from_iterable(runs)]
        dialects.complete(items, seen, log)
        runs = [items]
    check_required(seen, sources, runs, log)
    return runs


def read_leniently(line: Line, seen: dict[str, int], log: Log, colours: Mapping[str, str]) -> Item | None:
    """Read any line, in a dialect of another program where it cannot be read as it stands; None after an error.

    A line without a meaning here becomes a comment. `colours` are those of named materials.
    """
    from minirt.scene import dialect_tables as tables
    from minirt.scene import dialects

    known, before, notices = dict(seen), len(log.errors), len(log.notices)
    item = read_line(line, seen, log)
    translation = None if item is not None else dialects.translated(line, colours, log.folder, known)
    if translation is None:
        return item
    errors = log.errors[before:]
    del log.errors[before:], log.notices[notices:]
    seen.clear()
    seen.update(known)
    if translation.text:
        item = read_line(line_from(line.number, translation.text), seen, log)
        unread = log.errors[before:]
        if item is None and (translation := dialects.without_element(line, unread)) is None:
            log.errors[before:] = errors
            return None
        del log.errors[before:]
    for sort, words in translation.changes:
        log.change(line, sort, words)
    is_missing = {tables.MISSING, tables.INCOMPLETE}.intersection(dict(translation.changes))
    return item or f"{MISSING if is_missing else '# '}{line.text}"


def read_line(line: Line, seen: dict[str, int], log: Log) -> Item | None:
    """Read any line: an element, or the line itself for a comment or a blank line; None after an error."""
    words = split_line(line, log)
    if words == []:
        return line.source
    kind = identify(words[0], line, log) if words else None
    if not words or not kind:
        seen.setdefault(nearest_element((line.text.split() or [""])[0]), line.number)
        return None
    return read_element(kind, words, seen.setdefault(kind.code, line.number), line, log)


def read_element(kind: type[Element], words: list[Word], first: int, line: Line, log: Log) -> Element | None:
    """Read the element of a line; None after an error. `first` is the first line with the same identifier."""
    errors = len(log.errors)
    if kind.once and first != line.number:
        message = f"a second {kind.title}: the first is in line {first}, and there may be one"
        log.error(line, message, *words[0].span(None))
    slots = assign_words(kind, words, line, log)
    values = parse_slots(slots, line, log)
    if len(log.errors) > errors:
        return None
    (element,) = kind.checked(1, {"source": [line.source], **{name: [value] for name, value in values.items()}})
    conflict = element.conflict()
    if conflict is None:
        tell_useless(element, slots, line, log)
        return element
    name, message = conflict
    slot = next(slot for slot in slots if slot.field.name == name)
    log.error(line, f"{kind.title} {name} {message}", *slot.span(None))
    return None


# Example scenes, which are installed with the library: `minirt.example("demo")`.

PACKAGE = Path(__file__).parents[1]
FOLDERS = (PACKAGE / "scenes", PACKAGE.parent / "scenes")  # of a wheel, and beside the sources
FILE = re.compile(r"(?<=[\s:])(?:textures|meshes)/[^\s,#]+")  # that a line of an example names, or its comment
UNFIT = re.compile(r"[\s,#]")  # in a path: no line of a scene can name it


def folder() -> Path:
    """Return the folder of the example scenes; FileError where none was installed."""
    for each in FOLDERS:
        if file_io.is_file(each / "demo.rt"):
            return each
    raise FileError(FOLDERS[0], "the example scenes are not installed")


def examples() -> list[str]:
    """Return the names of the example scenes, in alphabetical order.

    FileError where they are not installed.

        minirt.examples()  # ["demo", "eval-camera-elsewhere", ...]
    """
    return sorted(path.stem for path in folder().glob("*.rt"))


def example(name: str = "opening") -> Scene:
    """Return an example scene by its name.

    The scene belongs to no file, and names its textures and meshes by their absolute paths, so that it can be saved
    anywhere. FileError for an unknown name, with the names that are like it.

        minirt.render(minirt.example("gallery-chess"), 640, 480).save("chess.png")
    """
    known = examples()
    if name not in known:
        near = nearest(name, known, count=3)
        hint = f"did you mean {' or '.join(near)}?" if near else f"the examples are {', '.join(known)}"
        raise FileError(name, f"there is no such example scene; {hint}")
    path = folder() / f"{name}.rt"
    if UNFIT.search(str(path.parent)):
        return load(path).scene
    text = path.read_text(encoding="utf-8")
    return parse(FILE.sub(lambda named: str(folder() / named[0]), text)).scene
