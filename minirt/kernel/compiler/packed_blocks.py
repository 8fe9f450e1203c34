"""Compiled reading of packed shapes from the blocks of BVH leaves: as many shapes side by side as there are lanes."""

from __future__ import annotations

from itertools import count
from typing import Any

from llvmlite import ir
from numba import types

from minirt.kernel import bvh_traversal, scene_arrays
from minirt.kernel.compiler.arrays_by_reference import register_by_reference
from minirt.kernel.compiler.packed_shapes import address_of_row, packed_of
from minirt.lanes.compiled.types import Lanes, VecType

INTEGER = ir.IntType(64)
LANES = Lanes(types.float64)
LANES_POINTER = ir.VectorType(ir.DoubleType(), LANES.count).as_pointer()


def packed_in_block(blocks: Any, number: Any) -> Any:
    """Return the type of a packed shape in a block, with components of type `number`: the NamedTuple of its kind."""
    fields = blocks.dtype.fields.values()
    numbers = [VecType(number) if len(each.type.shape) == 2 else number for each in fields]
    return types.NamedTuple(numbers, scene_arrays.kind_of(blocks.dtype.fields).packed)


def whole_block(blocks: Any, i: Any) -> Any:
    """Return the type of all shapes of a block, one a lane."""
    return packed_in_block(blocks, LANES)


def one_of_block(blocks: Any, block: Any, i: Any) -> Any:
    """Return the type of one shape of a block."""
    return packed_in_block(blocks, types.float64)


def _read_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = builder.bitcast(address_of_row(context, builder, sig, args), LANES_POINTER)
    numbers = (builder.load(builder.gep(first, [ir.Constant(INTEGER, i)]), align=8) for i in count())
    return packed_of(context, builder, sig.return_type, numbers)


def _read_one(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = builder.gep(address_of_row(context, builder, sig, args), [args[2]])
    numbers = (builder.load(builder.gep(first, [ir.Constant(INTEGER, LANES.count * i)])) for i in count())
    return packed_of(context, builder, sig.return_type, numbers)


register_by_reference(bvh_traversal.read_block, whole_block, _read_block)
register_by_reference(bvh_traversal.read_one, one_of_block, _read_one)
