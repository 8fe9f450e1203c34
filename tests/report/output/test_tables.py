"""Tables that were written as CSV or JSON can be read again."""

from __future__ import annotations

import csv
import io
import json
from math import inf, isnan, nan
from typing import NamedTuple

from minirt.report.output.tables import as_csv, as_json


class Row(NamedTuple):
    name: str
    error: float
    count: int = 3


ROWS = [Row("a, b", 0.1 + 0.2), Row('"c"', nan), Row("d", inf)]


def test_csv_keeps_every_digit() -> None:
    read = list(csv.DictReader(io.StringIO(as_csv(ROWS))))
    assert [row["name"] for row in read] == ["a, b", '"c"', "d"]
    assert float(read[0]["error"]) == 0.1 + 0.2
    assert isnan(float(read[1]["error"]))
    assert float(read[2]["error"]) == inf


def test_json_has_no_nan() -> None:
    read = json.loads(as_json({"rows": ROWS, "best": ROWS[0]}), parse_constant=lambda name: 1 / 0)
    assert read["best"] == {"name": "a, b", "error": 0.1 + 0.2, "count": 3}
    assert [row["error"] for row in read["rows"]] == [0.1 + 0.2, None, None]
