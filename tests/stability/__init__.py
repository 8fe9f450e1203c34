"""Tests of numerical stability: near edges, far away, very small, very large; see README.md.

`rays` makes hard shapes and rays of any kind, `verdicts` judges answers by `tests.oracle`, and `mutants` holds formulas
that look right but are wrong.
"""
