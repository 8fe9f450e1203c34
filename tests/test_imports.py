"""The direction of imports, read from the sources: which part of the program may import which, and no circles."""

from __future__ import annotations

import ast
import sys
from collections import Counter
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

from minirt import load, renderer
from tests.cli.program import SCENE, environment
from tests.paths import PACKAGE
from tests.processes import run

LOW = {"errors", "records", "fields", "element", "lanes", "materials", "shapes"}

# For each part what it may import of ours. A part is a folder or a file of the package.
MAY: dict[str, set[str]] = {
    "errors": set(),
    "helpers": {"errors"},
    "lanes": set(),
    "records": {"errors"},
    "fields": {"errors", "records"},
    "element": {"errors", "records", "fields"},
    "materials": {"errors", "records", "fields", "element", "helpers", "formats"},
    "machine_code": {"errors", "helpers"},
    "meshes": {"errors", "lanes", "machine_code", "records", "fields", "element", "helpers", "materials"},
    "shapes": {"lanes", "records", "fields", "element", "materials", "meshes"},
    "formats": {"errors", "helpers"},
    "scene": LOW - {"lanes"} | {"meshes", "helpers", "formats", "kernel", "machine_code"},
    "kernel": {"errors", "lanes", "shapes", "helpers", "machine_code"},
    "rendering": LOW | {"helpers", "formats", "kernel", "machine_code", "meshes", "scene"},
    "cluster": LOW - {"lanes", "shapes", "materials", "records", "fields"}
    | {"__init__", "helpers", "formats", "kernel", "machine_code", "meshes", "rendering", "scene"},
    "movie": {"errors", "helpers", "rendering", "formats"},
    "mlx": {"errors", "formats", "helpers"},
    "viewer": LOW - {"lanes", "records"} | {"helpers", "meshes", "mlx", "movie", "rendering", "scene"},
    "notebook": {"helpers", "errors", "scene", "mlx", "rendering", "viewer"},
    "report": LOW | {"__init__", "helpers", "kernel", "machine_code", "rendering", "scene"},
    "compare": {"errors", "element", "helpers", "materials", "rendering", "scene", "shapes"},
    "cli": {"__init__", "cluster", "compare", "errors", "formats", "helpers", "movie"}
    | {"rendering", "report", "scene", "viewer"},
    "__main__": {"cli", "helpers"},
    "__init__": LOW | {"helpers", "scene", "rendering"},
}
# Names that two classes still have; none may be added.
COMPILER = {"numba", "llvmlite"}
COMPILED = {"lanes/compiled", "kernel/compiler"}  # the only folders that import the compiler, in a process of its own
LOADER = "kernel/machine_code/library.py"  # imports, late, the part of it that loads machine code
HEAVY = ("rendering", "viewer", "kernel", "mlx", "report", "compare")
LATE = {"numba", "llvmlite", "pyglet", "PIL", *(f"minirt.{part}" for part in HEAVY)}


@cache
def imports(source: str, late: bool = True, annotations: bool = False) -> set[str]:
    """The modules that a source imports at run time.

    `late`: also those that are imported inside functions. `annotations`: also those for annotations alone.
    """
    found: set[str] = set()

    def visit(node: ast.AST) -> None:
        if isinstance(node, ast.Import):
            found.update(each.name for each in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative import"
            found.update(f"{node.module}.{each.name}" for each in node.names)
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in ("import_module", "__import__"):
            found.update(each.value for each in node.args if isinstance(each, ast.Constant))
        typing = not annotations and isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        if typing or (not late and isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))):
            return
        for child in ast.iter_child_nodes(node):
            visit(child)

    visit(ast.parse(source))
    return found


def part_of(module: str) -> str:
    """The part of the program to which a module belongs: `minirt.scene.parser.load` to `scene`."""
    if module.startswith("minirt.kernel.machine_code"):
        return "machine_code"  # which calls kernels that others bring
    name = module.split(".")[1] if "." in module else "__init__"
    return name if (PACKAGE / name).is_dir() or (PACKAGE / f"{name}.py").is_file() else "__init__"


