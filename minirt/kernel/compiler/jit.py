"""Where the compiler is attached: everything else in this package is plain Python.

Functions call each other as they stand; numba finds the compiled form of each through `register_jitable` and chooses
formulas by the types of shapes, so what is compiled holds just the kinds of shapes that a scene has.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import lru_cache
from importlib import import_module
from itertools import count
from types import FunctionType, ModuleType
from typing import Any, TypeAlias

import numpy as np
from llvmlite import ir
from numba import typeof, types
from numba.extending import overload, register_jitable

import minirt.lanes.compiled  # noqa: F401  (teaches numba the verbs of the formulas)
from minirt.kernel import atomic_counter, frame, rows, trace
from minirt.kernel.compiler import cache_folder
from minirt.kernel.compiler.by_reference import Placed, data, length, teach_for_placed
from minirt.kernel.compiler.code_cache import compiled
from minirt.kernel.compiler.lean_pipeline import Inlined
from minirt.kernel.culling import light_buffer
from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading import environment, lights, shade, specular, surfaces, texture_lookup, texturing, whitted
from minirt.lanes import angle, largest, power, vec
from minirt.lanes.compiled.registration import register
from minirt.lanes.compiled.types import Lanes, VecType, common, constant, splat, vec_of
from minirt.shapes import ALL_KINDS, Kind, basis, compensated, pyramid, quadric, shape, uv_mapping

Arguments: TypeAlias = tuple[Any, ...]  # of `minirt.kernel.frame.frame`

# Functions that only the kernel calls: without wrappers for calls from outside 20 % less to compile; inlined, because a
# call passes vectors through memory, 1.5 to 2 times as fast.
INNER: dict[str, Any] = {
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "forceinline": True,
    "no_rewrites": True,
    "pipeline_class": Inlined,
}


def own_functions(module: ModuleType) -> list[FunctionType]:
    """The functions that a module defines."""
    return [
        each for each in vars(module).values() if isinstance(each, FunctionType) and each.__module__ == module.__name__
    ]


# Each of these has a compiled form of its own, chosen by the types of its arguments. Parameters have no annotations:
# numba compares them with those of the implementation.


@overload(rows.intersect, jit_options=INNER, strict=False)
def _intersect(shape, origin, direction):  # type: ignore[no-untyped-def]
    return rows.kind_of_packed(shape.instance_class).intersect


@overload(rows.surface, jit_options=INNER, strict=False)
def _surface(shape, point):  # type: ignore[no-untyped-def]
    return rows.kind_of_packed(shape.instance_class).surface


@overload(rows.shading, jit_options=INNER, strict=False)
def _shading(shape, point, normal):  # type: ignore[no-untyped-def]
    return rows.kind_of_packed(shape.instance_class).shading


@overload(rows.may_meet, jit_options=INNER, strict=False)
def _may_meet(shape, apex, start, direction, asked):  # type: ignore[no-untyped-def]
    return rows.kind_of_packed(shape.instance_class).may_meet


@overload(rows.mapping, jit_options=INNER, strict=False)
def _mapping(shape, point, normal):  # type: ignore[no-untyped-def]
    return rows.kind_of_packed(shape.instance_class).mapping


@overload(trace.closest_of_kind, jit_options=INNER, strict=False)
def _nearest_of_kind(group, state, given):  # type: ignore[no-untyped-def]
    return trace.closest_batched if kind_of_group(group).batched else trace.closest_one_by_one


@overload(trace.unoccluded_by_kind, jit_options=INNER, strict=False)
def _unhidden_by_kind(group, free, given):  # type: ignore[no-untyped-def]
    return trace.unoccluded_batched if kind_of_group(group).batched else trace.unoccluded_one_by_one


def kind_of_group(group: Any) -> Kind:
    """The kind of the shapes of a group, by its type."""
    return rows.kind_of(group.content[0].dtype.fields)


def first_number(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    """The address of the first number of a row."""
    array = context.make_array(sig.args[0])(context, builder, value=args[0])
    place = builder.gep(array.data, [context.cast(builder, args[1], sig.args[1], types.intp)])
    number = context.get_value_type(common(*numbers_of(sig.args[0])))
    return builder.bitcast(place, number.as_pointer())


def numbers_of(array: Any) -> list[Any]:
    """The types of the numbers in the fields of a row; all are the same."""
    kinds = [each.type for each in array.dtype.fields.values()]
    return [kind.dtype if isinstance(kind, types.NestedArray) else kind for kind in kinds]


def packed_type(array: Any, i: Any) -> Any:
    """The type of a packed shape: the kind's NamedTuple of float64s and Vecs."""
    if not isinstance(array, types.Array):
        return None
    number = common(*numbers_of(array))
    fields = [
        VecType(number) if isinstance(each.type, types.NestedArray) else number for each in array.dtype.fields.values()
    ]
    return types.NamedTuple(fields, rows.kind_of(array.dtype.fields).packed)


