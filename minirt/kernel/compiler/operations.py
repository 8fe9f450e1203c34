"""Compiled operations of kernels: reading packed shapes, the memory of BVH traversal, and pixels."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from minirt.kernel import beams, bvh_nodes, bvh_rays, bvh_single_rays, scene_arrays
from minirt.kernel.compiler.by_reference import length
from minirt.kernel.pixels import OPAQUE, PACKET_HEIGHT, fetch_add, store_block
from minirt.kernel.shading import whitted
from minirt.lanes.compiled.memory import address, array_of, first_of, reduced
from minirt.lanes.compiled.types import Lanes, Mask, VecType, common, constant, register, splat, vec_of

PIXEL = ir.IntType(32)
INTEGER = ir.IntType(64)
LANES = Lanes(types.float64)
LANES_IR = ir.VectorType(ir.DoubleType(), LANES.count)
CACHE_LINE = 64  # bytes; aligned to it, no load of lanes touches two lines

# Packed shapes: rows of record arrays, or, side by side, blocks of BVH leaves. The numbers of a row lie one after the
# other; a block has as many shapes as there are lanes, and the numbers of one lie that far apart.


def packed_type(array: Any, number: Any, dimensions: int) -> Any:
    """Return the NamedTuple of a kind for its record array: fields of so many dimensions are Vecs of such numbers."""
    fields = array_of(array).dtype.fields  # type: ignore[union-attr]
    is_vec = [len(getattr(each.type, "shape", ())) == dimensions for each in fields.values()]
    return types.NamedTuple(
        [VecType(number) if each else number for each in is_vec], scene_arrays.kind_of(fields).packed
    )


def row_type(array: Any, i: Any) -> Any:
    """Return the type of the packed shape in a row; the numbers in all fields of a row are of one type."""
    kind = next(iter(array_of(array).dtype.fields.values())).type  # type: ignore[union-attr]
    return packed_type(array, common(getattr(kind, "dtype", kind)), 1)


def load_packed(context: Any, builder: ir.IRBuilder, kind: Any, first: Any, stride: int = 1, align: Any = None) -> Any:
    """Return the packed shape of a type, made of the numbers from an address on."""
    numbers = (builder.load(builder.gep(first, [ir.Constant(INTEGER, stride * i)]), align=align) for i in count())
    parts = [
        vec_of(context, builder, each, [next(numbers) for _ in "xyz"]) if isinstance(each, VecType) else next(numbers)
        for each in kind.types
    ]
    return context.make_tuple(builder, kind, parts)


@register(scene_arrays.read, row_type)
def _read(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = sig.return_type[0]
    number = context.get_value_type(getattr(first, "number", first))
    return load_packed(context, builder, sig.return_type, address(context, builder, sig.args, args, number))


@register(scene_arrays.read_block, lambda blocks, i: packed_type(blocks, LANES, 2))
def _read_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = address(context, builder, sig.args, args, LANES_IR)
    return load_packed(context, builder, sig.return_type, first, align=8)


@register(scene_arrays.read_one, lambda blocks, i, lane: packed_type(blocks, types.float64, 2))
def _read_one(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = builder.gep(address(context, builder, sig.args, args, ir.DoubleType()), [args[2]])
    return load_packed(context, builder, sig.return_type, first, LANES.count)


@register(scene_arrays.numbers_at, lambda *_: types.Tuple([*map(types.CPointer, (types.float64, types.float32))]))
def _numbers_at(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    parts = [
        builder.inttoptr(each, context.get_value_type(kind)) for each, kind in zip(args, sig.return_type, strict=True)
    ]
    return context.make_tuple(builder, sig.return_type, parts)


# BVH traversal: memory on the stack.


def register_memory(function: Callable[..., Any], number: types.Type, size: int) -> None:
    """Register the allocation of so many numbers."""

    @register(function, lambda: types.CPointer(number))
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        memory = cgutils.alloca_once(builder, context.get_value_type(number), size=size)
        memory.align = CACHE_LINE
        return memory


register_memory(bvh_nodes.packet_memory, types.float64, bvh_nodes.MEMORY)
register_memory(beams.beam_memory, types.float32, beams.MEMORY)
register_memory(bvh_rays.ray_numbers, types.float32, bvh_rays.NUMBERS)
register_memory(bvh_rays.ray_integers, types.int64, bvh_rays.INTEGERS)
register_memory(whitted.ray_stack, types.float64, whitted.STACK_SIZE)


@register(bvh_single_rays.mask_of, lambda pending: Mask(LANES))
def _mask_of(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.bitcast(builder.trunc(args[0], ir.IntType(LANES.count)), sig.return_type.llvm)


@register(bvh_single_rays.least_lane, lambda x: x.number if isinstance(x, Lanes) else None)
def _least_lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return reduced(builder, "fmin", args[0])


# The frame loop: take the next row of tiles, store a packet of pixels.


@register(fetch_add, lambda counter, amount: types.int64)
def _fetch_add(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    counter = first_of(context, builder, sig.args[0], args[0])
    return builder.atomic_rmw("add", counter, context.cast(builder, args[1], sig.args[1], types.int64), "monotonic")


def no_result(pixels: Any, x: Any, y: Any, *levels: Any) -> Any:
    """Return the type of no result, for three colour levels on lanes; None for other arguments."""
    return types.none if all(isinstance(each, Lanes) for each in levels) else None


@register(store_block, no_result)
def _store_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Emit the stores of a packet, one for each row; `args` are pixels, x, y, and levels of red, green and blue."""
    pixels = first_of(context, builder, sig.args[0], args[0])
    x, y = (context.cast(builder, args[i], sig.args[i], types.intp) for i in (1, 2))
    width = length(context, builder, sig.args[0], args[0], 1)
    count = sig.args[3].count
    step = count // PACKET_HEIGHT
    words = splat(builder, ir.Constant(PIXEL, OPAQUE), count)
    for level, shift in zip(args[3:], (16, 8, 0), strict=True):  # to 0xAARRGGBB
        byte = builder.fptosi(level, words.type)
        words = builder.or_(words, builder.shl(byte, constant(words, shift)))
    for line in range(PACKET_HEIGHT):
        lanes = [ir.Constant(PIXEL, line * step + i) for i in range(step)]
        part = builder.shuffle_vector(words, words, ir.Constant(ir.VectorType(PIXEL, step), lanes))
        row = builder.mul(builder.add(y, ir.Constant(y.type, line)), width)
        place = builder.gep(pixels, [builder.add(row, x)])
        builder.store(part, builder.bitcast(place, part.type.as_pointer()), align=4)
    return context.get_dummy_value()
