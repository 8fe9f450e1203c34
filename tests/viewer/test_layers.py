"""Layers of the viewer: each folder imports only itself and the folders below it."""

from __future__ import annotations

import re

import pytest

from tests.paths import PACKAGE

LAYERS = ("bindings", "key_repeat", "files", "recovery", "editing", "display", "app")  # lowest first
IMPORT = re.compile(r"^\s*(?:from|import) minirt\.viewer\.(\w+)", re.MULTILINE)


@pytest.mark.parametrize("layer", LAYERS)
def test_a_layer_imports_only_lower_layers(layer: str) -> None:
    allowed = set(LAYERS[: LAYERS.index(layer) + 1])
    files = [*sorted((PACKAGE / "viewer" / layer).rglob("*.py")), *(PACKAGE / "viewer").glob(f"{layer}.py")]
    upward = {file.name: set(IMPORT.findall(file.read_text(encoding="utf-8"))) - allowed for file in files}
    assert {name for name, layers in upward.items() if layers} == set()


def test_everything_is_in_a_layer() -> None:
    found = {
        path.stem for path in (PACKAGE / "viewer").iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert found - {"__init__"} == set(LAYERS)