@register(rows.read, packed_type, [(types.Array, types.Integer)])
def _read(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    address = first_number(context, builder, sig, args)
    numbers = (builder.load(builder.gep(address, [ir.Constant(ir.IntType(64), at)])) for at in count())
    return packed_of(context, builder, sig.return_type, numbers)


def packed_of(context: Any, builder: ir.IRBuilder, kind: Any, numbers: Iterator[Any]) -> Any:
    """The packed shape of a type that is made of some numbers."""
    parts = [
        vec_of(context, builder, each, [next(numbers) for _ in "xyz"]) if isinstance(each, VecType) else next(numbers)
        for each in kind.types
    ]
    return context.make_tuple(builder, kind, parts)


teach_for_placed(rows.read, packed_type, _read)


@register(atomic_counter.fetch_add, lambda counter, amount: types.int64, [(types.Array, types.Integer)])
def _fetch_add(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    counter = context.make_array(sig.args[0])(context, builder, value=args[0])
    amount = context.cast(builder, args[1], sig.args[1], types.int64)
    return builder.atomic_rmw("add", counter.data, amount, "monotonic")


def whole_block(pixels: Any, x: Any, y: Any, *levels: Any) -> Any:
    """Nothing, for a place and three levels of lanes."""
    return types.none if all(isinstance(each, Lanes) for each in levels) else None


@register(frame.store_block, whole_block, [(Placed, types.Integer, types.Integer, Lanes, Lanes, Lanes)])
def _store_block(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    word = ir.IntType(32)
    pixels = data(context, builder, sig.args[0], args[0])
    x, y = (context.cast(builder, args[i], sig.args[i], types.intp) for i in (1, 2))
    width = length(context, builder, sig.args[0], args[0], 1)
    count = sig.args[3].count
    step = count // frame.PACKET_HEIGHT
    words = splat(builder, ir.Constant(word, frame.OPAQUE), count)
    for level, shift in zip(args[3:], (16, 8, 0), strict=True):
        byte = builder.fptosi(level, words.type)
        words = builder.or_(words, builder.shl(byte, constant(words, shift)))
    for line in range(frame.PACKET_HEIGHT):
        lanes = [ir.Constant(word, line * step + i) for i in range(step)]
        part = builder.shuffle_vector(words, words, ir.Constant(ir.VectorType(word, step), lanes))
        row = builder.mul(builder.add(y, ir.Constant(y.type, line)), width)
        place = builder.gep(pixels, [builder.add(row, x)])
        builder.store(part, builder.bitcast(place, part.type.as_pointer()), align=4)
    return context.get_dummy_value()


register_jitable(**INNER)(vec.cross)
OWN_FORM = (
    whitted.ray_stack,
    trace.for_each_kind,
    trace.closest_of_kind,
    trace.unoccluded_by_kind,
    atomic_counter.fetch_add,
    frame.store_block,
    frame.frame,
)
for _module in (
    basis,
    compensated,
    angle,
    largest,
    power,
    quadric,
    uv_mapping,
    pyramid,
    shape,
    light_buffer,
    trace,
    specular,
    lights,
    texture_lookup,
    texturing,
    surfaces,
    shade,
    environment,
    whitted,
    frame,
    *(sys.modules[kind.intersect.__module__] for kind in ALL_KINDS),
):
    for _function in own_functions(_module):
        if _function not in OWN_FORM:
            register_jitable(**INNER)(_function)

CACHE = cache_folder.folder()
LOADED = 8  # kernels in memory, where they can be loaded again
PAINTED = ("checks", "textures", "bumps", "normals")
OPTIONAL = tuple(name for name, default in SceneArrays._field_defaults.items() if default is None)


@lru_cache(LOADED if CACHE else None)
def kernel_of(features: tuple[str, ...], *row_types: np.dtype[Any]) -> Any:
    """The kernel for shapes that lie in rows of these types and for `features` of a scene, compiled or loaded when it
    is first called.

    Each has a folder of its own: numba's index of a folder does not bear two programs that write it at the same time.
    """
    if "bvh" in features:
        import_module("minirt.kernel.compiler.jit_bvh")
    titles = (rows.kind_of(each.names).element.title for each in row_types)
    place = CACHE and CACHE / "-".join([*titles, *features, str(row_types[0][0].base)])
    return compiled(frame.frame, place)


def kernel_for(traced: SceneArrays) -> Any:
    """The kernel for a scene."""
    features = [*present(traced, OPTIONAL), *(present(traced.surface_maps, PAINTED) if traced.surface_maps else ())]
    return kernel_of(tuple(features), *(group.rows.dtype for group in traced.groups))


def present(table: Any, names: tuple[str, ...]) -> list[str]:
    """The fields that are not None."""
    return [name for name in names if getattr(table, name) is not None]


def compile(arguments: Arguments) -> None:
    """Compile the kernel for arguments of these types, unless it is kept from an earlier run."""
    kernel_for(arguments[-1]).compile(tuple(map(typeof, arguments)))


def is_kept(arguments: Arguments) -> bool:
    """Whether the kernel for arguments of these types need not be compiled."""
    kernel = kernel_for(arguments[-1])
    signature, keeper = tuple(map(typeof, arguments)), kernel._cache
    if CACHE is None or signature in kernel.overloads:
        return signature in kernel.overloads
    return keeper._index_key(signature, kernel.targetctx.codegen()) in keeper._cache_file._load_index()
