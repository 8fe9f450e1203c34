"""Section of the report about the certificates of hits."""

from __future__ import annotations

from collections.abc import Iterator

from minirt.report.measurements.hit_certificates import KindCertificates
from minirt.report.output.blocks import Block, Column, Heading, Text, table

CERTIFICATES = (
    Column("shape", "kind"),
    Column("rays", "rays"),
    Column("hits", "hits", "d"),
    Column("backward error, median", "backward_median", ".2f"),
    Column("largest", "backward_largest", ".2f"),
    Column("up to 1/4", "up_to_quarter", ".1%"),
    Column("1/2", "up_to_half", ".1%"),
    Column("1", "up_to_1", ".1%"),
    Column("2", "up_to_2", ".1%"),
    Column("4", "up_to_4", ".1%"),
    Column("more", "above_4", ".1%"),
    Column("condition, median", "condition_median", ".1f"),
    Column("99 %", "condition_99", ".2g"),
    Column("largest", "condition_largest", ".2g"),
    Column("normal off by", "normal_largest", ".1g"),
)


def certificate_section(rows: list[KindCertificates]) -> Iterator[Block]:
    """Yield the table of certificates: a line for each kind of shape, and for rays from the eye and onwards."""
    yield Heading("Certificates of hits")
    yield Text(
        "The backward error of a hit is its distance from the exact surface, in roundings (2^-53) of the numbers that "
        "it is computed from: of t, of the way from the origin of the ray to the shape, and of the shape's size. It is "
        "computed with twice the digits. The columns from 1/4 on are a histogram. The condition number tells how many "
        "times larger the relative error of t may be, as it is for grazing rays: t is exact within their product times "
        "2^-53. The last column is the largest distance of a normal from the exact unit normal."
    )
    yield table(rows, CERTIFICATES)
