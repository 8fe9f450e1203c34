"""The notebook among the assets shows what its text promises; long work shows a bar and can be interrupted."""

from __future__ import annotations

import io
import queue
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import minirt
from tests.paths import ROOT
from tests.skipping import require
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


# Long work: a bar below the cell, and an interruption that leaves the library usable.

SETUP = "import minirt; scene = minirt.example('demo')"
LONG = {
    "one picture": "minirt.render(scene, 4000, 3000, samples=4096)",
    "until an error": "minirt.render(scene, 2000, 1500, samples='auto', error=1e-7)",
    "a film": "minirt.save_movie((minirt.render(scene, 400, 300, samples=4096) for _ in range(10)), 'a.gif')",
}
FIRST_WORDS = {"one picture": "picture", "until an error": "sampling", "a film": "picture"}


@pytest.fixture(scope="module")
def kernel() -> Iterator[Any]:
    """Fixture: the manager of a kernel, and its client."""
    require("ipykernel", "jupyter_client")
    from jupyter_client.manager import start_new_kernel

    manager, client = start_new_kernel(startup_timeout=HANG_LIMIT)
    try:
        execute(client, SETUP)
        yield manager, client
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)


def outputs(client: Any, request: str) -> Iterator[Any]:
    """Yield what the kernel publishes about a cell, until the cell has ended."""
    while True:
        try:
            message = client.get_iopub_msg(timeout=HANG_LIMIT)
        except queue.Empty:
            raise TimeoutError("the kernel is silent") from None
        if message["parent_header"].get("msg_id") == request:
            if message["msg_type"] == "status" and message["content"]["execution_state"] == "idle":
                return
            yield message["msg_type"], message["content"]


def execute(client: Any, source: str) -> list[Any]:
    """Run a cell to its end, and return what it has published."""
    return [each for each in outputs(client, client.execute(source)) if each[0] not in ("status", "execute_input")]


@pytest.mark.parametrize("work", LONG)
def test_long_work_shows_a_bar_and_can_be_interrupted(kernel: Any, work: str) -> None:
    manager, client = kernel
    seen = []
    for sort, content in outputs(client, client.execute(LONG[work])):
        if sort == "display_data":
            manager.interrupt_kernel()
        if sort not in ("status", "execute_input"):
            seen.append((sort, content))
    (_, bar), *_, (erasing, last), (error, reason) = seen
    assert FIRST_WORDS[work] in bar["data"]["text/plain"]
    assert (erasing, last["data"]) == ("update_display_data", {"text/html": ""})
    assert last["transient"] == bar["transient"]  # the same output of the cell
    assert (error, reason["ename"]) == ("error", "KeyboardInterrupt")
    assert sum(sort == "display_data" for sort, _ in seen) == 1

    ((sort, result),) = execute(client, "minirt.render(scene, 32, 18)")
    assert (sort, "image/png" in result["data"]) == ("execute_result", True)


@pytest.mark.each_python
def test_short_work_shows_nothing(kernel: Any) -> None:
    assert execute(kernel[1], "short = minirt.render(scene, 32, 18)") == []
