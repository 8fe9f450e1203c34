"""Single mutations of host code: a comparison, a condition, a number, a dropped statement, two swapped arguments."""

from __future__ import annotations

import ast
import copy
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from tests.stability.mutations import OPERATORS, STRICT, Change, replace, untouched

HOST_OPERATORS: dict[type[ast.AST], type[Any]] = {
    **OPERATORS,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}
SYMMETRIC = {"min", "max", "clamp", "dot", "hypot", "dist", "np.minimum", "np.maximum", "np.clip", "two_sum", "zip"}
ASKED = {"hasattr", "getattr", "setattr", "isinstance"}  # not worth a swap of arguments either
ASSERTING = {"strict"}  # keywords of calls that only assert something
DEFINITIONS = ast.FunctionDef, ast.ClassDef


def host_changes(source: str, text: str | None = None) -> Iterator[Callable[[], Change]]:
    """Yield all single changes of the functions of a source, or of its lines with that text, each to be made by a call;
    docstrings, signatures and class bodies stay."""
    at = {number for number, line in enumerate(source.splitlines(), 1) if text in (None, line.strip())}
    tree = ast.parse(source)
    aside = untouched(tree)
    aside |= {id(inner) for each in tree.body if not isinstance(each, DEFINITIONS) for inner in ast.walk(each)}
    aside |= {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg in ASSERTING}
    for number, node in enumerate(ast.walk(tree)):
        if id(node) not in aside and getattr(node, "lineno", 0) in at:
            yield from (partial(changed, tree, number, variant) for variant in host_variants(node))


def changed(tree: ast.Module, number: int, variant: ast.AST) -> Change:
    """Return the change that replaces node `number` of a tree; a constant is described with what it is part of."""
    new = copy.deepcopy(tree)
    node = next(each for i, each in enumerate(ast.walk(new)) if i == number)
    parent = next((each for each in ast.walk(new) if node in ast.iter_child_nodes(each)), node)
    whole = parent if isinstance(node, ast.Constant) and isinstance(parent, ast.expr) else node
    before = first_line(whole)
    replace(new, node, variant)
    return Change(node.lineno, before, first_line(variant if whole is node else whole), ast.fix_missing_locations(new))


def first_line(node: ast.AST) -> str:
    """Return the source of a node, or the first line of a statement."""
    return ast.unparse(node).splitlines()[0]


def host_variants(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the variants of an expression or a statement."""
    match node:
        case ast.Compare(left, [operator], [right]) if type(operator) in HOST_OPERATORS:
            yield ast.Compare(left, [HOST_OPERATORS[type(operator)]()], [right])
            if type(operator) in STRICT:
                yield ast.Compare(left, [STRICT[type(operator)]()], [right])
        case ast.BinOp(left, operator, right) if type(operator) in HOST_OPERATORS:
            yield ast.BinOp(left, HOST_OPERATORS[type(operator)](), right)
        case ast.BoolOp(operator, values):
            yield ast.BoolOp(ast.Or() if isinstance(operator, ast.And) else ast.And(), values)
        case ast.UnaryOp(ast.Not(), operand):
            yield operand
        case ast.Constant(bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(int() | float() as value):
            yield ast.Constant(value + 1)
        case ast.IfExp(test, body, orelse):
            yield ast.IfExp(test, orelse, body)
        case ast.Call(function, [first, second, *others], keywords) if is_ordered(function, first, second):
            yield ast.Call(function, [second, first, *others], keywords)
        case ast.Expr(ast.Call()) | ast.AugAssign() | ast.Raise():
            yield ast.Pass()
        case ast.Break():
            yield ast.Continue()
        case ast.Continue():
            yield ast.Break()


def is_ordered(function: ast.expr, first: ast.expr, second: ast.expr) -> bool:
    """Whether it makes a difference that is worth a test which of two arguments of a call comes first."""
    return ast.unparse(function) not in SYMMETRIC | ASKED and ast.unparse(first) != ast.unparse(second)
