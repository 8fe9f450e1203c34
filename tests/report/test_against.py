"""A comparison with another report tells as changed what lies beyond the intervals."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from minirt.errors import FileError
from minirt.report.against import changes, read
from minirt.report.answers import answers
from minirt.report.diagram import WIDE, draw
from minirt.report.document import report_files
from minirt.report.findings import Findings
from tests.report.made_up import FINDINGS, ROWS


def written(found: Findings, folder: Path) -> Path:
    (folder / "report.json").write_bytes(report_files(found, {}, np.zeros((2, 2, 3)))["report.json"])
    return folder / "report.json"


def test_a_report_is_read_as_it_was_written(tmp_path: Path) -> None:
    other = read(written(FINDINGS, tmp_path))
    assert other.subject == FINDINGS.subject
    assert str(other.pictures) == str(ROWS)  # NaN is not equal to itself
    assert list(changes(FINDINGS, other)) == []


@pytest.mark.parametrize("text", ["", "[]", "{}", "7", '{"pictures": [{"knob": "u"}], "times": {}}', "null"])
def test_what_is_no_report_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "x.json").write_text(text)
    with pytest.raises(FileError, match=r"x\.json: is no report\.json of this version"):
        read(tmp_path / "x.json")
    with pytest.raises(FileError, match="none"):
        read(tmp_path / "none")
    data = json.loads(written(FINDINGS, tmp_path).read_text())
    data["pictures"][0]["unknown"] = 1
    (tmp_path / "x.json").write_text(json.dumps(data))
    with pytest.raises(FileError, match="this version"):
        read(tmp_path / "x.json")


def test_changes_lie_beyond_the_intervals() -> None:
    """Times have bars of a fifth, errors of a tenth: 1.45 times the time is within both bars, 1.55 times is not."""
    faster, slower, same, closer = ROWS[0], ROWS[1], ROWS[2], ROWS[3]
    now = [
        faster._replace(ms=faster.ms / 2, ms_low=0.4 * faster.ms, ms_high=0.6 * faster.ms),
        slower._replace(ms=1.55 * slower.ms, ms_low=1.24 * slower.ms, ms_high=1.86 * slower.ms),
        same._replace(ms=1.45 * same.ms, ms_low=1.16 * same.ms, ms_high=1.74 * same.ms),
        closer._replace(rmse=0.8 * closer.rmse, rmse_low=0.72 * closer.rmse, rmse_high=0.88 * closer.rmse),
        ROWS[4]._replace(knob="new"),
    ]
    found = replace(FINDINGS, pictures=now, other=FINDINGS)
    told = [(each.setting, each.what, round(each.percent)) for each in changes(found, FINDINGS)]
    assert told == [(faster.name, "ms", -50), (slower.name, "ms", 55), (closer.name, "RMSE", -20)]
    times = f"1 faster ({faster.name}: -50 %), 1 slower ({slower.name}: +55 %)"
    sentence = f"of 4 settings, beyond the intervals, {times}; 1 closer ({closer.name}: -20 %), 0 further off."
    assert dict(answers(found))["What changed?"] == sentence
    elsewhere = replace(FINDINGS, subject=FINDINGS.subject._replace(processor="another", width=33))
    assert dict(answers(replace(found, other=elsewhere)))["What changed?"].startswith(
        "the size and the processor differ; of 4"
    )


def test_both_reports_are_in_the_diagram_and_the_page() -> None:
    slower = [row._replace(ms=2 * row.ms, ms_low=1.6 * row.ms, ms_high=2.4 * row.ms) for row in ROWS]
    found = replace(FINDINGS, other=replace(FINDINGS, pictures=slower))
    both, alone = draw(found, WIDE), draw(FINDINGS, WIDE)
    assert both.count("stroke-dasharray") >= alone.count("stroke-dasharray") + 7  # a line for each setting
    assert ">before<" in both
    assert ">before<" not in alone
    made = report_files(found, {}, np.zeros((2, 2, 3)))
    for name, heading in (("report.html", b"<h2>What changed</h2>"), ("report.md", b"## What changed")):
        assert heading in made[name]
