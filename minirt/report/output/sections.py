"""Sections of the report about orders of convergence, about the cost of parts, and about single precision."""

from __future__ import annotations

from collections.abc import Iterator

from minirt.report.measurements.findings import Findings
from minirt.report.output.blocks import Block, Column, Heading, Text, table

ORDERS = (
    Column("setting", "knob"),
    Column("points", "points", "d"),
    Column("order by samples", "by_samples", ".2f"),
    Column("from", "by_samples_low", ".2f"),
    Column("to", "by_samples_high", ".2f"),
    Column("order by time", "by_time", ".2f"),
    Column("from", "by_time_low", ".2f"),
    Column("to", "by_time_high", ".2f"),
    Column("RMSE at 1 sample", "constant", ".3g"),
)
ABLATION = (
    Column("part", "name"),
    Column("change", "change"),
    Column("frame, ms", "frame_ms", ".2f"),
    Column("frame, %", "percent", "+.1f"),
    Column("from", "percent_low", "+.1f"),
    Column("to", "percent_high", "+.1f"),
    Column("compiling, s", "compile_s", ".1f"),
    Column("compiling, %", "compile_percent", "+.0f"),
    Column("pays after, s", "pays_after_s", ".0f"),
    Column("same picture", "same"),
    Column("remark", "remark"),
)
SINGLE = (
    Column("feature", "feature"),
    Column("RMSE", "rmse", ".1e"),
    Column("largest difference", "largest", ".1e"),
    Column("changed pixels", "changed", ".0f"),
    Column("remark", "remark"),
)


def orders_section(found: Findings) -> Iterator[Block]:
    """Yield the orders of convergence."""
    yield Heading("Orders of convergence")
    yield Text(
        "RMSE falls as samples^-order, or as time^-order, by least squares; from and to are 95 % confidence intervals "
        "by Student's t. Points within twice the error of the reference are left out, and that error is taken off the "
        "rest; disturbed times are left out."
    )
    yield table(found.orders, ORDERS)


def ablation_section(found: Findings) -> Iterator[Block]:
    """Yield what each part costs or saves."""
    yield Heading("What parts cost and save")
    yield Text(
        "Processor time of a frame with one sample per pixel, changed by one part: a list is left out, or something "
        "that no ray meets is added. It is the median of the ratios of frames in turn with the scene as it is; from "
        "and to are a 95 % confidence interval. Where code lies in memory changes a time by some per cent, too. "
        "`--ablation` adds the features and the kinds of shapes that the scene lacks, and leaves out those that it has "
        "and no pixel can show. A kernel without a part has saved its own compile time after so many seconds of "
        "rendering, where the interval tells that the part costs time."
    )
    yield table(found.ablation, ABLATION)


def single_section(found: Findings) -> Iterator[Block]:
    """Yield the errors of float32, feature by feature."""
    yield Heading("Single precision, feature by feature")
    yield Text(
        "Difference between pictures in float32 and in float64 with one sample per pixel: of the shapes alone, in "
        "their own colours, and with one feature of the scene at a time."
    )
    yield table(found.single, SINGLE)
