"""Findings with known figures, to be drawn and written."""

from __future__ import annotations

from minirt.rendering.queries.stiffness import Stiff
from minirt.report.ablation import Part
from minirt.report.findings import Findings, Subject
from minirt.report.pictures import Row
from minirt.report.precision import KindCertificates

REFERENCE_ERROR = 0.0002


def row(knob: str, samples: int, slowness: float = 1.0) -> Row:
    """A row with an error of 0.04 at one sample, 0.02 at two and so on, and bars of 10 and 20 per cent.

    Settings whose names have another length have other pictures, if hardly so."""
    error, time = 0.04 * (1 + 1e-9 * len(knob)) / samples, 2.5 * slowness * samples
    return Row(
        knob,
        str(samples),
        options=f"--samples {samples} --{knob}",
        samples=samples,
        rmse=error,
        rmse_low=0.9 * error,
        rmse_high=1.1 * error,
        psnr=30.0,
        ms=time,
        ms_low=0.8 * time,
        ms_high=1.2 * time,
        runs=7,
    )


ROWS = [
    *(row("uniform", samples) for samples in (1, 4, 16)),
    *(row("adaptive", samples, 0.7) for samples in (4, 16)),
    *(row("<slow> & sure", samples, 3.0) for samples in (1, 4)),
    *(row("1 bounce", samples, 1.02) for samples in (1, 4, 16)),
    *(row("3 bounces", samples, 1.05) for samples in (1, 4, 16)),
    *(row("single", samples, 0.9) for samples in (1, 4, 16)),
    Row("auto", "0.01", remark="failed: a|b"),
]
NAMES = ["uniform", "adaptive", "<slow> & sure", "1 bounce", "3 bounces", "single"]
POINTS = 16  # of those that did not fail
FINDINGS = Findings(
    Subject("scenes/<ball>.rt", "0" * 64, 32, 20, 640, 2, 1, "a processor", {"minirt": "0.1.0"}),
    1024,
    REFERENCE_ERROR,
    pictures=ROWS,
    ablation=[
        Part("scene", "", "as it is", 2.5),
        Part("list", "tiles", "without", 5.0, percent=100.0),
    ],
    single=12,
    certificates=[
        KindCertificates("sphere", "from the eye", 8, 0.25, 3.0, 0.5, 0.25, 0.0, 0.0, 0.25, 0.0, 3.0, 9.0, 1e9, 1e-16)
    ],
    stiff=[Stiff("sphere 1", "small", {"size": 1e-9})],
    absent="3 kinds of shapes and 5 features",
    notes=["kernel for spheres"],
)
