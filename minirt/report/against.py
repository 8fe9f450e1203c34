"""A report beside another one: of another build, machine or setting of the same scene."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from math import nan
from typing import Annotated, Any, NamedTuple

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.report.bench import Run
from minirt.report.findings import Findings, Subject
from minirt.report.pictures import Row

LARGEST = 64 * 2**20  # bytes of a file
NOT_ONE = "is no report.json of this version of --report"


class Change(NamedTuple):
    """A figure of a setting whose interval does not overlap with that of the other report."""

    setting: Annotated[str, "setting"]
    what: Annotated[str, "figure"]  # "RMSE" or "ms"
    before: Annotated[float, "before", ".4g"]
    now: Annotated[float, "now", ".4g"]
    percent: Annotated[float, "change, %", "+.1f"]


def read(path: str | os.PathLike[str]) -> Findings:
    """Read the rows, times and subject of a `report.json`: FileError."""
    data = file_io.read_given(path, LARGEST)
    try:
        made = known(json.loads(data))
        rows = [Row(**row) for row in made["pictures"]]
        times = {name: [Run(**run) for run in runs] for name, runs in made["times"].items()}
        subject = Subject(**made["subject"])
        return Findings(subject, made["reference_samples"], made["reference_error"], pictures=rows, times=times)
    except (ValueError, TypeError, KeyError, AttributeError):
        raise FileError(path, NOT_ONE) from None


def known(value: Any) -> Any:
    """Return a value of JSON with NaN for null."""
    if isinstance(value, dict):
        return {key: known(each) for key, each in value.items()}
    if isinstance(value, list):
        return [known(each) for each in value]
    return nan if value is None else value


def changes(found: Findings, other: Findings) -> Iterator[Change]:
    """Yield what changed in the rows of both reports, beyond the intervals."""
    rows = {row.name: row for row in other.pictures}
    for row in (each for each in found.pictures if each.name in rows):
        for field, what in (("rmse", "RMSE"), ("ms", "ms")):
            figures = [[getattr(each, field + end) for end in ("", "_low", "_high")] for each in (rows[row.name], row)]
            (then, least, most), (now, low, high) = figures
            if low > most or high < least:
                yield Change(row.name, what, then, now, 100 * (now / then - 1) if then else nan)


def differences(found: Findings, other: Findings) -> dict[str, Any]:
    """Name what differs in the subjects of two reports, and count the settings that both have."""
    names = {"sha256": "the scene", "size": "the size", "processor": "the processor", "threads": "the threads"}
    names |= {"versions": "versions", "pixels": "the pixels that count"}
    one, two = ({**each.subject._asdict(), "size": each.size} for each in (found, other))
    both = len({row.name for row in found.pictures} & {row.name for row in other.pictures})
    return {"differ": [name for key, name in names.items() if one[key] != two[key]], "both": both}
