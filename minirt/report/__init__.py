"""Error against run time: of the formulas of shapes and of the pictures of a scene, measured and written down."""

from minirt.report.generate import report, report_formulas

__all__ = ["report", "report_formulas"]
