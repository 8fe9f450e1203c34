"""Where the compiler is attached to the tree and to the rays that walk it."""

from __future__ import annotations

from itertools import count
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import register_jitable

from minirt.kernel import bvh, bvh_build, bvh_collapse, bvh_hits, rows, whitted
from minirt.kernel.jit import CACHE, INNER, first_number, own_functions
from minirt.kernel.jit_placed import teach_for_placed
from minirt.kernel.kept import compiled
from minirt.lanes import compiled_verbs, verbs
from minirt.lanes.teaching import teach
from minirt.lanes.vector import Lanes, Mask, VecType, constant, vec_of

WORD = ir.IntType(64)
LANES = Lanes(types.float64)
LANES_IR = ir.VectorType(ir.DoubleType(), LANES.count)
WORDS = ir.VectorType(WORD, LANES.count)
MEMORY = types.CPointer(types.float64)


@teach(bvh.packet_memory, lambda: MEMORY, [()])
def _packet_memory(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return cgutils.alloca_once(builder, ir.DoubleType(), size=bvh.MEMORY)


@teach(whitted.path_memory, lambda: MEMORY, [()])
def _path_memory(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return cgutils.alloca_once(builder, ir.DoubleType(), size=whitted.MEMORY)


def lanes_place(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Where in a memory the lanes from an index on are."""
    place = builder.gep(args[0], [context.cast(builder, args[1], sig.args[1], types.intp)])
    return builder.bitcast(place, LANES_IR.as_pointer())


@teach(verbs.load, lambda memory, at: LANES if memory == MEMORY else None, [(types.CPointer, types.Integer)])
def _load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.load(lanes_place(context, builder, sig, args), align=8)


@teach(bvh.put, lambda memory, at, x: types.none, [(types.CPointer, types.Integer, Lanes)])
def _put(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    builder.store(args[2], lanes_place(context, builder, sig, args), align=8)
    return context.get_dummy_value()


@teach(bvh.tag, lambda distance, names: LANES, [(Lanes, Lanes)])
def _tag(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    distance, names = (builder.bitcast(each, WORDS) for each in args)
    kept = builder.and_(distance, constant(distance, ~bvh.NAME))
    return builder.bitcast(builder.or_(kept, names), LANES_IR)


@teach(bvh.name_of, lambda tagged: types.int64 if tagged == types.float64 else None, [(types.Float,)])
def _name_of(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.sext(builder.trunc(builder.bitcast(args[0], WORD), ir.IntType(32)), WORD)


@teach(bvh.bits, lambda mask: types.int64, [(Mask,)])
def _bits(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.zext(compiled_verbs.bits(builder, args[0]), WORD)


@teach(bvh.lowest, lambda number: types.int64 if number == types.int64 else None, [(types.Integer,)])
def _lowest(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))


def packed_lanes(blocks: Any, i: Any) -> Any:
    """The type of a block: the kind's NamedTuple of lanes and of Vecs of them."""
    if not isinstance(blocks, types.Array):
        return None
    fields = blocks.dtype.fields.values()
    numbers = [VecType(LANES) if len(each.type.shape) == 2 else LANES for each in fields]
    return types.NamedTuple(numbers, rows.kind_of(blocks.dtype.fields).packed)


@teach(bvh_hits.read_block, packed_lanes, [(types.Array, types.Integer)])
def _read_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = builder.bitcast(first_number(context, builder, sig, args), LANES_IR.as_pointer())
    numbers = (builder.load(builder.gep(first, [ir.Constant(WORD, i)]), align=8) for i in count())
    parts = [
        vec_of(context, builder, kind, [next(numbers) for _ in "xyz"]) if isinstance(kind, VecType) else next(numbers)
        for kind in sig.return_type.types
    ]
    return context.make_tuple(builder, sig.return_type, parts)


teach_for_placed(bvh_hits.read_block, packed_lanes, _read_block)

TAUGHT = (bvh.packet_memory, bvh.put, bvh.tag, bvh.name_of, bvh.bits, bvh.lowest, bvh_hits.read_block)
ENTRIES = (bvh_hits.trace_rays, bvh_build.divide, bvh_collapse.weigh, bvh_collapse.collapse)
for _module in (bvh, bvh_build, bvh_collapse, bvh_hits):
    for _function in own_functions(_module):
        if _function not in (*TAUGHT, *ENTRIES):
            register_jitable(**INNER)(_function)

# With the types said at once, what builds trees is compiled when this module is imported.
NUMBER, WHOLE = types.float64, types.int64
TABLE, LINKS = NUMBER[:, ::1], WHOLE[:, ::1]
BINARY = types.NamedTuple([TABLE, TABLE, LINKS, TABLE, NUMBER[::1], NUMBER[::1], LINKS], bvh_build.Binary)
DIVIDE = WHOLE(BINARY)
WEIGH = types.void(BINARY, TABLE, LINKS)
COLLAPSE = types.UniTuple(WHOLE, 2)(BINARY, LINKS, NUMBER[::1], WHOLE[::1], LINKS, LINKS)


divide = compiled(bvh_build.divide, CACHE, DIVIDE)
weigh = compiled(bvh_collapse.weigh, CACHE, WEIGH)
collapse = compiled(bvh_collapse.collapse, CACHE, COLLAPSE)
trace_rays = compiled(bvh_hits.trace_rays, CACHE)
