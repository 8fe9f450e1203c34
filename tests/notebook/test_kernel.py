"""Long work in the kernel of a notebook: a bar below the cell, and an interruption that leaves the library usable."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from typing import Any

import pytest

from tests.notebook.requirements import require
from tests.waiting import HANG_LIMIT

pytestmark = pytest.mark.slow
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
