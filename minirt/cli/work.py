"""Long work, which an interrupt does not undo: what is done of it is kept, and `--resume` goes on."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from minirt.cli.output import tell
from minirt.cli.part_file import PartFile, delete, path_for

if TYPE_CHECKING:
    from minirt.scene import Scene

LONG = 2**24  # rays: about a second of two processors
NAMES = ("region", "samples", "depth", "precision", "dither", "turntable", "bits", "quality", "metadata")  # of options


@contextmanager
def kept_work(
    scene: Scene, options: argparse.Namespace, size: tuple[int, int], rays: int, parts: int, what: str
) -> Iterator[PartFile | None]:
    """Keep what the block appends to the part file of the output, until the block ends without an error.

    None for work of few rays, and for standard output. `what` names the parts of the work, of which there are `parts`.
    """
    if options.output == "-":
        yield None
        return
    if rays < LONG and not options.resume:
        delete(path_for(options.output))
        yield None
        return
    part = PartFile(options.output, digest(scene, options, size), options.resume)
    if options.resume and not part.places:
        tell(f"notice: there is nothing to go on with, {options.output} is rendered from the beginning")
    try:
        yield part
    except BaseException:
        part.close()
        if part.places:
            import shlex

            command = [each for each in options.command if each != "--resume"]
            tell(f"{len(part.places)} of {parts} {what} are kept; miniRT {shlex.join([*command, '--resume'])} goes on")
        raise
    part.remove()


def digest(scene: Scene, options: argparse.Namespace, size: tuple[int, int]) -> str:
    """Return a hash of all that the pictures depend on."""
    import minirt
    from minirt.rendering.identity import identity

    settings = (f"{name}={getattr(options, name)}" for name in NAMES)
    return identity(scene, " ".join((minirt.__version__, str(size), *settings)))
