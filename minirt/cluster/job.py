"""Jobs: pictures, cut into bands that anyone may render with the same result, and their way to workers."""

from __future__ import annotations

import atexit
import hashlib
import pickle
import shutil
import sys
from collections.abc import Sequence
from functools import cache, lru_cache, partial
from io import BytesIO
from itertools import chain, pairwise
from math import sqrt
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from minirt import __version__
from minirt.errors import RenderError
from minirt.formats import tiff
from minirt.helpers import file_io
from minirt.kernel.machine_code.fingerprint import V3, fingerprint_of
from minirt.kernel.pixels import TILE
from minirt.rendering import settings as rendering_settings
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Region, cut_for
from minirt.rendering.settings import RenderSettings
from minirt.scene import Camera, Scene

ROWS = 64  # of a band, where the next two leave the choice
MOST_PIXELS = 2**21  # of a band, whose light takes 48 MiB; but at least one row of tiles
LEAST_PIXELS = 2**15  # of a band: twice those from which on the estimated error of a picture is promised
RAYS, MOST_BANDS = 2**21, 64  # rays of a band, and bands that are so small because of their rays


class Job(NamedTuple):
    """A picture of a scene, or a region of it, to be rendered by anyone, as a whole or in bands: jobs, too."""

    scene: Scene
    size: tuple[int, int]  # of the whole picture, in pixels
    settings: RenderSettings  # their region is that of a band
    number: int = 0  # of a band in its job, or of a picture in its film
    bits: int | None = None  # of the strips of a TIFF file that are made of it, None for arrays

    @property
    def region(self) -> Region:
        """The rectangle of the picture that is rendered; RenderError where it does not lie in the picture."""
        return cut_for(self.settings.region, *self.size).region

    @property
    def what(self) -> str:
        """The name of a band in messages."""
        _, first, _, height = self.region
        return f"rows {first} to {first + height - 1}" if self.settings.region else "a picture"

    def bands(self, bits: int | None = None) -> list[Job]:
        """Cut the picture into bands, of which strips of `bits` a channel are made if they are given."""
        samples = 1 if self.settings.samples == "auto" else self.settings.samples
        pairs = enumerate(rows_of(self.region, samples))
        return [Job(self.scene, self.size, self.settings.replace(region=each), number, bits) for number, each in pairs]

    def identity(self, *more: object) -> str:
        """Return a hash of all that the bits of the picture depend on, and of `more`: it tells the job from others."""
        settings = f"{__version__} {self.size} {self.settings.replace(threads=None)} {more}"
        return rendering_settings.identity(self.scene, settings)


class Strips(NamedTuple):
    """Compressed strips of a TIFF file, made of a band; none of a picture that is in a file of its own already."""

    parts: tuple[bytes, ...]
    reached: Outcome | None


Workers: TypeAlias = Any  # an executor of concurrent.futures, a function that makes one, or a dask client
Made: TypeAlias = Any  # what is made of a band: an `Image`, or `Strips` where the band has bits


def render_band(band: Job) -> Made:
    """Render a band in this process."""
    image = rendering_settings.rendered(band.scene, band.size, band.settings)
    if band.bits:
        return Strips(tiff.strips(image.channels(band.bits)), image.reached)
    return image


