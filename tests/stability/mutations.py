"""Single changes of a source: a sign, a comparison, a constant, a root, a guard, a component, a name."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from typing import NamedTuple

OPERATORS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.Lt: ast.Gt,
    ast.Gt: ast.Lt,
    ast.LtE: ast.GtE,
    ast.GtE: ast.LtE,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
}
STRICT: dict[type[ast.AST], type[ast.AST]] = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
OTHERS = {"minimum": "maximum", "maximum": "minimum", "near": "far", "far": "near", "enter": "leave", "leave": "enter"}
OTHERS |= {"low": "high", "high": "low", "below": "above", "above": "below", "bottom": "top", "top": "bottom"}
OTHERS |= {"by_a": "by_c", "by_c": "by_a", "first": "last", "last": "first", "again": "near"}
COMPONENTS = {"x": "y", "y": "z", "z": "x", "u": "v", "v": "w", "w": "u"}
WRAPPERS = {"fabs", "sqrt", "unit", "copysign", "splat", "rounded_product", "product_error"}  # f(x, ...) becomes x


class Change(NamedTuple):
    """A changed source, and which line was changed from what to what."""

    line: int
    before: str
    after: str
    tree: ast.Module


def changes(source: str) -> Iterator[Change]:
    """All single changes of the functions and constants of a source; annotations and docstrings stay as they are."""
    tree = ast.parse(source)
    for number, node in enumerate(ast.walk(tree)):
        if not isinstance(node, ast.expr) or id(node) in untouched(tree):
            continue
        for variant in variants(node):
            changed = copy.deepcopy(tree)
            target = next(each for i, each in enumerate(ast.walk(changed)) if i == number)
            replace(changed, target, variant)
            yield Change(node.lineno, ast.unparse(node), ast.unparse(variant), ast.fix_missing_locations(changed))


def variants(node: ast.expr) -> Iterator[ast.expr]:
    """What may stand in the place of an expression."""
    match node:
        case ast.BinOp(left, operator, right):
            if type(operator) in OPERATORS:
                yield ast.BinOp(left, OPERATORS[type(operator)](), right)
            if isinstance(operator, (ast.Add, ast.Sub, ast.BitAnd, ast.BitOr)):
                yield left
                yield right
        case ast.UnaryOp(_, operand):
            yield operand
        case ast.Compare(left, [operator], [right]) if type(operator) in OPERATORS:
            yield ast.Compare(left, [OPERATORS[type(operator)]()], [right])
            if type(operator) in STRICT:
                yield ast.Compare(left, [STRICT[type(operator)]()], [right])
        case ast.Constant(float() | int() as value) if not isinstance(value, bool):
            yield ast.Constant(value + 1)
            yield ast.Constant(2 * value if value else -1.0)
            yield ast.Constant(value / 2 if value else 1e-9)
        case ast.Call(ast.Name("where"), [mask, yes, no]):
            yield yes
            yield no
            yield ast.Call(node.func, [mask, no, yes], [])
        case ast.Call(ast.Name("any" | "rarely"), [_]):
            yield ast.Constant(False)
        case ast.Call(ast.Name(name), [first, *_]) if name in WRAPPERS:
            yield first
        case ast.Name(name) if isinstance(node.ctx, ast.Load) and name in OTHERS:
            yield ast.Name(OTHERS[name], ast.Load())
        case ast.Attribute(value, name) if isinstance(node.ctx, ast.Load) and name in COMPONENTS:
            yield ast.Attribute(value, COMPONENTS[name], ast.Load())


def untouched(tree: ast.Module) -> set[int]:
    """The expressions that no formula is made of."""
    found: set[int] = set()
    for node in ast.walk(tree):
        aside: list[ast.AST | None] = []
        if isinstance(node, ast.AnnAssign):
            aside = [node.annotation]
        if isinstance(node, ast.FunctionDef):
            aside = [node.args, node.returns, *node.decorator_list]
        if isinstance(node, ast.ClassDef):  # of a class, only what is in its methods
            aside = [each for each in node.body if not isinstance(each, ast.FunctionDef)]
            aside += [*node.bases, *node.decorator_list]
        found |= {id(inner) for each in aside if each is not None for inner in ast.walk(each)}
    return found


def replace(tree: ast.AST, old: ast.AST, new: ast.AST) -> None:
    """Put one node in the place of another."""
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if value is old:
                setattr(parent, name, new)
            elif isinstance(value, list) and any(each is old for each in value):
                setattr(parent, name, [new if each is old else each for each in value])
