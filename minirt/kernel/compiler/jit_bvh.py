"""Where the compiler is attached to the tree and to the rays that walk it."""

from __future__ import annotations

from itertools import count
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import register_jitable

from minirt.kernel import rows
from minirt.kernel.bvh import build, collapse, nodes, queries, traversal
from minirt.kernel.compiler.by_reference import teach_for_placed
from minirt.kernel.compiler.code_cache import compiled
from minirt.kernel.compiler.jit import CACHE, INNER, first_number, own_functions, packed_of
from minirt.kernel.shading import whitted
from minirt.lanes import operations
from minirt.lanes.compiled import reductions
from minirt.lanes.compiled.registration import register
from minirt.lanes.compiled.types import Lanes, Mask, VecType, constant

WORD = ir.IntType(64)
LANES = Lanes(types.float64)
LANES_IR = ir.VectorType(ir.DoubleType(), LANES.count)
WORDS = ir.VectorType(WORD, LANES.count)
MEMORY = types.CPointer(types.float64)
LINE = 64  # bytes of a line of the cache: no load of lanes needs two


@register(nodes.packet_memory, lambda: MEMORY, [()])
def _packet_memory(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    memory = cgutils.alloca_once(builder, ir.DoubleType(), size=nodes.MEMORY)
    memory.align = LINE
    return memory


@register(whitted.ray_stack, lambda: MEMORY, [()])
def _path_memory(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return cgutils.alloca_once(builder, ir.DoubleType(), size=whitted.STACK_SIZE)


def lanes_place(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Where in a memory the lanes from an index on are."""
    place = builder.gep(args[0], [context.cast(builder, args[1], sig.args[1], types.intp)])
    return builder.bitcast(place, LANES_IR.as_pointer())


@register(operations.load, lambda memory, at: LANES if memory == MEMORY else None, [(types.CPointer, types.Integer)])
def _load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.load(lanes_place(context, builder, sig, args), align=8)


@register(nodes.put, lambda memory, at, x: types.none, [(types.CPointer, types.Integer, Lanes)])
def _put(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    builder.store(args[2], lanes_place(context, builder, sig, args), align=8)
    return context.get_dummy_value()


@register(nodes.tag, lambda distance, names: LANES, [(Lanes, Lanes)])
def _tag(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    distance, names = (builder.bitcast(each, WORDS) for each in args)
    kept = builder.and_(distance, constant(distance, ~nodes.REFERENCE_BITS))
    return builder.bitcast(builder.or_(kept, names), LANES_IR)


@register(nodes.reference_of, lambda tagged: types.int64 if tagged == types.float64 else None, [(types.Float,)])
def _name_of(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.sext(builder.trunc(builder.bitcast(args[0], WORD), ir.IntType(32)), WORD)


@register(nodes.bits, lambda mask: types.int64, [(Mask,)])
def _bits(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.zext(reductions.bits(builder, args[0]), WORD)


@register(nodes.least_lane, lambda x: types.float64, [(Lanes,)])
def _least(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    kind = ir.FunctionType(WORD, [WORDS])
    name = f"llvm.vector.reduce.smin.v{LANES.count}i64"
    found = builder.call(cgutils.get_or_insert_function(builder.module, kind, name), [builder.bitcast(args[0], WORDS)])
    return builder.bitcast(found, ir.DoubleType())


def word_place(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """Where in a memory the whole number at an index is."""
    place = builder.gep(args[0], [context.cast(builder, args[1], sig.args[1], types.intp)])
    return builder.bitcast(place, WORD.as_pointer())


@register(nodes.integer_at, lambda memory, at: types.int64, [(types.CPointer, types.Integer)])
def _whole_at(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.load(word_place(context, builder, sig, args))


@register(nodes.put_integer, lambda memory, at, n: types.none, [(types.CPointer, types.Integer, types.Integer)])
def _put_whole(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    builder.store(context.cast(builder, args[2], sig.args[2], types.int64), word_place(context, builder, sig, args))
    return context.get_dummy_value()


def packed_in(blocks: Any, number: Any) -> Any:
    """The type of what is in a block: the kind's NamedTuple of numbers of a type, and of Vecs of them."""
    fields = blocks.dtype.fields.values()
    numbers = [VecType(number) if len(each.type.shape) == 2 else number for each in fields]
    return types.NamedTuple(numbers, rows.kind_of(blocks.dtype.fields).packed)


def packed_block(blocks: Any, i: Any) -> Any:
    """The type of all shapes of a block, side by side."""
    return packed_in(blocks, LANES)


def packed_one(blocks: Any, block: Any, i: Any) -> Any:
    """The type of one of them."""
    return packed_in(blocks, types.float64)


def _read_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = builder.bitcast(first_number(context, builder, sig, args), LANES_IR.as_pointer())
    numbers = (builder.load(builder.gep(first, [ir.Constant(WORD, i)]), align=8) for i in count())
    return packed_of(context, builder, sig.return_type, numbers)


def _read_one(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    first = builder.gep(first_number(context, builder, sig, args), [args[2]])
    numbers = (builder.load(builder.gep(first, [ir.Constant(WORD, LANES.count * i)])) for i in count())
    return packed_of(context, builder, sig.return_type, numbers)


teach_for_placed(queries.read_block, packed_block, _read_block)
teach_for_placed(queries.read_one, packed_one, _read_one)

TAUGHT = (
    nodes.packet_memory,
    nodes.put,
    nodes.integer_at,
    nodes.put_integer,
    nodes.tag,
    nodes.reference_of,
    nodes.bits,
    nodes.least_lane,
    queries.read_block,
    queries.read_one,
)
ENTRIES = (queries.trace_rays, build.divide, collapse.weigh, collapse.collapse)
for _module in (nodes, traversal, build, collapse, queries):
    for _function in own_functions(_module):
        if _function not in (*TAUGHT, *ENTRIES):
            register_jitable(**INNER)(_function)

# With the types said at once, what builds trees is compiled when this module is imported.
NUMBER, WHOLE = types.float64, types.int64
TABLE, LINKS = NUMBER[:, ::1], WHOLE[:, ::1]
BINARY = types.NamedTuple([TABLE, TABLE, LINKS, TABLE, NUMBER[::1], NUMBER[::1], LINKS], build.BinaryTree)
DIVIDE = WHOLE(BINARY)
WEIGH = types.void(BINARY, TABLE, LINKS)
COLLAPSE = types.UniTuple(WHOLE, 2)(BINARY, LINKS, NUMBER[::1], WHOLE[::1], LINKS, LINKS)


divide = compiled(build.divide, CACHE, DIVIDE)
weigh = compiled(collapse.weigh, CACHE, WEIGH)
collapse = compiled(collapse.collapse, CACHE, COLLAPSE)
trace_rays = compiled(queries.trace_rays, CACHE)