def rows_of(region: Region, samples: int) -> list[Region]:
    """Divide a region of a picture into bands of whole rows of tiles, which depend on its size and samples alone.

    So does the estimated error of a picture that is made of bands, whoever renders them.
    """
    x, y, width, height = region
    rows = min(max(ROWS, LEAST_PIXELS // width), max(TILE, MOST_PIXELS // width))
    tiles = -(-height // TILE)
    count = max(1, round(height / rows), min(MOST_BANDS, width * height * samples // RAYS))
    ends = [min(height, TILE * (tiles * number // count)) for number in range(count + 1)]
    return [Region(x, y + first, width, end - first) for first, end in pairwise(ends) if end > first]


def whole(parts: Sequence[tuple[Region, Outcome | None]]) -> Outcome | None:
    """Return the outcome of a picture from its bands, each with its region and outcome; None where one has no outcome.

    The square of an error is a mean over pixels: the square for the whole is the mean of those of its bands, weighted
    by their pixels. Where the error of each band is at most the goal that of the whole is, too. Seconds are added up.
    """
    in_order = sorted(parts, key=itemgetter(0))  # so that sums are rounded alike
    outcomes = [each for _, each in in_order if each is not None]
    if not outcomes or len(outcomes) < len(parts):
        return None
    mean = partial(np.average, weights=[region.width * region.height for region, _ in in_order])
    return Outcome(
        samples=float(mean([each.samples for each in outcomes])),
        most=max(each.most for each in outcomes),
        error=sqrt(mean([each.error**2 for each in outcomes])),
        seconds=sum(each.seconds for each in outcomes),
        goal=outcomes[0].goal,
        rounded=any(each.rounded for each in outcomes) and not all(each.is_reached for each in outcomes),
        rounding=sqrt(mean([each.rounding**2 for each in outcomes])),
    )


# Scenes on their way to workers, which are other processes or other machines, and the work that is done there. Values
# travel as they are, not as text, since a direction that is normalised again may differ in its last bit. Workers on
# other machines get textures, too, under the hashes of their contents.

SCENES = 4  # that are kept unpacked in memory


@cache
def version() -> str:
    """Return the version of the program and of the sources of its kernels."""
    return f"{__version__} {fingerprint_of(V3)}"


class Packer(pickle.Pickler):
    """Pickler that puts the hashes of files in place of their names."""

    hashes: dict[str, str]

    def persistent_id(self, value: object) -> str | None:
        return self.hashes.get(value) if isinstance(value, str) else None


class Unpacker(pickle.Unpickler):
    """Unpickler that puts the paths of this worker's files in place of their hashes."""

    def persistent_load(self, digest: str) -> str:
        return str(folder() / digest)


def packed(scene: Scene, with_files: bool) -> bytes:
    """Return a scene as bytes, `with_files` with the contents of its textures; FileError where one cannot be read."""
    named = chain.from_iterable(map(rendering_settings.files_of, scene.elements)) if with_files else ()
    names = {*named} - {mesh.file.name for mesh in scene.meshes}  # whose triangles travel
    contents = {name: file_io.read(scene.beside(name), file_io.LARGEST_ASSET) for name in names}
    buffer = BytesIO()
    packer = Packer(buffer, protocol=5)
    packer.hashes = {name: hashlib.sha256(data).hexdigest() for name, data in contents.items()}
    place = None if with_files else (scene.file or Path("scene.rt")).absolute()
    packer.dump((scene.elements, place))
    return pickle.dumps((buffer.getvalue(), {packer.hashes[name]: data for name, data in contents.items()}))


@lru_cache(SCENES)
def unpacked(data: bytes) -> Scene:
    """Return a scene; its textures are written into this worker's folder."""
    packed_scene, files = pickle.loads(data)
    for digest, content in files.items():
        if not file_io.is_file(texture := folder() / digest):
            file_io.write(texture, content)
    return Scene(*Unpacker(BytesIO(packed_scene)).load())


@cache
def folder() -> Path:
    """Return a folder for textures, which is deleted at the end of this process or, if it was killed, by dask.

    Threads that ask for it at once may get one each.
    """
    from tempfile import mkdtemp

    worker = dask_worker()
    path = mkdtemp(prefix="minirt-", dir=worker and worker.local_directory)
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return Path(path)


def render_sent_band(asked: str, data: bytes, camera: Camera, band: Job) -> Made:
    """Render a band at a worker: of the scene that is packed in `data`, seen by `camera`; `band.scene` is not used.

    RenderError where this version is not the one `asked` for, which might draw other bits.
    """
    if asked != version():
        raise RenderError(f"a worker has another miniRT: {version()} in place of {asked}")
    scene = unpacked(data)
    settings = band.settings
    if settings.threads is None:
        settings = settings.replace(threads=share_of_cores())
    return render_band(band._replace(scene=scene.replace(scene.camera, camera), settings=settings))


def share_of_cores() -> int | None:
    """Return the number of threads that a dask worker has; None elsewhere: all processors."""
    worker = dask_worker()
    return worker and int(worker.state.nthreads)


def dask_worker() -> Any:
    """Return the dask worker that calls this, None elsewhere."""
    if "distributed" not in sys.modules:
        return None
    from distributed import get_worker

    try:
        return get_worker()
    except ValueError:  # not called by a worker
        return None
