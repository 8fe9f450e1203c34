"""The page about reports explains every field of every table."""

from __future__ import annotations

import re

import pytest

from minirt.report.measurements import ablation, convergence, formula_errors, picture_errors, single_errors
from tests.paths import PACKAGE

PAGE = (PACKAGE / "report" / "README.md").read_text(encoding="utf-8")
TABLES = {
    "pictures.csv": picture_errors.Row,
    "orders.csv": convergence.Order,
    "ablation.csv": ablation.Part,
    "single.csv": single_errors.SingleError,
    "kernels.csv": formula_errors.Row,
}


@pytest.mark.parametrize("table", TABLES)
def test_every_field_is_explained(table: str) -> None:
    rows = PAGE.split(f"| `{table}` |")[1]
    own = re.split(r"\n\| `\w+\.csv` \||\n\n", rows)[0]
    assert set(re.findall(r"`(\w+)`", own)) == set(TABLES[table]._fields)
