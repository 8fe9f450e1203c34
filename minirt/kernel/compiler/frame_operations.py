"""Compiled operations of the frame loop: take the next row of tiles, store a packet of pixels."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types

from minirt.kernel.compiler.arrays_by_reference import data, length
from minirt.kernel.compiler.by_reference import Reference
from minirt.kernel.pixels import OPAQUE, PACKET_HEIGHT, fetch_add, store_block
from minirt.lanes.compiled.types import Lanes, constant, register, splat

PIXEL = ir.IntType(32)


@register(fetch_add, lambda counter, amount: types.int64, [(types.Array, types.Integer)])
def _fetch_add(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    counter = context.make_array(sig.args[0])(context, builder, value=args[0])
    amount = context.cast(builder, args[1], sig.args[1], types.int64)
    return builder.atomic_rmw("add", counter.data, amount, "monotonic")


def no_result(pixels: Any, x: Any, y: Any, *levels: Any) -> Any:
    """Return the type of no result, for three colour levels on lanes; None for other arguments."""
    return types.none if all(isinstance(each, Lanes) for each in levels) else None


@register(store_block, no_result, [(Reference, types.Integer, types.Integer, Lanes, Lanes, Lanes)])
def _store_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    pixels = data(context, builder, sig.args[0], args[0])
    x, y = (context.cast(builder, args[i], sig.args[i], types.intp) for i in (1, 2))
    width = length(context, builder, sig.args[0], args[0], 1)
    count = sig.args[3].count
    step = count // PACKET_HEIGHT
    words = splat(builder, ir.Constant(PIXEL, OPAQUE), count)
    for level, shift in zip(args[3:], (16, 8, 0), strict=True):
        byte = builder.fptosi(level, words.type)
        words = builder.or_(words, builder.shl(byte, constant(words, shift)))
    for line in range(PACKET_HEIGHT):
        lanes = [ir.Constant(PIXEL, line * step + i) for i in range(step)]
        part = builder.shuffle_vector(words, words, ir.Constant(ir.VectorType(PIXEL, step), lanes))
        row = builder.mul(builder.add(y, ir.Constant(y.type, line)), width)
        place = builder.gep(pixels, [builder.add(row, x)])
        builder.store(part, builder.bitcast(place, part.type.as_pointer()), align=4)
    return context.get_dummy_value()
