"""`cargolab verify`: its fast cases pass and leave a page; what fails or breaks is said and stops nothing else."""

import json
from dataclasses import replace
from math import radians, tan

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.studies import verify
from lab.studies.verify.case import Case, Found, Line
from lab.studies.verify.impacts import Bodies, Impact, Normal, Shear
from lab.studies.verify.plain import Tank
from lab.studies.verify.references import viscoelastic_rebound

PICTURES = ("errors", "chung-ooi-1-2", "chung-ooi-5", "restitution", "oblique-mindlin", "orders")


def told(folder) -> dict[str, dict]:
    """What verify.json holds of each case."""
    return json.loads((folder / "verify.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_a_few_cases_pass(tmp_path):
    assert verify.run_cases(("momentum",), tmp_path, fast=True)
    assert "FAIL" not in (tmp_path / "verify.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_fast_cases_pass_and_leave_a_page(tmp_path, capsys):
    assert verify.run_cases((), tmp_path, fast=True)
    page, printed = (tmp_path / "verify.md").read_text(encoding="utf-8"), capsys.readouterr().out
    names = [case.name for case in verify.CASES if case.quick]
    assert all(f"`{name}`" in page for name in names)
    assert "FAIL" not in page
    assert printed.count(" pass\n") == sum(len(case["lines"]) for case in told(tmp_path).values()) > 100
    assert [*told(tmp_path)] == names
    pictures = {picture.name for picture in tmp_path.glob("*.png")}
    assert pictures == {f"verify-{name}.png" for name in PICTURES}
    assert all(f"({name})" in page for name in pictures)


def stub(name: str, value: float, quick: bool = True) -> Case:
    """A case of one line, 1 ± 0.1."""
    line = Line("a quantity", value, 1.0, "by hand", 0.1, "no reason")
    return Case(name, "Section", f"Title of {name}", lambda fast: Found([line]), quick)


def broken(fast: bool) -> Found:
    raise ArithmeticError("what went wrong")


def test_what_fails_or_breaks_is_reported_and_stops_nothing(tmp_path, monkeypatch, capsys):
    empty = Case("empty", "Section", "Nothing shown", lambda fast: Found([]))
    cases = (
        stub("off", 1.2),
        Case("breaks", "Section", "Breaks", broken),
        stub("nan", np.nan),
        empty,
        stub("good", 1.05),
    )
    monkeypatch.setattr(verify, "CASES", cases)
    assert not verify.run_cases((), tmp_path, fast=False)
    assert "failed: off, breaks, nan, empty" in capsys.readouterr().out
    page, found = (tmp_path / "verify.md").read_text(encoding="utf-8"), told(tmp_path)
    assert page.count("FAIL |") == 2
    assert "**Failed: off, breaks, nan, empty.**" in page
    assert "ArithmeticError: what went wrong" in page
    assert {name: (one["passed"], one["fault"]) for name, one in found.items()} == {
        "off": (False, ""),
        "breaks": (False, "ArithmeticError: what went wrong"),
        "nan": (False, ""),
        "empty": (False, ""),
        "good": (True, ""),
    }
    assert [[line["passed"] for line in found[name]["lines"]] for name in ("off", "nan", "good")] == [
        [False], [False], [True]
    ]  # fmt: skip
    assert verify.run_cases(("good",), tmp_path, fast=False), "only the named one counts"


def test_what_is_kept_is_not_run_again_unless_named_or_broken(tmp_path, monkeypatch, capsys):
    cases = (stub("off", 1.2), Case("breaks", "Section", "Breaks", broken), stub("good", 1.05))
    monkeypatch.setattr(verify, "CASES", cases)
    verify.run_cases((), tmp_path, fast=False)
    page = (tmp_path / "verify.md").read_text(encoding="utf-8")
    run = []
    again = [replace(case, check=lambda fast, name=case.name: run.append(name) or Found([])) for case in cases]
    monkeypatch.setattr(verify, "CASES", again)
    assert not verify.run_cases((), tmp_path, fast=False, page_only=True)
    assert (tmp_path / "verify.md").read_text(encoding="utf-8") == page and not run
    assert not verify.run_cases((), tmp_path, fast=False)
    assert run == ["breaks"]
    said = capsys.readouterr().out
    assert "off: FAIL, kept from an earlier run\n" in said and "good: pass, kept from an earlier run\n" in said
    verify.run_cases(("good",), tmp_path, fast=False)
    assert run == ["breaks", "good"]


def test_names_are_prefixes_and_unknown_ones_are_answered_with_all(monkeypatch):
    monkeypatch.setattr(
        verify, "CASES", (stub("fall-far", 1.0), stub("fall-near", 1.0), stub("roll", 1.0, quick=False))
    )
    assert [case.name for case in verify.select(("fall",), fast=False)] == ["fall-far", "fall-near"]
    assert [case.name for case in verify.select((), fast=True)] == ["fall-far", "fall-near"]
    with pytest.raises(LabError, match="no case spin; there are fall-far, fall-near, roll"):
        verify.select(("roll", "spin"), fast=False)
    with pytest.raises(LabError, match="no fast case roll; there are fall-far, fall-near"):
        verify.select(("roll",), fast=True)


def test_an_error_relative_to_nothing_is_no_line():
    with pytest.raises(ValueError, match="of zero"):
        Line("a quantity", 1.0, 0.0, "by hand", 0.1, "no reason")
    assert Line("a quantity", 0.05, 0.0, "by hand", 0.1, "no reason", relative=False).passed


def test_names_of_cases_are_their_own():
    names = [case.name for case in verify.CASES]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("law", ["mindlin", "haff-werner"])
def test_integrated_impacts_that_slide_have_their_closed_form(law):
    """e_t = 1 − μ(1 + e)/tan θ, by both integrations, with the restitution of a third one."""
    mass, k, angle, x = 1e-5, 1e8, radians(75.0), 0.3
    time = x / 1.5 * (mass / k) ** 0.4
    normal = Normal(k, 1.5 * time * k)
    shear = Shear(0.2, 2e8, 0.5, time) if law == "mindlin" else Shear(0.2, damper=1e4)
    along, _, _, _ = Impact(Bodies(1e-3, mass), normal, shear).meet(tan(angle), 1.0)
    expected = 1.0 - 0.2 * (1.0 + viscoelastic_rebound(x)[0]) / tan(angle)
    assert along / tan(angle) == pytest.approx(expected, abs=1e-8)


def test_integrated_impacts_of_two_spheres_keep_their_momenta():
    """Of the tangential impulse J each sphere takes the spin ℓ J/I, ℓ as its radius but for the overlap of 0.2 %."""
    normal, shear = Normal(1e8, 1e3), Shear(0.3, 1.2e8)
    radius, mass, other = 1e-3, 1e-5, 2e-3
    two = Impact(Bodies(radius, mass, other, 8.0 * mass), normal, shear).meet(0.4, 1.0, (-100.0, 30.0))
    spun = 0.4 * mass * radius**2 * (two[2] + 100.0), 0.4 * 8.0 * mass * other**2 * (two[3] - 30.0)
    assert spun[1] / spun[0] == pytest.approx(other / radius, rel=3e-3)
    plane = Impact(Bodies(radius, mass), normal, shear).meet(0.4, 1.0, (-100.0, 0.0))
    large = Impact(Bodies(radius, mass, 1e4 * radius, 1e12 * mass), normal, shear).meet(0.4, 1.0, (-100.0, 0.0))
    assert large == pytest.approx(plane, rel=1e-2, abs=1e-6)  # a plane is a sphere beyond all size, but for the lever


def test_plain_tank_holds_its_grain_still():
    """One grain on its overlap in a tank that stands: the reference itself rests."""
    material = {
        "young": 3.2e6,
        "poisson": 0.28,
        "density": 1319.0,
        "friction": 0.3,
        "dissipative_time": 0.0,
        "shear_damping": 0.01,
    }
    still = lambda _: (np.zeros(2), 0.0, np.zeros(2), 0.0)  # noqa: E731
    tank = Tank(np.array([3e-3]), material, 0.02, 0.02, still)
    stiffness = 4 / 3 * 3.2e6 / (2 * (1 - 0.28**2)) * np.sqrt(3e-3)
    start = np.array([[0.0, 3e-3 - (tank.mass[0] * 9.81 / stiffness) ** (2 / 3)]])
    place, velocity, angle, spin = tank.run(start, 2e-5, 200)
    assert np.abs(place - start).max() < 1e-15
    assert max(np.abs(velocity).max(), np.abs(angle).max(), np.abs(spin).max()) < 1e-12