@cache
def sources() -> dict[str, str]:
    """Every source of the package, by its path."""
    paths = sorted(PACKAGE.rglob("*.py"))
    return {path.relative_to(PACKAGE).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def test_imports_go_one_way() -> None:
    seen = set()
    for path, source in sources().items():
        part = part_of(module_of(path)) if "/" in path else path.removesuffix(".py")
        seen.add(part)
        ours = {part_of(module) for module in imports(source) if module.split(".")[0] == "minirt"}
        assert not ours - MAY[part] - {part}, path
    assert seen == set(MAY)


def importers(files: dict[str, str], wanted: set[str], late: bool = True) -> dict[str, set[str]]:
    """The files that import some modules or parts of them, with those modules."""
    found = {
        path: {each for each in wanted if any(f"{name}.".startswith(f"{each}.") for name in imports(source, late=late))}
        for path, source in files.items()
    }
    return {path: modules for path, modules in found.items() if modules}


def test_the_compiler_is_imported_where_it_is_attached_and_nowhere_else() -> None:
    found = importers(sources(), COMPILER)
    assert found.pop(LOADER) == {"llvmlite"}
    assert {path.rpartition("/")[0] for path in found} == COMPILED
    assert LOADER not in importers(sources(), COMPILER, late=False)
    found = importers(sources(), {"minirt.kernel.compiler", "minirt.lanes.compiled"})
    assert {path.rpartition("/")[0] for path in found} == COMPILED


def imported(*command: str, folder: Path) -> set[str]:
    """The modules that a run of Python imports."""
    ended = run([sys.executable, "-X", "importtime", *command], cwd=folder, env=environment(), text=True)
    assert ended.returncode == 0, ended.stderr
    return {line.rpartition("|")[2].strip() for line in ended.stderr.splitlines() if line.startswith("import time:")}


def test_a_picture_whose_kernels_are_on_disk_is_rendered_without_the_compiler(tmp_path: Path) -> None:
    (tmp_path / "ball.rt").write_text(SCENE)
    scene = load(tmp_path / "ball.rt")
    renderer(None).prepare(scene)
    for command in (
        ("-m", "minirt", "ball.rt", "-o", "ball.png", "--size", "40x30"),
        ("-c", "import minirt; minirt.render(minirt.load('ball.rt'), 40, 30)"),
    ):
        found = imported(*command, folder=tmp_path)
        assert {"minirt", "numpy"} <= found
        assert "numba" not in found
    assert (tmp_path / "ball.png").stat().st_size
    assert "numba" in imported("-c", "import minirt.kernel.compiler.pipeline", folder=tmp_path)


def test_checking_a_scene_imports_no_renderer(tmp_path: Path) -> None:
    (tmp_path / "ball.rt").write_text(SCENE)
    found = imported("-m", "minirt", "ball.rt", "--check", folder=tmp_path)
    assert "minirt.rendering.notices" in found
    slow = "minirt.rendering.renderer", "minirt.rendering.scene_packing", "minirt.kernel.machine_code", "numpy.ma"
    assert not found.intersection(slow)


def graph(files: dict[str, str]) -> dict[str, set[str]]:
    """For each module of the package the modules of the package that it imports, at any time and for annotations too.

    A package of modules counts as its `__init__`. The public module `minirt` itself is left out: it imports lazily.
    """
    modules = {module_of(path): source for path, source in files.items() if path != "__init__.py"}
    found: dict[str, set[str]] = {}
    for module, source in modules.items():
        wanted = imports(source, annotations=True)
        exact = {name if name in modules else name.rpartition(".")[0] for name in wanted}
        found[module] = (exact & set(modules)) - {module}
    return found


def module_of(path: str) -> str:
    """The module in a file of the package: `minirt.scene` for `scene/__init__.py`."""
    return "minirt." + path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def test_parts_and_modules_import_each_other_in_no_circle() -> None:
    for edges in (MAY, graph(sources())):
        assert [*TopologicalSorter(edges).static_order()]  # CycleError names a circle


def classes(files: dict[str, str]) -> Counter[str]:
    """How many classes have each name."""
    trees = map(ast.parse, files.values())
    return Counter(node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef))


def test_each_class_has_a_name_of_its_own() -> None:
    counts = classes(sources())
    assert [name for name, count in counts.items() if count > 1] == []
    assert classes({"a.py": "class Line: ...", "b.py": "if x:\n    class Line: ..."})["Line"] == 2


def test_heavy_imports_are_late() -> None:
    light = {path: source for path, source in sources().items() if path.startswith(("__init__.py", "cli/"))}
    del light["cli/render.py"]  # which is imported late
    assert importers(light, LATE, late=False) == {}
