"""Sizes of scenes, and positions of the camera that frame an element."""

from __future__ import annotations

from math import asin, atan, degrees, dist, tan

import pytest

from minirt.fields import FARTHEST, LEAST_LENGTH
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.projection import scene_size
from minirt.viewer.editing.state import initial_state
from tests.viewer.fake import scene

HEAD = "A 0 0,0,0\nC 0,0,10 0,0,-1 60\n"


@pytest.mark.parametrize(
    ("lines", "size"),
    [
        ("", 10),  # to the point that is nearest to the origin
        ("sp 0,0,0 2 9,9,9", 10),
        ("sp 0,0,10 2 9,9,9", 1),  # the camera is in its centre
        ("sp 0,0,0 2 9,9,9\nsp 0,0,1 2 9,9,9\nsp 0,0,0 1e9 9,9,9", 10),  # with a sky
        ("sp 0,0,0 2 9,9,9\npl 0,-1e6,0 0,1,0 9,9,9", 10),  # a plane is unbounded
        ("pl 0,0,6 0,1,0 9,9,9", 4),
        ("L 3,0,14 1", 5),
        ("sp 0,0,9.999999 1e-9 9,9,9", 1e-6),
        ("sp 1e15,0,0 1 9,9,9", FARTHEST),
        ("pl 0,0,10 0,1,0 9,9,9", 10),
        ("sp 0,0,10 1e-30 9,9,9", LEAST_LENGTH),
    ],
)
def test_the_size_of_a_scene_is_the_median_distance(lines, size):
    assert scene_size(scene(HEAD + lines + "\n")) == pytest.approx(size)


@pytest.mark.parametrize("fov", [1, 60, 120])
def test_look_at_fits_a_sphere_to_a_usual_window(fov):
    text = f"A 0 0,0,0\nC 50,2,9 0.6,0,0.8 {fov}\nsp 1,2,3 4 9,9,9\n"
    state = apply(apply(initial_state(scene(text)), "select next"), "look at")
    position = state.scene.camera.position
    distance = dist(position, (1, 2, 3))
    assert position == pytest.approx((1 - 0.6 * distance, 2, 3 - 0.8 * distance), abs=1e-5)
    share = tan(asin(2 / distance)) / tan(atan(tan(fov / 2 * 3.141592653589793 / 180) * 9 / 16))
    assert 0.3 < share < 1, degrees(asin(2 / distance))


def test_look_at_moves_near_to_a_light():
    state = apply(apply(initial_state(scene(HEAD + "L 3,0,-1000 1\nsp 0,0,0 1 9,9,9\n")), "select next"), "look at")
    assert 0 < dist(state.scene.camera.position, (3, 0, -1000)) < 10
