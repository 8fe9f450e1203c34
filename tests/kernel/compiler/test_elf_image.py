"""Images of object code: they do what the object code does, and code that needs more than itself is refused."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.compiler import elf_image, object_code
from minirt.kernel.compiler.elf_image import image_of
from minirt.kernel.machine_code import loader
from minirt.kernel.machine_code.processor import is_linux_on_x86_64
from minirt.kernel.machine_code.signature import signature_of
from tests.kernel.machine_code.small_kernels import both, call, quotients, sine

pytestmark = pytest.mark.skipif(not is_linux_on_x86_64(), reason="images are for x86-64 Linux")


def compiled(function: Any, *arguments: Any) -> tuple[dict[str, Any], bytes]:
    """Return the names and the object code of a small kernel, which is no image."""
    name, values = call(function, *arguments)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(object_code, "is_linux_on_x86_64", lambda: False)
        return object_code.object_code(name, [signature_of(each) for each in values])


def test_an_image_does_what_the_object_code_does() -> None:
    names, code = compiled(quotients, np.zeros(1), np.zeros(1))
    image_names, image = image_of(code, names["entry"])
    results = []
    for each in ((names, code), (names | image_names, image)):
        x, y = np.arange(1.0, 6.0), np.array([3.0, 0.0, -7.0, 1e-300, np.inf])
        loader.load(*each)(x, y)
        results.append(y.tobytes())
    assert results[0] == results[1]
    assert len(image) < len(code)


def test_an_image_returns_integers_and_lives_as_long_as_its_entry() -> None:
    names, code = compiled(both, np.zeros(1), 1)
    image_names, image = image_of(code, names["entry"])
    entries = [loader.load(names | image_names, image) for _ in range(50)]
    assert {entry(np.zeros(7), 5) for entry in entries} == {(7, -5)}


def test_code_that_refers_to_a_library_is_refused() -> None:
    names, code = compiled(sine, np.zeros(1))
    with pytest.raises(ValueError, match="outside of the code"):
        image_of(code, names["entry"])


def kernel_with_a_constant() -> tuple[dict[str, Any], bytes]:
    """Return a kernel of the package, which has constants."""
    from minirt.kernel.machine_code import functions
    from minirt.rendering.needed_kernels import packing_calls

    name, values = next(each for each in packing_calls() if each[0] == functions.project_all.name)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(object_code, "is_linux_on_x86_64", lambda: False)
        return object_code.object_code(name, [signature_of(each) for each in values])


def test_other_relocations_and_other_files_are_refused() -> None:
    names, code = kernel_with_a_constant()
    image_of(code, names["entry"])
    sections = elf_image.read_sections(code)
    table = next(each for each in sections if each.kind == elf_image.RELOCATIONS)
    changed = bytearray(code)
    struct.pack_into("<I", changed, table.offset + 8, 2)  # relative to the place
    with pytest.raises(ValueError, match="a relocation of type 2"):
        image_of(bytes(changed), names["entry"])
    for other in (b"", b"\xcf\xfa\xed\xfe" + bytes(100), code[:4] + b"\x01" + code[5:]):
        with pytest.raises(ValueError, match="no ELF file"):
            image_of(other, names["entry"])


def test_a_system_that_allows_no_new_code_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    names, code = compiled(both, np.zeros(1), 1)
    image_names, image = image_of(code, names["entry"])
    monkeypatch.setattr(loader.mmap, "PROT_EXEC", -1)  # which no system knows
    with pytest.raises(RenderError, match=r"^the system does not let kernels run: "):
        loader.load(names | image_names, image)
