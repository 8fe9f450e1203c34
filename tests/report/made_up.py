"""Findings with known figures, to be drawn and written."""

from __future__ import annotations

from minirt.rendering.queries.stiffness import Stiff
from minirt.report.ablation import Part
from minirt.report.findings import Findings, Subject
from minirt.report.pictures import Row
from minirt.report.precision import KindCertificates

REFERENCE_ERROR = 0.0002


def row(knob: str, samples: int, slowness: float = 1.0, valid: bool = True, program: str = "miniRT") -> Row:
    """A row with an error of 0.04 at one sample, 0.02 at two and so on, and bars of 10 and 20 per cent.

    Settings whose names have another length have other pictures, if hardly so."""
    error, time = 0.04 * (1 + 1e-9 * len(knob)) / samples, 2.5 * slowness * samples
    remark = "" if valid else "other programs needed the processors"
    return Row(
        knob,
        str(samples),
        program,
        options=f"--samples {samples} --{knob}" if program == "miniRT" else "",
        samples=samples,
        rmse=error,
        rmse_low=0.9 * error,
        rmse_high=1.1 * error,
        psnr=30.0,
        wall_ms=time,
        wall_low_ms=0.8 * time,
        wall_high_ms=1.2 * time,
        runs=7,
        valid=valid,
        remark=remark,
    )


ROWS = [
    *(row("uniform", samples) for samples in (1, 4, 16)),
    *(row("adaptive", samples, 0.7, valid=samples != 4) for samples in (4, 16)),
    *(row("<slow> & sure", samples, 3.0) for samples in (1, 4)),
    *(row("1 bounce", samples, 1.02) for samples in (1, 4, 16)),
    *(row("3 bounces", samples, 1.05) for samples in (1, 4, 16)),
    *(row("single", samples, 0.9) for samples in (1, 4, 16)),
    *(row("POV-Ray", samples, 30.0, program="POV-Ray") for samples in (1, 4, 16)),
    Row("auto", "0.01", remark="failed: a|b"),
]
NAMES = ["uniform", "adaptive", "<slow> & sure", "1 bounce", "3 bounces", "single", "POV-Ray"]
POINTS = 19  # of those that did not fail
FINDINGS = Findings(
    Subject("scenes/<ball>.rt", "0" * 64, 32, 20, 2, 1, "a processor", {"minirt": "0.1.0"}),
    1024,
    REFERENCE_ERROR,
    pictures=ROWS,
    ablation=[
        Part("scene", "", "as it is", 2.5, valid=True),
        Part("list", "tiles", "without", 5.0, percent=100.0, valid=True),
    ],
    single=12,
    certificates=[
        KindCertificates("sphere", "from the eye", 8, 0.25, 3.0, 0.5, 0.25, 0.0, 0.0, 0.25, 0.0, 3.0, 9.0, 1e9, 1e-16)
    ],
    stiff=[Stiff("sphere 1", "small", {"size": 1e-9})],
    absent="3 kinds of shapes and 5 features",
    notes=["kernel for spheres"],
    same=[1, 4],
    not_measured=["POV-Ray is not installed"],
)
