"""Loop over the kinds of shapes, unrolled at compile time: `minirt.kernel.trace.for_each_kind`."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin

from minirt.kernel import trace
from minirt.kernel.compiler.by_reference import Reference, item_of, item_type


@infer_global(trace.for_each_kind)
class ForEachKind(AbstractTemplate):
    """Type of the loop: that of the state after the last step."""

    key = trace.for_each_kind

    def generic(self, args: Any, kws: Any) -> Any:
        """Return the signature of the loop."""
        return signature(step_signatures(self.context, *args)[-1].return_type, *args)


def step_signatures(context: Any, step: Any, groups: Reference, state: Any, arguments: Any) -> list[Any]:
    """Return the signature of the step for each kind."""
    signatures = []
    for position in range(len(groups.content)):
        group = item_type(groups, position)
        signatures.append(context.resolve_function_type(step, (group, state, arguments), {}))
        state = signatures[-1].return_type
    return signatures


@lower_builtin(trace.for_each_kind, types.Any, Reference, types.Any, types.Any)  # type: ignore[untyped-decorator]
def _for_each_kind(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    _, groups, state, arguments = args
    kind = sig.args[2]
    for position, each in enumerate(step_signatures(context.typing_context, *sig.args)):
        function = context.get_function(sig.args[0], each)
        context.add_linking_libs(getattr(function, "libs", ()))
        state = context.cast(builder, state, kind, each.args[1])
        state = function(builder, (item_of(context, builder, sig.args[1], groups, position), state, arguments))
        kind = each.return_type
    return state
