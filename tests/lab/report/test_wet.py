"""What is said of wet cargo before it is run: its state, how fast it drains, and what would be an artefact."""

import numpy as np
import pytest

from lab.preset.find import load
from lab.report.explain import sections
from lab.report.wet import bed as wet


def rows(name: str, changes: dict | None = None) -> list[tuple[str, str]]:
    """The rows on the wet bed."""
    return dict(sections(load(name, changes or {}))).get("Wet bed", [])


def test_half_of_the_pressure_of_the_source_s_sand_is_gone_in_a_quarter_of_a_millisecond():
    """0.5 mm, porosity 0.477, 0.115 m, modulus 2e7 Pa (own, by hand): 0.24 ms; softer water adds its own share."""
    permeability = 0.477**3 * 0.5e-3**2 / (180.0 * 0.523**2)
    assert wet.half_time(0.115, 1e-3, permeability, 2e7) == pytest.approx(0.24e-3, rel=0.03)
    twice = wet.half_time(0.115, 1e-3, permeability, 2e7, 2e7)
    assert twice == pytest.approx(2.0 * wet.half_time(0.115, 1e-3, permeability, 2e7))


def test_the_modulus_of_a_bed_is_that_of_its_springs():
    """dσ/dε of a column of Hertz contacts, by differences; of 3 mm with 3.2 GPa at 1 kPa about 2e7 Pa."""
    from lab.assembly.scene import build

    scene, _ = build(load("wet/sway").resolved)
    diameter, thickness, stress = 4e-3, scene.tanks[0].thickness, 1e3
    young = scene.grains.interfaces[0].young_modulus
    stiffness = 4.0 / 3.0 * young * (0.25 * diameter) ** 0.5

    def borne(strain):
        return stiffness * (strain * diameter) ** 1.5 / (diameter * thickness)

    strain = (stress * diameter * thickness / stiffness) ** (2.0 / 3.0) / diameter
    assert borne(strain) == pytest.approx(stress)
    slope = (borne(strain * 1.001) - borne(strain * 0.999)) / (0.002 * strain)
    assert wet.modulus(scene, stress) == pytest.approx(slope, rel=1e-5)
    assert wet.modulus(scene, stress, real=True) == pytest.approx(100.0 ** (2.0 / 3.0) * slope, rel=1e-5)


def test_explain_tells_how_wet_a_bed_is():
    """All that is asked for; a state that is not full has a table, and dry grains and water alone have none of it."""
    told = dict(rows("wet/sand"))
    assert told["moisture"] == "40 % of the mass of both"
    assert told["saturation"].startswith("192 %") and told["water"].startswith("50.9")
    assert "1381 kg/m^3 dry" in told["bulk density"]
    assert {"Stokes number", "stiffness", "drains by half"} <= told.keys()
    assert told["drains by half"].endswith("drained") and "caution" not in told
    table = dict(rows("wet/sand", {"water.moisture": "25 %"}))["water"]
    assert table.startswith("no free water: its table lies 4.4")
    assert not rows("sloshing/quick") and not rows("tilting/quick")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"grains.true_size": "0.1 mm"}, "only since its water is softer"),  # 0.3 s; with stiff water 0.03 s
        ({"grains.true_size": "0.005 mm"}, "pore pressures are too low"),
    ],
)
def test_artefacts_are_told(changes, said):
    """Sand that is undrained only by soft water, and fines that are undrained in water that bears too little."""
    cautions = [text for name, text in rows("wet/sand", changes) if name == "caution"]
    assert len(cautions) == 1 and said in cautions[0]


def test_the_stokes_number_is_of_inertia_and_viscosity():
    """√(ρ_s Δρ g d³)/(18 √2 μ) (Courrech du Pont et al. 2003), of 0.5 mm quartz: 2.9."""
    expected = np.sqrt(2650.0 * 1650.0 * 9.81 * 0.5e-3**3) / (18.0 * np.sqrt(2.0) * 1e-3)
    told = dict(rows("wet/sand"))["Stokes number"].partition(":")[0]
    assert float(told) == pytest.approx(expected, rel=5e-3)
