"""Movies have the right frames, and a failure leaves no half file."""

from __future__ import annotations

from math import dist

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.errors import RenderError
from minirt.movie import save_movie
from minirt.viewer.app.replay import FPS as ANIMATION_FPS
from minirt.viewer.app.replay import TICKS, record, turntable
from minirt.viewer.editing.projection import projection_of, scene_centre
from tests.viewer.fake import FakeRenderer, scene

COLOURS = [(250, 0, 0), (0, 250, 0), (0, 0, 250)]


def uniform(colour) -> minirt.Image:
    """Return a picture of one colour."""
    return minirt.Image(np.full((6, 8, 3), colour, np.uint8))


def test_a_gif_has_all_pictures_and_loops(tmp_path):
    (path,) = save_movie(map(uniform, COLOURS), tmp_path / "a.gif", fps=10)
    with pillow.open(path) as gif:
        assert (gif.n_frames, gif.info["duration"], gif.info["loop"], gif.size) == (3, 100, 0, (8, 6))
        for number, colour in enumerate(COLOURS):
            gif.seek(number)
            shown = np.asarray(gif.convert("RGB")).astype(int)
            assert np.abs(shown - colour).max() <= 4


def test_other_formats_give_numbered_files(tmp_path):
    written = save_movie(map(uniform, COLOURS), tmp_path / "a b.png")
    assert [path.name for path in written] == ["a b-0001.png", "a b-0002.png", "a b-0003.png"]
    assert np.array_equal(np.asarray(pillow.open(written[1])), uniform(COLOURS[1]).array)


@pytest.mark.parametrize("name", ["a.gif", "a.png"])
def test_an_interrupted_movie_leaves_no_half_file(tmp_path, name):
    def pictures():
        yield uniform(COLOURS[0])
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        save_movie(pictures(), tmp_path / name)
    assert [file.name for file in tmp_path.iterdir()] == ([] if name == "a.gif" else ["a-0001.png"])


def test_no_pictures_and_unwritable_paths_are_errors(tmp_path):
    for name in ("a.gif", "a.png"):
        with pytest.raises(RenderError, match="needs a picture"):
            save_movie([], tmp_path / name)
        with pytest.raises(RenderError, match="cannot write"):
            save_movie([uniform(COLOURS[0])], tmp_path / "none" / name)


def test_a_turntable_circles_the_scene_once():
    start = scene()
    middle = scene_centre(start)
    views = list(turntable(start, 8))
    assert views[0] is start
    cameras = [view.camera for view in views]
    assert len({camera.position for camera in cameras}) == 8
    for camera in cameras:
        assert dist(camera.position, middle) == pytest.approx(dist(start.camera.position, middle))
        assert camera.position[1] == start.camera.position[1]
        assert projection_of(camera, 64, 48).pixel(middle) == pytest.approx(
            projection_of(start.camera, 64, 48).pixel(middle)
        )
    opposite = cameras[4].position
    assert [opposite[0] + 0, opposite[2] + 10] == pytest.approx([2 * middle[0], 2 * middle[2]])
    assert dist(cameras[7].position, cameras[0].position) == pytest.approx(
        dist(cameras[1].position, cameras[0].position)
    )


def test_an_animation_has_frames_for_its_whole_duration():
    lines = ["wait 1", "move 20,20", "hold d 0.5"]
    frames: list[minirt.Image] = []
    record(scene(), lines, frames.append, renderer=FakeRenderer(), size=(64, 48), path="scene.rt")
    assert abs(len(frames) - 1.5 * ANIMATION_FPS) <= 2
    assert TICKS % ANIMATION_FPS == 0
    assert np.array_equal(frames[0].array, frames[3].array)
    assert (frames[-3].array[20:40, 20:32] == 255).all(axis=2).any()  # the pointer
    assert not np.array_equal(frames[-3].array, frames[-2].array)  # the camera moves
