"""numba's types of a kernel's arguments, from their signatures."""

from __future__ import annotations

from typing import Any

from numba import from_dtype, types

from minirt.kernel.machine_code.signature import Signature, dtype_of, tuple_class

SCALARS = {"int": types.int64, "float": types.float64}


def type_of(signature: Signature) -> Any:
    """Return the type of an argument."""
    if signature is None:
        return types.none
    if isinstance(signature, str):
        return SCALARS[signature]
    if "array" in signature:
        return types.Array(from_dtype(dtype_of(signature)), signature["ndim"], "C")
    kind = tuple_class(signature)
    items = [type_of(each) for each in signature["items"]]
    return types.BaseTuple.from_types(items, None if kind is tuple else kind)
