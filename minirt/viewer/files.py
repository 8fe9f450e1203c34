"""Files beside the scene: copies, screenshots, recovered scenes, textures and meshes; the watch on the scene's file."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import chain, count, pairwise
from pathlib import Path

from minirt.errors import FieldError, FileError, MiniRTError, SceneError
from minirt.fields import MeshFile
from minirt.fields.triples import file_name
from minirt.helpers import file_io
from minirt.helpers.file_io import reason, stamps
from minirt.materials.pictures import picture
from minirt.meshes import BY_TRIMESH, load_mesh
from minirt.scene import Camera, Item, Scene, dump
from minirt.scene.files import SUFFIX, read
from minirt.viewer.language import translated

INTERVAL = 0.25  # seconds between two checks of the file
PICTURE_SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff", ".ppm", ".tga", ".webp", ".xpm"}
MESH_SUFFIXES = {".obj", *BY_TRIMESH}


def title_of(path: Path, scene: Scene, is_unsaved: bool = False) -> str:
    """Return the title of the window; it tells that the file is not there yet, which shapes could not be read, and by
    a star that there are unsaved changes."""
    new = "" if file_io.found(path) else f" ({translated('new')})"
    names = ", ".join(dict.fromkeys(line.split()[0] for line in scene.missing))
    count = f"{len(scene.missing)} shapes are missing" if len(scene.missing) > 1 else "1 shape is missing"
    star = " *" if is_unsaved else ""
    return f"miniRT - {path.name}{new}{star}" + (f": {translated(count)}: {names}" if names else "")


def create_numbered(path: Path, suffix: str, data: bytes, first: Path | None = None) -> Path:
    """Write a new file `name-1.suffix`, or with the first number that no file has; return its path. FileError.

    `path` gives folder and name; `first` is a path to try before. No other program's file is ever replaced, even one
    that is written just now.
    """
    numbered = (path.with_name(f"{path.stem}-{n}{suffix}") for n in count(1))
    try:
        for each in chain([first] if first else [], numbered):
            with suppress(FileExistsError):
                file_io.create(each, data)
                return each
    except OSError as error:
        raise FileError(first or path.with_suffix(suffix), f"cannot be written: {reason(error)}") from None
    raise AssertionError("there are endlessly many numbers")


def save_recovery(scene: Scene, path: Path) -> Path:
    """Write unsaved changes beside the file, or if that fails into a new temporary folder; return the path."""
    beside, data = path.with_name(f"{path.stem}.recovered{SUFFIX}"), dump(scene).encode()
    try:
        return create_numbered(beside, SUFFIX, data, beside)
    except FileError:
        elsewhere = Path(tempfile.mkdtemp(prefix="minirt-")) / beside.name
        return create_numbered(elsewhere, SUFFIX, data, elsewhere)


def is_translated(scene: Scene, path: Path) -> bool:
    """Whether a file holds other lines than the scene that a lenient reader made of it."""
    with suppress(SceneError):
        return read(path) != dump(scene).encode()
    return False


def contents_differ(scene: Scene, saved: Scene) -> bool:
    """Whether a scene differs from the saved one; looking around is not an unsaved change, a value of a camera is."""
    sides = [(one.items, other.items) for one, other in zip(scene.pages, saved.pages, strict=False) if one is not other]
    if any(len(one) != len(other) for one, other in sides) or len(scene.pages) != len(saved.pages):
        sides = [(scene.items, saved.items)]
    return any(
        len(one) != len(other)
        or any(a is not b and not is_same(a, b) and not differs_by_view(a, b) for a, b in zip(one, other, strict=True))
        for one, other in sides
    )


def is_same(one: Item, other: Item) -> bool:
    """Whether two entries of a scene are equal, and their lines have the same comment."""
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    return one == other and one.source == other.source


def differs_by_view(one: Item, other: Item) -> bool:
    """Whether two entries of a scene are cameras that were given the same values: they differ by where they look alone.

    Fields that nobody gave a value, such as a tone that an option chose, are not compared.
    """
    if not isinstance(one, Camera) or not isinstance(other, Camera) or one.source != other.source:
        return False
    mine, theirs = dict(one.edited), dict(other.edited)
    return all(mine.get(each, getattr(one, each)) == theirs.get(each, getattr(other, each)) for each in mine | theirs)


def merged(base: list[str], *versions: list[str]) -> list[str] | None:
    """Lines of a file, `base`, with the changes of its versions; None where these changed the same line differently."""
    from difflib import SequenceMatcher  # an import that takes a millisecond of a start

    changes: list[tuple[int, int, list[str]]] = []  # of lines [start, end) of the base, and what takes their place
    for version in versions:
        for tag, start, end, first, last in SequenceMatcher(None, base, version, autojunk=False).get_opcodes():
            change = start, end, version[first:last]
            if tag != "equal" and change not in changes:
                changes.append(change)
    changes.sort(key=lambda change: change[:2])
    if any(start < end for (_, end, _), (start, _, _) in pairwise(changes)):
        return None
    lines = base
    for start, end, new in reversed(changes):  # from the end, so that numbers of earlier lines stay right
        lines = [*lines[:start], *new, *lines[end:]]
    return lines


def error_summary(error: MiniRTError) -> str:
    """Return the first problem of an error without the quoted line, and the number of further problems."""
    if not isinstance(error, SceneError):
        return str(error)
    first, others = str(error.problems[0]).split("\n")[0], len(error.problems) - 1
    return f"{first}\nand {others} more" if others else first


class WatchedFile:
    """A file whose last state read or written here is known, so that changes by other programs can be reported."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.known = stamps(path)  # as it was last read or written here
        self._reported = self._seen = self.known
        self.news = threading.Event()  # the file was changed, or deleted
        self._closed = threading.Event()

    def accept(self, seen: list[tuple[int, ...]]) -> None:
        """Record the stamps of the file as it was just read or written here."""
        self.known = self._reported = seen

    @property
    def missing(self) -> bool:
        """Whether the file was there, and is not any more."""
        return bool(self.known) and not stamps(self.path)

    @property
    def changed(self) -> bool:
        """Whether another program has written the file since."""
        now = stamps(self.path)
        return bool(now) and now != self.known

    def watch(self, notify: Callable[[], object]) -> None:
        """Start a thread that sets `news`, and calls `notify`, once two checks found the same change."""

        def work() -> None:
            while not self._closed.wait(INTERVAL):
                if self.check():
                    self.news.set()
                    notify()

        threading.Thread(target=work, name="minirt-watch", daemon=True).start()

    def close(self) -> None:
        self._closed.set()

    def check(self) -> bool:
        """Whether a change is to be reported now: the last two checks found the same, which was not reported."""
        before, self._seen = self._seen, stamps(self.path)
        if self._seen == before and self._seen != self._reported:
            self._reported = self._seen
            return True
        return False


