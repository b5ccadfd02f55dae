"""Tangential law against the critical angle."""

from pathlib import Path

from benchmarks.accuracy.beds import TILT, TILTED, add_table, sweep
from lab.report.page import Page

LAWS = ("haff-werner", "mindlin", "cundall-strack", "coulomb", "viscous", "none")
KEY = "contact.tangential"
NAMES = ("critical_angle", "first_slip_angle", "largest_surface_slope")


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    laws = LAWS[:2] if fast else LAWS
    points = sweep(TILTED, {KEY: list(laws)}, TILT, work / "laws", fast)
    page.section("Tangential law")
    page.say("""The same friction coefficient, 0.25, in each law; the tilt of the study of stiffness at a scale of a
        thousandth. The viscous law has no limit to its force, "none" no friction at all. Means of the
        beds with their [95 % intervals].""")
    add_table(page, "law", laws, points, NAMES)
