"""What must hold where numbers are hard: near edges, far away, very small, very large.

A regime (`regime.Regime`) is a recipe for shapes and rays that are hard in one way, and says how exact the answers must
be nonetheless. `table.REGIMES` lists them for every shape: `common` ones are made from the table of a shape's fields,
further ones are in the file that is called like the shape. The formulas run on single numbers, on arrays, compiled, and
through `minirt.trace`; right is what `tests.oracle` says.

Formulas that look right and are not are in `mutants`: the same checks must fail on them. `python -m
tests.stability.mutation` changes the real formulas, one place at a time, and lists the changes that no test notices.
"""
