"""`cargolab verify`: its fast cases pass and leave a page; what fails or breaks is said and stops nothing else."""

import json
from math import radians, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lab.studies import verify
from lab.studies.case import Line
from lab.studies.verify.impacts.chung_ooi import oblique
from lab.studies.verify.impacts.head_on import erred, normal_impacts
from lab.studies.verify.impacts.law import Bodies, Impact, Normal, Shear
from lab.studies.verify.plain import Tank
from lab.studies.verify.references import viscoelastic_rebound
from lab.studies.verify.scenes import ACETATE, Setup, at_level, grain

PICTURES = (
    *("errors", "chung-ooi-1-2", "chung-ooi-5", "restitution", "oblique-mindlin", "orders"),
    *("water-wave", "water-channel", "water-drop", "water-bubble"),
)


def told(folder) -> dict[str, dict]:
    """What verify.json holds of each case."""
    return json.loads((folder / "verify.json").read_text(encoding="utf-8"))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["frame-tilt", "frame-flight", "water-frame-flight", "water-frame-tilt"])
def test_axes_do_not_matter(name, tmp_path):
    """These take seconds, too, but are not among the fast cases, which other frames stand for."""
    assert verify.SUITE.run((name,), tmp_path, fast=False)
    assert "FAIL" not in (tmp_path / "verify.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_fast_cases_pass_and_leave_a_page(tmp_path, capsys):
    assert verify.SUITE.run((), tmp_path, fast=True)
    page, printed = (tmp_path / "verify.md").read_text(encoding="utf-8"), capsys.readouterr().out
    names = [case.name for case in verify.CASES if case.quick]
    assert all(f"`{name}`" in page for name in names)
    assert "FAIL" not in page
    assert printed.count(" pass\n") == sum(len(case["lines"]) for case in told(tmp_path).values()) > 100
    assert [*told(tmp_path)] == names
    pictures = {picture.name for picture in tmp_path.glob("*.png")}
    assert pictures == {f"verify-{name}.png" for name in PICTURES}
    assert "](verify-errors.png)" in page and page.count("](") == 1, "one figure stands on the page"
    assert all(f"`{name}`" in page for name in pictures - {"verify-errors.png"})


def test_an_error_relative_to_nothing_is_no_line():
    with pytest.raises(ValueError, match="of zero"):
        Line("a quantity", 1.0, 0.0, "by hand", 0.1, "no reason")
    assert Line("a quantity", 0.05, 0.0, "by hand", 0.1, "no reason", relative=False).passed


def test_of_what_should_be_at_least_so_much_more_is_no_error():
    lines = [
        Line("order", value, 1.0, "theory", 0.2, "noise", relative=False, at_least=True) for value in (3.0, 0.9, 0.7)
    ]
    assert [line.passed for line in lines] == [True, True, False]
    assert lines[0].error == 0.0 and lines[2].error == pytest.approx(-0.3)


def test_what_head_on_impacts_may_err_by_is_of_second_order_and_small():
    """Of Verlet's scheme on Hertz's law alone: a spring of one stiffness would end (π/24) (π/N)² early."""
    glass = normal_impacts()["test 1, glass"]
    here, finer = erred(glass), erred(glass, 0.25)
    for name in ("force", "overlap", "peak_force", "peak_overlap", "duration"):
        assert 8.0 < getattr(here, name) / getattr(finer, name) < 24.0, name
    spring = np.pi / 24.0 * (np.pi / here.steps) ** 2
    assert 0.5 * spring < here.force < 2.0 * spring and finer.steps == pytest.approx(4.0 * here.steps)


def test_the_slip_of_a_contact_that_sticks_may_err_by_what_a_leapfrog_errs_by():
    """Steel of test 5, grazing: s¨ = −ω_t² s, ω_t² ∝ √ξ, by a leapfrog with the derived step and by a 64th of it."""
    steel = oblique()["test 5, steel"]
    hertz, step, shear = steel.elastic(), steel.steps()[0], steel.contact[1] / steel.bodies.m_eff
    path = solve_ivp(
        lambda _, x: [x[1], -hertz.stiffness / hertz.mass * max(x[0], 0.0) ** 1.5],
        (0.0, hertz.duration),
        [0.0, hertz.speed],
        dense_output=True,
        rtol=1e-10,
        atol=1e-16,
    )

    def left(length: float, onset: float) -> float:
        """Speed of slip at the end of one of 1 m/s."""
        slip, speed, time = 0.0, 1.0, -onset * length
        while time < hertz.duration:
            time += length
            slip += min(length, time) * speed  # from touch on
            overlap = max(path.sol(np.clip(time, 0.0, hertz.duration))[0], 0.0)
            speed -= length * 3.5 * shear * np.sqrt(overlap) * slip
        return speed

    wanted = left(step / 64.0, 0.5)
    worst = max(abs(left(step, onset) - wanted) for onset in (0.1, 0.4, 0.7, 0.9))
    assert 0.2 * steel.late[0] < worst < steel.late[0]


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


def test_a_level_sets_the_steps_of_setups_and_not_their_stiffness():
    setup = Setup(np.array([grain(0.0, 0.01, 1.5e-3)]), ACETATE, {"width": 0.1, "height": 0.02})
    derived, _ = setup.build()
    with at_level("draft"):
        draft, _ = setup.build()
    assert draft.step == pytest.approx(1.6 * derived.step, rel=1e-3)
    assert draft.grains.stiffness_scale == derived.grains.stiffness_scale == 1.0
    suite = verify.suite_at("draft")
    assert suite.name == "verify-draft" and suite.command == "verify --level draft"
    assert {"friction-cap", "incline"} <= {case.name for case in suite.cases} < {case.name for case in verify.CASES}
