"""Sizes of lights and the camera's lens: read, written, and taken as absent when they are left out."""

from __future__ import annotations

import pytest

from minirt.rendering.packing.features import features_of
from minirt.scene import Camera, describe, parse

LINES = {
    "L 0,5,0 0.8 size:0.5": ("light", 0.5),
    "l 0,5,0 0.8 1,2,3 fade:9 size:2": ("further light", 2.0),
    "dl 0,-1,0 1 size:0.53": ("parallel light", 0.53),
    "sl 0,5,0 0,-1,0 40 1 size:1.5": ("spot light", 1.5),
}
REST = "A 0.1 255,255,255\nC 0,0,-9 0,0,1 60 {camera}\n{light}\n"


@pytest.mark.parametrize("line", LINES)
def test_lights_have_a_size(line: str) -> None:
    (light,) = parse(REST.format(camera="", light=line)).scene.lights
    assert (light.title, light.size) == LINES[line]
    assert parse(REST.format(camera="", light=describe(light))).scene.lights == (light,)
    assert "soft" in features_of(light)
    assert "soft" not in features_of(light.replace(size=None))
    assert not set(features_of(light.replace(brightness=0.0)))


def test_a_camera_has_a_lens_and_a_focus() -> None:
    camera = parse(REST.format(camera="lens:0.25 focus:7.5", light="")).scene.camera
    assert (camera.lens, camera.focus) == (0.25, 7.5)
    assert describe(camera).endswith("lens:0.25 focus:7.5")
    assert set(features_of(camera)) == {"lens"}
    pinhole = Camera((0, 0, 0), (0, 0, 1), 60)
    assert (pinhole.lens, pinhole.focus) == (None, None)
    assert not set(features_of(pinhole.replace(focus=3.0)))
