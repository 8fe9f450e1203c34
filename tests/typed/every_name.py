"""Program that uses every public name as a user does: it runs, and type checkers find no error in it."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, assert_type

import numpy as np
from numpy.typing import NDArray

import minirt

RED, WHITE, UP = (255, 0, 0), (255, 255, 255), (0.0, 1.0, 0.0)
FOLDER = Path(sys.argv[1])

(FOLDER / "corner.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")

ball = minirt.Sphere((0, 0, 5), 2, RED, mirror=0.3, glass=minirt.Glass(1.5), roll=20)
shapes: list[minirt.Shape] = [
    ball,
    minirt.Plane((0, -2, 0), UP, WHITE, checker=minirt.Checker(0.5)),
    minirt.Cylinder((0, 0, 9), UP, 1, 2, RED, specular=minirt.Specular(0.5, 30)),
    minirt.Cone((3, 0, 9), UP, 1, 2, RED, fresnel=1, glow=0.1),
    minirt.Paraboloid((6, 0, 9), UP, 1, 2, RED, mirror=minirt.Mirror(0.2)),
    minirt.Hyperboloid((-3, 0, 9), UP, 1, 2, 3, RED),
    minirt.Triangle((0, 0, 20), (1, 0, 20), (0, 1, 20), RED),
    minirt.Square((-6, 0, 9), UP, 2, RED, uv=minirt.Placement(2, 2), texture="wood.png"),
    minirt.Disc((-6, 3, 9), UP, 2, RED, marble=minirt.Marble(1, RED), normal_map="bricks.png"),
    minirt.Box((-6, 6, 9), UP, (1, 2, 3), RED, wood=minirt.Wood(1, RED), bump=minirt.Bump("bricks.png", 0.1)),
    minirt.Torus((6, 6, 9), UP, 2, 0.5, RED, clouds=minirt.Clouds(1, RED)),
    minirt.Ellipsoid((6, 9, 9), UP, (1, 2, 3), RED, tint=minirt.Tint(RED)),
    minirt.Mesh(minirt.MeshFile(str(FOLDER / "corner.obj")), (0, 0, 8), 2, RED),
    minirt.Mesh.from_arrays(np.eye(3), [[0, 1, 2]], position=(9, 9, 9), colour=RED, mirror=0.5),
]
lamps: list[minirt.Lamp] = [
    minirt.Light((5, 5, -5), 0.5),
    minirt.FurtherLight((-5, 5, -5), 0.5, WHITE, fade=40),
    minirt.ParallelLight((0, -1, 0), 0.2),
    minirt.SpotLight((0, 9, 0), (0, -1, 0), 40, 0.5, rim=0.2),
]
camera = minirt.Camera((0, 0, -10), (0, 0, 1), 60, tone="filmic", exposure=0.5)
further = minirt.FurtherCamera((9, 0, 0), (-1, 0, 0), 50)
made = minirt.Scene(
    [minirt.Ambient(0.2, WHITE), camera, further, minirt.Background(RED), minirt.Resolution(16, 9), *lamps, ball]
)
made = made.add(minirt.Plane((0, -2, 0), UP, WHITE)).remove(ball).add(ball)
made = made.replace(ball, diameter=3).replace(made.camera, minirt.Camera.look_at((0, 1, -9), (0, 0, 5), fov=40))
made.save(FOLDER / "made.rt")
scene: minirt.Scene = minirt.load(FOLDER / "made.rt", lenient=True)
text: str = minirt.dumps(minirt.loads(minirt.dumps(scene)))
first: minirt.Sphere = scene.spheres[0]
centre: minirt.Triple = first.centre
diameters: list[float] = [each.diameter for each in scene.spheres]
colours = [shape.colour for shape in scene.shapes] + [lamp.colour for lamp in scene.lights]
element: minirt.Element = scene.elements[0]
names: list[str] = minirt.examples()
demo: minirt.Scene = minirt.example(names[0])

picture: minirt.LinearImage = minirt.render(
    scene, 32, 18, samples=4, precision="single", threads=2, depth=3, dither=True
)
light: NDArray[np.float64] = picture.linear
assert_type(picture.array, NDArray[np.uint8])
mean: float = float(picture.linear.mean())
bytes_of_png: bytes = picture.encode()
array: NDArray[np.uint8] = np.asarray(picture)
auto = minirt.render(scene, 32, 18, samples="auto", error=0.1, linear=False)
outcome: minirt.Outcome | None = auto.reached
error: float = outcome.error if outcome else 0.0
plain: minirt.Image = picture
plain.save(FOLDER / "picture.png")
minirt.limit_memory(2**32)
minirt.limit_memory(None)
written: list[Path] = minirt.save_movie([plain, auto.array], FOLDER / "movie.gif", fps=10)
reached = minirt.render_to(FOLDER / "large.tif", scene, 8, 6, samples="auto", error=0.1, executor=ThreadPoolExecutor(1))
goal: float = reached.goal if reached else 0.0
frames: list[minirt.Image] = list(minirt.render_all([scene, scene], 8, 6))
size: tuple[int, int] = minirt.size_of(scene)

origins, directions = minirt.camera_rays(scene, 8, 6)
hits: minirt.Hits = minirt.trace(scene, origins.reshape(-1, 3), directions.reshape(-1, 3), threads=1)
distance: NDArray[np.float64] = hits.distance
worst: float = float(np.nanmax(hits.backward_error))
table: dict[str, NDArray[np.float64] | NDArray[np.int64]] = hits.columns()
buffers: minirt.Buffers = minirt.buffers(scene, 8, 6)
depth: NDArray[np.float64] = buffers.depth
albedo: NDArray[np.float64] = buffers.albedo
buffers.picture("normals").save(FOLDER / "normals.png")
explanation: minirt.Explanation = minirt.explain(scene, 8, 6, 4, 3)
assert_type(explanation.level, tuple[int, int, int])
comparison: minirt.Comparison = minirt.compare(scene, FOLDER / "picture.png")
answer: dict[str, Any] = comparison.json()
panels: NDArray[np.uint8] = comparison.panels()

renderer: minirt.Renderer = minirt.renderer(None)
frame = np.zeros((6, 8, 4), np.uint8)
done: bool = renderer.render(scene, frame)

try:
    minirt.load("absent.rt")
except minirt.SceneError as refused:
    problems: tuple[minirt.Problem, ...] = refused.problems
except (minirt.TooLargeError, minirt.ElementError):
    raise
except (minirt.RenderError, minirt.FileError, minirt.ReplayError, minirt.MlxError, minirt.MiniRTError):
    raise


def edit(shown: minirt.Scene) -> minirt.Scene:
    """Show a scene in a window."""
    shown = minirt.view(shown, (640, 480), samples=4, precision="double")
    return minirt.view(shown, notebook=False)


def edit_in_notebook(shown: minirt.Scene) -> minirt.Scene:
    """Show a scene in a notebook."""
    viewer = minirt.view(shown, (640, 480), notebook=True)
    viewer.scene = shown.replace(shown.spheres[0], diameter=3)
    picture: minirt.Image = viewer.picture
    picture.save("picture.png")
    edited: minirt.Scene = viewer.scene
    return edited
