"""Tests of numerical stability: near edges, far away, very small, very large.

A regime (`regime.Regime`) is a recipe for shapes and rays that are hard in one way, with the accuracy that answers must
still have. `table.REGIMES` lists the regimes of every shape: those in `common` are made from the shape's declared
fields, further ones are in `revolved`, `solids` and `sheets`. The formulas run on arrays, compiled, and through
`minirt.trace`; `tests.oracle` gives the right answers.

`mutants` holds formulas that look right but are wrong: the same checks must fail on them. `python -m tests.stability`
prints the backward errors of all kinds.
"""
