"""The tables that document the scene format are generated from the fields."""

from __future__ import annotations

from minirt.element import fields_of, pattern
from minirt.scene import format_table
from minirt.scene.registry import ELEMENTS
from tests.scene.examples import CAMERA, CYLINDER


def test_the_pattern_of_an_element_shows_its_line() -> None:
    assert (
        pattern(ELEMENTS["C"])
        == "C x,y,z dx,dy,dz fov [roll:degree] [tone:word] [exposure:EV] [lens:diameter] [focus:distance]"
    )
    assert pattern(ELEMENTS["cy"]) == "cy x,y,z ax,ay,az diameter height R,G,B"
    assert pattern(ELEMENTS["pl"]) == "pl x,y,z nx,ny,nz R,G,B"
    assert pattern(ELEMENTS["L"]) == "L x,y,z brightness [R,G,B] [fade:distance] [size:diameter]"
    assert len(pattern(ELEMENTS["C"]).split()) == len(CAMERA.split()) + 5
    assert len(pattern(ELEMENTS["cy"]).split()) == len(CYLINDER.split())


def test_the_table_has_a_row_for_every_element_and_every_field_in_it() -> None:
    head, rule, *rows = format_table().partition("\n\n")[0].splitlines()
    assert (head, rule) == ("| line | element | fields |", "|---|---|---|")
    for kind, row in zip(ELEMENTS.values(), rows, strict=True):
        assert row.startswith(f"| `{pattern(kind)}` | {kind.title}")
        assert all(f"`{alias}`" in row for alias in kind.aliases)
        own = [field for field in fields_of(kind) if not field.sort]
        assert row.count("`") == 2 + 2 * len(own) + 2 * len(kind.aliases)
        assert row.replace("\\|", "").count("|") == 4


def test_a_second_table_has_the_shared_attributes_of_shapes() -> None:
    head, rule, *rows = format_table().partition("\n\n")[2].splitlines()
    assert (head, rule) == ("| attribute | of | meaning |", "|---|---|---|")
    shared = [field for field in fields_of(ELEMENTS["sp"]) if field.sort]
    assert len(shared) == len(rows) >= 7
    for field, row in zip(shared, rows, strict=True):
        assert row.startswith(f"| `{field.notation}`")
        assert all(f"`{alias}:`" in row for alias in field.aliases)
        assert f"| {field.sort} |" in row
        assert row.count("|") == 4
    assert rows[0] == (
        "| `specular:share,exponent[,blinn]`; also `spc:` | shapes | highlight<br>`share` share of the light, in [0, 1]"
        "<br>`exponent` how smooth, in [1, 1000000]<br>`blinn` from the halfway direction |"
    )
    assert "| `checker:size[,R,G,B]`, or `checker` for `checker:0.125` (planes: `checker:1`); also `pat:` |" in rows[6]


def test_the_row_of_the_camera_has_count_ranges_units_and_defaults() -> None:
    row = next(row for row in format_table().splitlines() if row.startswith("| `C "))
    assert "| camera (exactly one) |" in row
    assert "`fov` horizontal field of view, in [0, 180], unit: degree<br>" in row
    assert "`roll:degree` turn about the direction, clockwise, in [-360, 360], unit: degree, 0 when left out<br>" in row
