"""The notebook among the assets runs in a kernel, and shows what its text promises."""

from __future__ import annotations

import io
from base64 import b64decode
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import minirt
from tests.notebook.requirements import require
from tests.paths import ROOT
from tests.waiting import HANG_LIMIT

pytestmark = pytest.mark.slow
NOTEBOOK = ROOT / "assets" / "notebook.ipynb"
ERASED = {"text/html": ""}
WIDGET = "application/vnd.jupyter.widget-view+json"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("notebook")


@pytest.fixture(scope="module")
def results(folder: Path) -> dict[str, list[Any]]:
    """Fixture: the outputs of the cells by the names of these, of the notebook run in an empty folder.

    An erased bar, which a slow machine leaves, is no output."""
    require("nbclient", "ipykernel", "anywidget")
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    NotebookClient(notebook, timeout=int(HANG_LIMIT), resources={"metadata": {"path": str(folder)}}).execute()
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    return {cell.id: [each for each in cell.outputs if each.get("data") != ERASED] for cell in cells}


def pixels(data: str) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(b64decode(data))).convert("RGB")).astype(int)


def test_it_is_kept_without_outputs() -> None:
    assert '"outputs": []' in NOTEBOOK.read_text()
    assert '"output_type"' not in NOTEBOOK.read_text()


def test_a_picture_is_shown_with_a_short_text(results: dict[str, list[Any]]) -> None:
    (output,) = results["one"]
    shown = pixels(output.data["image/png"])
    assert shown.shape == (270, 480, 3)
    assert output.data["text/plain"] == "<Image of 480x270 pixels, with linear light>"
    red, blue = shown[120:150, 310:330], shown[120:150, 150:170]  # seen along z, -x is on the right
    assert (red[..., 0] > red[..., 2] + 30).all()
    assert (blue[..., 2] > blue[..., 0] + 30).all()


def test_pictures_of_several_values_are_one_row(results: dict[str, list[Any]]) -> None:
    (output,) = results["two"]
    shown = pixels(output.data["image/png"])
    assert shown.shape == (135, 4 * 240, 3)
    assert all((shown[:, 240 * n : 240 * n + 240] != shown[:, :240]).any() for n in range(1, 4))


def test_numbers_are_those_of_geometry(results: dict[str, list[Any]]) -> None:
    (output,) = results["three"]
    share, ray = output.text.strip().splitlines()
    nearest = (1.6**2 + 1.2**2 + 9**2) ** 0.5 - 1  # from the eye to the centre, less the radius
    told = float(share.split()[-3])
    assert nearest - 0.0005 <= told < nearest + 0.01
    assert 2 < float(share.partition("%")[0]) < 10
    assert ray == "a ray at its centre meets it after 8.000000000000"


def test_a_film_plays_below_its_cell(results: dict[str, list[Any]], folder: Path) -> None:
    (output,) = results["four"]
    head, _, rest = output.data["text/html"].partition(";base64,")
    assert head == '<img alt="bounce.webp" src="data:image/webp'
    assert b64decode(rest.partition('"')[0]) == (folder / "bounce.webp").read_bytes()
    with Image.open(folder / "bounce.webp") as film:
        assert (film.n_frames, film.size) == (20, (240, 135))


def test_the_viewer_is_a_widget_with_the_scene_that_was_assigned(results: dict[str, list[Any]], folder: Path) -> None:
    (output,) = results["five"]
    assert WIDGET in output.data
    assert output.data["text/plain"] == "<Viewer of 640x360 pixels: `.scene` is the scene as edited>"
    assert minirt.load(folder / "edited.rt").spheres[0].diameter == 3