def usable_files(scene: Scene, is_mesh: bool, after: str = "", steps: float = 1.0) -> Iterator[str | MeshFile]:
    """Yield the usable pictures, or meshes, beside the scene and in its folders, each once, by their names.

    The first is the one that follows the name `after`, in reverse order if `steps` is negative. Names that a scene line
    cannot spell, and files of wrong content, are left out.
    """
    top, suffixes = scene.beside(""), MESH_SUFFIXES if is_mesh else PICTURE_SUFFIXES
    files: list[Path] = []
    with suppress(OSError):
        files += [*sorted(top.glob("*")), *sorted(top.glob("[!.]*/*"))]  # folders that cannot be read are passed over
    names = [each.relative_to(top).as_posix() for each in files if each.suffix.lower() in suffixes]
    if steps < 0:
        names.reverse()
    start = names.index(after) + 1 if after in names else 0
    for name in names[start:] + names[:start]:
        with suppress(FieldError, FileError):
            if is_mesh:
                yield MeshFile(file_name(name), load_mesh(scene.beside(name)))
            else:
                picture(scene.beside(file_name(name, ",")))
                yield name


def next_file(scene: Scene, file: str | MeshFile, steps: float) -> str | MeshFile:
    """Return the next usable picture or mesh after `file`, cyclically; the previous one if `steps` is negative."""
    is_mesh = isinstance(file, MeshFile)
    return next(usable_files(scene, is_mesh, file.name if isinstance(file, MeshFile) else file, steps), file)
