"""Variants of real files that the strict reader accepts, without a notice or with one."""

from __future__ import annotations

import math

import pytest

from minirt.fields import Real
from minirt.scene import Camera, Light, parse
from minirt.scene.lines import Line, Log, Word
from minirt.scene.value_reader import Slot, parse_slot
from minirt.shapes.sphere import Sphere
from tests.scene.examples import AMBIENT, CAMERA, LIGHT, SPHERE, WHOLE, notices, read, scene_with

BALL = Sphere((0.0, 0.0, 20.0), 12.6, (10, 0, 255))


@pytest.mark.parametrize(
    "line",
    [
        SPHERE,
        "sp\t0,0,20\t12.6\t10,0,255",
        "sp \t 0,0,20  \t\t 12.6   10,0,255",
        "   sp 0,0,20 12.6 10,0,255",
        "\tsp 0,0,20 12.6 10,0,255",
        "sp 0,0,20 12.6 10,0,255   ",
        "sp 0,0,20 12.6 10,0,255 \t",
        "sp 0,0,20 12.6 10,0,255\r",
        "sp 0,0,20 12.6 10,0,255 \t\r",
        "sp 0,0,20 12.6 10,0,255 # a ball",
        "sp 0,0,20 12.6 10,0,255 #a ball\r",
        "sp 0,0,20 12.6 10,0,255#a ball",
        "sp 0,0,20 12.6 10,0,255 #fff000",
        "sp 0,0,20 12.6 10,0,255 # naïve 球 \u00a0\u200b\u2028 \v\f # // , \t",
        "sp +0,-0,+20 +12.6 +10,-0,+255",
        "sp 0.,.0,20. 12.6 10,0,255",
        "sp 0,0,2e1 1.26e+1 10,0,255",
        "sp 0e0,0E9,200E-1 126e-1 10,0,255",
        "sp 000,00.0,0020.00 0012.600 010,000,0255",
        "sp 1e-400,-1e-400,20 12.6 10,0,255",
        f"sp 0,0,20 12.6{'0' * 296} 10,0,255",
    ],
)
def test_all_spellings_of_a_line_give_the_same_element(line: str) -> None:
    reading = parse(scene_with(line))
    assert reading.scene.spheres == (BALL,)
    assert reading.scene.spheres[0].source == line
    assert all(math.copysign(1, each) == 1 for each in reading.scene.spheres[0].centre)
    assert reading.notices == ()


@pytest.mark.parametrize(
    "line", ["", " ", "\t", "\r", " \t\r", "#", "# a comment", "  # indented", "#sp 0,0,20", "#!/x"]
)
def test_blank_lines_and_comments_are_kept(line: str) -> None:
    assert read(line, SPHERE).items[2] == line


@pytest.mark.parametrize(
    "text",
    [
        WHOLE,
        WHOLE.removesuffix("\n"),
        WHOLE.replace("\n", "\r\n"),
        WHOLE.replace("\n", "\r\n", 3),
        "\ufeff" + WHOLE,
        "\ufeff\n" + WHOLE,
        "\ufeff# a comment\n" + WHOLE,
        "\n\n\n" + WHOLE + "\n \n\t\n",
        "\n".join(reversed(WHOLE.split("\n"))),
        WHOLE + "\r",
    ],
)
def test_line_ends_blank_lines_and_order_do_not_change_the_elements(text: str) -> None:
    scene = parse(text).scene
    assert set(scene.elements) == set(parse(WHOLE).scene.elements)
    assert "\n".join(item if isinstance(item, str) else item.source for item in scene.items) == text
    assert parse(text.encode()).scene == scene


def test_the_light_and_its_colour_are_optional() -> None:
    assert parse(scene_with()).scene.lights == ()
    assert read("L 0,0,0 0.5").lights == (Light((0.0, 0.0, 0.0), 0.5, (255, 255, 255)),)
    assert read("L 0,0,0 0.5 # warm").lights[0].colour == (255, 255, 255)


def test_further_lights_and_a_resolution_are_read() -> None:
    scene = read("l 0,0,0 0.5 1,2,3", "R 640 480", LIGHT, "l 1,0,0 1")
    assert [light.code for light in scene.lights] == ["l", "L", "l"]
    assert scene.resolution is not None
    assert (scene.resolution.width, scene.resolution.height) == (640, 480)


def test_the_camera_may_roll() -> None:
    assert parse(f"{AMBIENT}\nC 0,0,0 0,0,1 70 roll:-12.5").scene.camera == Camera((0, 0, 0), (0, 0, 1), 70, -12.5)
    assert parse(f"{AMBIENT}\n{CAMERA}").scene.camera.roll == 0


@pytest.mark.parametrize(("low", "high"), [("0", "1"), ("0.0", "1.0"), ("-0", "+1e0")])
def test_the_ends_of_a_range_are_accepted(low: str, high: str) -> None:
    assert [light.brightness for light in read(f"l 0,0,0 {low}", f"l 0,0,0 {high}").lights] == [0, 1]


def test_the_field_of_view_of_0_and_180_is_read_with_a_notice() -> None:
    for fov in ("0", "180", "0e9", "180.0"):
        reading = parse(f"{AMBIENT}\nC 0,0,0 0,0,1 {fov}\n", "test.rt")
        assert reading.scene.camera.fov == float(fov)
        (notice,) = reading.notices
        assert (notice.line, notice.column) == (2, 15)
        assert notice.message == f"camera fov {float(fov):g} renders as the nearest angle that can be drawn"
    assert parse(f"{AMBIENT}\nC 0,0,0 0,0,1 1e-300").notices == ()


def test_a_notice_about_a_keyed_field_stands_under_its_value() -> None:
    log, field = Log("test.rt", lenient=False), Real(doc="", low=0, high=1, ends="is an end", name="share", keyed=True)
    assert parse_slot(Slot(Sphere, field, Word(4, "share:1"), 6), Line(1, "", "sp share:1"), log) == 1
    (notice,) = log.notices
    assert (notice.column, notice.length, notice.message) == (10, 1, "sphere share 1 is an end")


@pytest.mark.parametrize(
    ("normal", "notice"),
    [
        ("0,1,0", ""),
        ("0.577,0.577,0.577", ""),
        ("0,1,0.03", ""),
        ("0,0.5,0", "directions are scaled to length 1: 0,0.5,0"),
        ("1,1,1", "directions are scaled to length 1: 1,1,1"),
        ("0,0,1e-300", "directions are scaled to length 1: 0,0,1e-300"),
        ("0,0.998,0", "directions are scaled to length 1: 0,0.998,0"),
    ],
)
def test_a_direction_is_normalised_with_a_notice_when_its_length_was_far_from_1(normal: str, notice: str) -> None:
    line = f"pl 0,0,0 {normal} 1,2,3"
    (plane,) = read(line).planes
    assert math.hypot(*plane.normal) == pytest.approx(1, abs=4 * 2**-53)
    assert plane.source == line
    assert notices(line) == ([(3, 10, notice)] if notice else [])
