"""Materials of .mtl files become attributes, and a mesh of several is drawn as one mesh for each of them."""

from __future__ import annotations

import random
import sys
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.cluster.job import packed, unpacked
from minirt.errors import FileError
from minirt.materials import Bump, Glass, Mirror, Specular
from minirt.meshes import load_mesh
from minirt.meshes.mtl import MeshMaterial
from minirt.rendering.packing import materials as packing
from minirt.rendering.packing.looks import looks_of
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.tone_mapping import decode_srgb
from minirt.scene import Scene, load, parse

FACE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl one\nf 1 2 3\n"


def material(folder: Path, *statements: str) -> tuple[MeshMaterial, tuple[str, ...]]:
    """Return the material of a triangle with these statements, and the notices about its file."""
    (folder / "a.mtl").write_text("\n".join(["newmtl other", "Kd 0 1 0", "newmtl one", *statements]))
    (folder / "a.obj").write_text(FACE + f"# {random.random()}\n")  # another file each time
    mesh = load_mesh(folder / "a.obj")
    assert mesh.material_of is not None
    return mesh.materials[mesh.material_of[0]], mesh.notices


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a picture whose name has blanks."""
    (tmp_path / "maps").mkdir()
    Image.fromarray(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)).save(tmp_path / "maps" / "my relief.png")
    return tmp_path


MEANT = {
    ("Kd 1 0.5 0",): {"colour": (255, 128, 0)},
    ("Kd 0.2", "Ka 1 1 1", "Ke 0 0 0", "Tf 1 1 1"): {"colour": (51, 51, 51)},
    ("Kd 2 -1 1e9",): {"colour": (255, 0, 255)},
    ("Kd spectral ident.rfl 1",): {},
    ("Ks 0.2 0.3 0.4", "Ns 96"): {"specular": Specular(0.3, 96, blinn=True)},
    ("Ks 1 1 1", "Ns 0.5"): {"specular": Specular(1, 1, blinn=True)},
    ("Ks 1 1 1", "Ns 0"): {},
    ("Ks 1 1 1", "Ns 50", "illum 1"): {},
    ("Ks 0.5 0.5 0.5", "illum 3"): {"mirror": Mirror(0.5)},
    ("d 0.25", "Ni 1.45"): {"glass": Glass(1.45, 0.75)},
    ("d -halo 0.25", "Ni 0.5"): {"glass": Glass(1.0, 0.75)},
    ("Tr 0.25",): {"glass": Glass(1.0, 0.25)},
    ("d 1.0", "Tr 1.0"): {},
    ("d 0",): {"glass": Glass(1.0, 1.0)},
    ("Kd 0 0 0",): {"colour": (0, 0, 0)},
}


@pytest.mark.parametrize(("statements", "expected"), MEANT.items(), ids=range(len(MEANT)))
def test_statements_become_attributes(folder: Path, statements: tuple[str, ...], expected: dict[str, object]) -> None:
    assert material(folder, *statements) == (MeshMaterial(**expected), ())


@pytest.mark.parametrize("name", ["maps/my relief.png", "maps\\my relief.png", "C:\\work\\maps/my relief.png"])
def test_maps_are_found_beside_the_file(folder: Path, name: str) -> None:
    found, notices = material(folder, f"map_Kd -s 1 1 1 {name}", f"map_Bump -bm 0.5 {name}", f"norm {name}")
    if name.startswith("C:"):
        assert (found, notices) == (MeshMaterial(), (UNUSED.format("pictures that cannot be read"),))
        return
    file = str(folder / "maps" / "my relief.png")
    assert (found, notices) == (MeshMaterial(texture=file, bump=Bump(file, 0.01), normal_map=file), ())


UNUSED = "has materials of which this is not used: {}"


def test_what_is_not_used_is_said_once(folder: Path) -> None:
    _, notices = material(folder, "Ke 0 0 1", "map_Ks none.png", "Tf 1 0 1", "secret 1", "map_Kd none.png")
    assert notices == (UNUSED.format("Ke, Tf, map_Ks, pictures that cannot be read"),)
    (folder / "a.obj").write_text(FACE.replace("a.mtl", "none.mtl"))
    mesh = load_mesh(folder / "a.obj")
    assert mesh.notices == (UNUSED.format("a file of materials that cannot be read"),)
    (folder / "a.mtl").write_text("newmtl one\nKd 1 0 0\n")
    (folder / "a.obj").write_text(FACE.replace("usemtl one", "usemtl two"))
    assert load_mesh(folder / "a.obj").notices == (UNUSED.format("materials that no file has"),)


def test_a_black_kd_beside_a_picture_is_left_out_with_a_notice(folder: Path) -> None:
    file = str(folder / "maps" / "my relief.png")
    for lines in permutations(("Kd 0 0 0", "map_Kd maps/my relief.png")):
        notice = UNUSED.format("a black Kd beside map_Kd")
        assert material(folder, *lines) == (MeshMaterial(texture=file), (notice,))
    assert material(folder, "Kd 0 0 0", "map_Kd none.png")[0] == MeshMaterial(colour=(0, 0, 0))


EVEN = 200, 100, 255
LIT = "A 1 255,255,255\nC 0.25,0.25,-1 0,0,1 20 {}\n"


@pytest.mark.parametrize("tone", ["tone:plain", "tone:srgb"])
def test_the_colour_of_a_material_multiplies_the_light_of_its_picture(folder: Path, tone: str) -> None:
    """The colour is that of the line times Kd, as of a mesh without pictures; a texture of the line replaces it all."""
    Image.new("RGB", (2, 2), EVEN).save(folder / "even.png")
    material(folder, "Kd 0.8 1 0.2", "map_Kd even.png")
    (folder / "a.obj").write_text(FACE)
    decodes = tone == "tone:srgb"
    picture, colour = (decode_srgb(each) if decodes else each for each in np.divide([EVEN, (80, 255, 51)], 255))
    for own, light in (("", picture * colour), ("texture:even.png", picture)):
        text = LIT.format(tone) + f"ob a.obj 0,0,0 1 100,255,255 {own}\n"
        linear = minirt.render(parse(text, str(folder / "x.rt")).scene, 4, 4, linear=True).linear
        assert np.allclose(linear, light, atol=1e-6)


HEAD = (
    "A 0.3 255,255,255\nC 0,1,-4 0,-0.2,1 60\nL 4,6,-6 0.8 255,255,255\ndl 0.5,-1,0.5 0.4\npl 0,-1.5,0 0,1,0 99,99,99\n"
)
STATEMENTS = (
    ("Kd 1 0 0", "255,0,0"),
    ("Kd 0 1 0\nKs 0.5 0.5 0.5\nNs 30", "0,255,0 specular:0.5,30,blinn"),
    ("Kd 1 1 0\nd 0.5\nNi 1.25", "255,255,0 glass:1.25,0.5"),
    ("map_Kd maps/my relief.png", '255,255,255 texture:"maps/my relief.png"'),
    ("map_Bump -bm 2 maps/my relief.png", '255,255,255 bump:"maps/my relief.png",0.04'),
)


def scenes(folder: Path) -> tuple[Scene, Scene]:
    """Return a scene of a mesh with several materials, glass first, and of a mesh for each of them."""
    corners = (
        "".join(f"v {x} {y} {z}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)) + "vt 0 0\nvt 1 0\nvt 1 1\n"
    )
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "2 6 8 4"]  # open in front
    order = [2, *random.sample((0, 1, 3, 4), 4)]  # glass is first
    lines, one = [], [corners, "mtllib cube.mtl"]
    for number, (index, face) in enumerate(zip(order, faces, strict=True)):
        text = "f " + " ".join(f"{each}/{1 + place % 3}" for place, each in enumerate(face.split()))
        (folder / f"{number}.obj").write_text(f"{corners}{text}\n")
        lines.append(f"ob {number}.obj 0,0,0 1 {STATEMENTS[index][1]} axis:0,1,0 roll:30")
        one += [f"usemtl m {index}", text]
    (folder / "cube.obj").write_text("\n".join([*one, ""]))
    (folder / "cube.mtl").write_text("".join(f"newmtl m {i}\n{each}\n" for i, (each, _) in enumerate(STATEMENTS)))
    (folder / "one.rt").write_text(HEAD + "ob cube.obj 0,0,0 1 255,255,255 axis:0,1,0 roll:30\n")
    (folder / "many.rt").write_text(HEAD + "\n".join(lines) + "\n")
    return load(folder / "one.rt").scene, load(folder / "many.rt").scene


@pytest.mark.parametrize("wrong", [False, True], ids=["", "planted"])
def test_a_mesh_of_several_materials_is_drawn_as_one_for_each(
    folder: Path, monkeypatch: pytest.MonkeyPatch, wrong: bool
) -> None:
    """The planted packing takes a mesh for glass or opaque as a whole, as its first triangle is."""
    one, many = scenes(folder)
    right = minirt.render(many, 96, 64).array
    if wrong:
        monkeypatch.setattr(packing, "mark_mixed", lambda *_: None)
    assert np.array_equal(minirt.render(one, 96, 64).array, right) != wrong


def test_own_attributes_of_a_mesh_count_more_and_its_colour_tints(folder: Path) -> None:
    one, _ = scenes(folder)
    mesh = one.meshes[0].replace(colour=(200, 100, 50), specular=Specular(0.25, 5))
    looks = {look.colour: look for look in mesh.looks}
    assert set(looks) == {(200, 100, 50), (200, 0, 0), (0, 100, 0), (200, 100, 0)}
    assert {look.specular for look in mesh.looks} == {Specular(0.25, 5)}
    assert looks[200, 100, 0].glass == Glass(1.25, 0.5)
    arrays = ShapeArrays()
    arrays.update((mesh,))
    shapes, numbers = looks_of(arrays)
    colours = np.array([shapes[number].colour for number in numbers]) / 255
    assert np.array_equal(arrays.colours_and_extents[:, :3], colours)


def test_workers_get_the_pictures_of_materials(folder: Path) -> None:
    one, _ = scenes(folder)
    sent = unpacked(packed(one, with_files=True))
    names = [look.texture for look in sent.meshes[0].looks if look.texture]
    assert [sent.beside(name).read_bytes() for name in names] == [(folder / "maps/my relief.png").read_bytes()]


@pytest.mark.parametrize("suffix", ["stl", "ply", "glb"])
def test_other_files_are_read_by_trimesh(folder: Path, suffix: str) -> None:
    trimesh = pytest.importorskip("trimesh", reason="pip install trimesh scipy")
    trimesh.creation.box((1, 2, 4)).export(folder / f"box.{suffix}")
    mesh = load_mesh(folder / f"box.{suffix}")
    assert (len(mesh), mesh.closed, mesh.normals is not None) == (12, True, False)
    assert mesh.box.tolist() == [[-0.5, -1, -2], [0.5, 1, 2]]


def test_parts_of_a_file_of_gltf_keep_colours_and_pictures(folder: Path) -> None:
    trimesh = pytest.importorskip("trimesh", reason="pip install trimesh scipy")
    visual, scene = trimesh.visual, trimesh.Scene()
    image = Image.open(folder / "maps" / "my relief.png")
    for colour, uv, picture in (([255, 0, 0], None, None), ([255, 255, 255], np.eye(8, 2), image)):
        box = trimesh.creation.box()
        look = visual.material.PBRMaterial(baseColorFactor=[*colour, 255], baseColorTexture=picture)
        box.visual = visual.TextureVisuals(uv=uv, material=look)
        scene.add_geometry(box)
    scene.export(folder / "two.glb")
    mesh = load_mesh(folder / "two.glb")
    assert mesh.material_of is not None
    assert mesh.uvs is not None
    looks = {mesh.materials[number] for number in mesh.material_of}
    assert {(look.colour, look.specular, bool(look.texture)) for look in looks} == {
        ((255, 0, 0), None, False),
        ((255, 255, 255), None, True),
    }
    assert {np.ptp(mesh.uvs[mesh.material_of == number]) for number in mesh.material_of} == {0, 1}


def test_a_mesh_is_read_again_when_only_its_materials_have_changed(folder: Path) -> None:
    material(folder, "Kd 1 0 0")
    before = load_mesh(folder / "a.obj")
    assert load_mesh(folder / "a.obj") is before
    (folder / "a.mtl").write_text("newmtl one\nKd 0 0 1")
    after = load_mesh(folder / "a.obj")
    assert [each.colour for each in after.materials[1:]] == [(0, 0, 255)]
    (folder / "a.mtl").unlink()
    (notice,) = load_mesh(folder / "a.obj").notices
    assert notice.endswith("a file of materials that cannot be read")


def test_the_extra_that_reads_other_files_is_named(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "trimesh", None)
    (folder / "a.stl").write_bytes(b"solid")
    with pytest.raises(FileError, match=r"needs trimesh, .*pip install 'minirt\[meshes\]'"):
        load_mesh(folder / "a.stl")
