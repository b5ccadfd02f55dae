"""Swayed, heaved and rolled tanks: materials, sizes of tanks, centres of roll."""

from collections.abc import Mapping, Sequence

import numpy as np

from lab.measures.value import Value, over_worlds
from lab.studies.reproduce.curves import against, leading_number
from lab.studies.reproduce.estimates import Estimate, Verdict, falling, mean, ratio, together
from lab.studies.reproduce.experiment import ANY, Experiment, Row, Told, Tolerance, counted, held, observed, stated
from lab.studies.reproduce.runs import Batch, Outcome

FREQUENCY = "motion.sway.frequency"
ONSET = 0.02  # of the tank's amplitude: a larger response is distinguished from noise
STILL = 0.01  # of the tank's amplitude: a smaller response counts as none
OPPOSITE = Tolerance(45.0, "nearer to opposition than to a quarter of a period, how we read 'almost 180'")
BEGINS = Tolerance(0.2, "the step of our frequencies; the source says 'close to 1.2'")
FIVE, FACTOR = (2.5, 10.0), "2.5 to 10: a factor of 2, ours, as the source does not tell the tank"
LOST = "1 bed for 4, 3 s of motion for 8, fewer frequencies, both at draft accuracy"
FEWER = LOST.replace("for 4", "for 2")
Found = Mapping[str, Sequence[Outcome]]


def shaken(preset: str, quick: bool, frequencies: Sequence[str] = (), motion: str = "sway", **changes: object) -> Batch:
    """A preset at draft accuracy, at one frequency or several; single beds of several runs have a core each."""
    cost = {"run.accuracy": "draft", "run.repeats": 1 if quick else 4, "run.duration": "3 s" if quick else "8 s"}
    cost |= {"run.schedule": "per-world"} if quick else {}
    axes = {f"motion.{motion}.frequency": list(frequencies)} if frequencies else {}
    return Batch(preset, {**cost, **changes}, axes)


def materials_batches(motion: str, quick: bool) -> dict[str, Batch]:
    """The three ores, in 2 beds; a thousandth of the stiffness would let the gold ore overlap too far at 2 m/s.

    Beds of this many grains differ little; and in heave nothing is lifted, so few frequencies suffice. The gold ore,
    which takes three times as many steps, has the fewest, and is not in the quick report.
    """
    slower = ["0.5 Hz", "0.8 Hz", "1.1 Hz"]
    between = {} if motion == "heave" else {"B": slower[-1:]} if quick else {"A": slower, "B": slower}
    beds, stiffer = {} if quick else {"run.repeats": 2}, {"C": {"contact.stiffness_scale": 1e-2}}
    return {
        name: shaken(
            f"shaking/{motion}-materials-{name.lower()}",
            quick,
            ["0.2 Hz", *between.get(name, []), "1.5 Hz"],
            motion,
            **beds,
            **stiffer.get(name, {}),
        )
        for name in ("AB" if quick else "ABC")
    }


def at(outcomes: Sequence[Outcome], key: str, frequency: float) -> Outcome | None:
    """The outcome at a frequency (Hz)."""
    return next((one for one in outcomes if abs(leading_number(one.setting[key]) - frequency) < 1e-9), None)


def swayed(found: Found) -> Told:
    """Inert when slow; y with the tank, z with half its period, in opposite phase."""
    rows = []
    for name, outcomes in found.items():
        slow, fast = at(outcomes, FREQUENCY, 0.2), at(outcomes, FREQUENCY, 1.5)
        if slow:  # a period is too long for an amplitude
            rows.append(_inert(f"{name} at 0.2 Hz: largest shift", "inert", slow, judged=name in "AB"))
        if fast:
            rows.append(
                observed(
                    f"{name} at 1.5 Hz: amplitude of y",
                    "swings with the tank",
                    counted(fast["response_amplitude"]),
                    None,
                )
            )
            rows.append(stated(f"{name} at 1.5 Hz: phase", 180.0, fast["response_phase"], OPPOSITE))
            rows.append(
                observed(
                    f"{name} at 1.5 Hz: amplitude of z, half the period",
                    "smaller than y's",
                    counted(fast["response_amplitude_z"]),
                    None,
                )
            )
    families = {f"{name}": outcomes for name, outcomes in found.items()}
    return Told(
        rows,
        against(FREQUENCY, "frequency (Hz)", families, "response_amplitude", "amplitude of the centre of mass (mm)"),
    )


def _inert(quantity: str, source: str, one: Outcome, judged: bool = True) -> Row:
    """A centre of mass that stays where it is in a tank moved by 100 mm."""
    shift, most = one["largest_shift"], STILL * 100.0
    if not judged:
        return observed(quantity, "answers a little", counted(shift), None)
    found = mean(shift)
    verdict = Verdict.CANNOT_TELL if found is None else found.lies(-np.inf, most)
    return observed(quantity, source, counted(shift), verdict, f"{most:g} mm: a hundredth of the amplitude, ours")


def phase_batches(quick: bool) -> dict[str, Batch]:
    """Iron ore below, at and above the frequency at which a fluid of its depth would slosh."""
    if quick:  # the beds of the experiment before, which are not run again
        return {"B": materials_batches("sway", quick)["B"]}
    together = {"run.repeats": 1, "run.schedule": "per-world"}  # a core each
    return {"B": shaken("shaking/sway-materials-b", quick, ["1.1 Hz", "1.5 Hz", "2 Hz"], **together)}


def phases(found: Found) -> Told:
    """The faster the tank, the more the bed lags: past 270 deg, a quarter of a period behind, towards 180 deg."""
    swung = [one for one in found["B"] if leading_number(one.setting[FREQUENCY]) > 1.0]  # at less it lies still
    values = [one["response_phase"] for one in swung]
    rows = [
        stated(f"B at {one.setting[FREQUENCY]}: phase", 180.0, one["response_phase"], OPPOSITE)
        if leading_number(one.setting[FREQUENCY]) == 1.5
        else observed(f"B at {one.setting[FREQUENCY]}: phase", "", counted(one["response_phase"]), None)
        for one in swung
    ]
    rows.append(observed("falls as the frequency rises", "", falling(values).value, None))
    figure = against(FREQUENCY, "frequency (Hz)", {"B": swung}, "response_phase", "phase of the centre of mass (deg)")
    return Told(rows, figure)


def heaved(found: Found) -> Told:
    """The tank's acceleration stays below gravity: nothing is lifted."""
    key = "motion.heave.frequency"
    rows = []
    for name, outcomes in found.items():
        for frequency in (0.2, 1.5):
            one = at(outcomes, key, frequency)
            quantity = f"{name} at {frequency} Hz: shift of the centre of mass"
            if one and frequency < 1.0:
                rows.append(_inert(quantity, "follows the tank", one))
            elif one:
                rows.append(observed(quantity, "begins to swing", counted(one["largest_shift"]), None))
    return Told(
        rows, against(key, "frequency (Hz)", dict(found), "largest_shift", "largest shift of the centre of mass (mm)")
    )


def centres(found: Found) -> Told:
    """The higher the centre of roll, the larger the response, from 20 deg on."""
    rows = []
    for angle in ("10 deg", "20 deg", "30 deg"):
        response = {name: amplitude(outcomes, angle) for name, outcomes in found.items()}
        for name, value in response.items():
            rows.append(observed(f"{angle}, centre {name}", "", counted(value), None))
        low, high = response.get("0 mm"), response.get("500 mm")
        if found_ratio := ratio(high, low):
            quantity, source = (
                f"{angle}: 500 mm over 0 mm",
                {"10 deg": "1: no dependence", "20 deg": "5"}.get(angle, ""),
            )
            if angle == "20 deg":
                rows.append(held(quantity, source, found_ratio, FIVE, FACTOR))
            else:
                rows.append(Row(quantity, source, found_ratio.told(), found_ratio.interval(), "", None))
    key = "motion.roll.amplitude"
    return Told(
        rows,
        against(
            key,
            "amplitude of the roll (deg)",
            dict(found),
            "response_amplitude",
            "amplitude of the centre of mass (mm)",
        ),
    )


# Width and depth of the fill (mm) that the source leaves open.
TANKS = {"300 mm, 45 mm deep": (300, 45), "600 mm, 45 mm deep": (600, 45), "600 mm, 90 mm deep": (600, 90)}
DEEPEST = {"600 mm, 222 mm deep": (600, 222)}


def tank_batches(quick: bool) -> dict[str, Batch]:
    """Other tanks, rolled about the lowest and the highest centre."""
    runs = {}
    for name, (width, depth) in {**TANKS, **({} if quick else DEEPEST)}.items():
        sizes = {"tank.width": f"{width} mm", "grains.depth": f"{depth} mm", "run.repeats": 1 if quick else 2}
        sizes["tank.height"] = f"{2 * depth + 190} mm"
        for centre in (0, 500):
            runs[f"{name}, {centre} mm"] = shaken(f"shaking/roll-centre-{centre}", quick, **sizes)
    return runs


def tanks(found: Found) -> Told:
    """How much farther the centre of mass swings about the highest centre than about the lowest."""
    rows, ratios = [], {}
    for name in [key.removesuffix(", 0 mm") for key in found if key.endswith(", 0 mm")]:
        low, high = (found[f"{name}, {centre} mm"][0]["response_amplitude"] for centre in (0, 500))
        rows.append(observed(f"{name}: about 0 mm, about 500 mm", "", f"{counted(low)}, {counted(high)}", None))
        if found_ratio := ratio(high, low):
            ratios[name] = found_ratio
            rows.append(Row(f"{name}: 500 mm over 0 mm", "5", found_ratio.told(), found_ratio.interval(), "", None))
    rows.append(_spanned(ratios))
    return Told(rows)


def _spanned(ratios: Mapping[str, Estimate]) -> Row:
    """Whether the source's ratio lies between those of our tanks."""
    quantity, allowed = "5 lies between those of the tanks", "the least below 5, the largest above"
    if not ratios:
        return observed(quantity, "5", "not found", Verdict.CANNOT_TELL, allowed)
    least, most = (pick(ratios, key=lambda name: ratios[name].value) for pick in (min, max))
    verdict = together([ratios[least].lies(-np.inf, 5.0), ratios[most].lies(5.0, np.inf)])
    return observed(quantity, "5", f"{ratios[least].value:.2g} to {ratios[most].value:.2g}", verdict, allowed)


def amplitude(outcomes: Sequence[Outcome], angle: str) -> Value | None:
    """The response at an amplitude of roll."""
    return next((one["response_amplitude"] for one in outcomes if one.setting["motion.roll.amplitude"] == angle), None)


def onset(outcomes: Sequence[Outcome], tank: float) -> Value:
    """Of each bed the frequency (Hz) at which its response first exceeds ONSET of the tank's amplitude (mm).

    Between two frequencies it is taken to grow linearly; a bed that never answers has none.
    """
    frequencies = np.array([leading_number(one.setting[FREQUENCY]) for one in outcomes])
    responses = np.array(
        [[x if x is not None else np.nan for x in one["response_amplitude"].worlds] for one in outcomes]
    )
    return over_worlds([_crossing(frequencies, curve / tank) for curve in responses.T], "Hz", missing="never answers")


def _crossing(x: np.ndarray, y: np.ndarray) -> float:
    beyond = np.flatnonzero(y > ONSET)
    if not len(beyond):
        return float("nan")
    k = int(beyond[0])
    if k == 0:
        return float(x[0])
    return float(x[k - 1] + (ONSET - y[k - 1]) / (y[k] - y[k - 1]) * (x[k] - x[k - 1]))


AMPLITUDES = {"60 mm": 40.0 / 3.0, "150 mm": 100.0 / 3.0, "180 mm": 40.0}  # mm, 40 mm on 180


def scaled(found: Found) -> Told:
    """The small tank answers at a much higher frequency."""
    onsets = {name: onset(outcomes, AMPLITUDES[name]) for name, outcomes in found.items()}
    rows = [
        stated("180 mm: begins to flow at", 1.2, onsets["180 mm"], BEGINS),
        stated("150 mm: begins to flow at", 1.2, onsets["150 mm"], BEGINS),
    ]
    small, large = onsets["60 mm"], onsets["180 mm"]
    rows.append(
        observed("60 mm: begins to flow at", "later, in two steps", counted(small), falling([small, large]), ANY)
    )
    figure = against(
        FREQUENCY, "frequency (Hz)", dict(found), "response_amplitude", "amplitude of the centre of mass (mm)"
    )
    return Told(rows, figure)


def scaled_batches(quick: bool) -> dict[str, Batch]:
    """Three tanks over the frequencies; at the highest all but the smallest are long in motion."""
    runs = {}
    for name in AMPLITUDES:
        highest = 3.6 if name == "60 mm" else 2.0
        frequencies = (0.8, 1.2, 1.6, 2.8) if quick else np.arange(0.6, highest + 0.1, 0.2).round(1)
        runs[name] = shaken(f"shaking/scaling-{name.split()[0]}", quick, [f"{f:g} Hz" for f in frequencies])
    return runs


EXPERIMENTS = [
    Experiment(
        "sway-materials",
        "Sway of three ores",
        "5.2.2",
        "swayed by 100 mm at 0.2 to 1.5 Hz, A and B do not answer at 0.2 Hz; with the frequency the centre of mass "
        "swings, y with the tank's period and z with half of it, in nearly opposite phase.",
        lambda quick: materials_batches("sway", quick),
        swayed,
        f"{FEWER}; no gold ore",
        ("A", 0.7),
        "A fluid as deep as these beds sloshes at 1.91 (A), 1.53 (B) and 0.81 Hz (C): ω² = g k tanh(k h), k = π/l "
        "(Lamb 1932). What is driven below that frequency goes with the push, 360 deg, at it a quarter of a period "
        "later, 270, above it half, 180. So at 1.5 Hz A, B and C have 284, 271 and 253 deg; almost 180 deg for B, as "
        "the source has it, needs a higher frequency: see the next experiment.",
    ),
    Experiment(
        "sway-phase",
        "Phase of a swayed bed below, at and above its slosh",
        "5.2.2, where the phase is almost 180 deg",
        "the phase between the tank and the centre of mass of B is almost 180 deg at 1.5 Hz.",
        phase_batches,
        phases,
        "two frequencies for three, from the experiment before, 3 s of motion for 8",
        ("B", 0.7),
        "At 2 Hz the bed hits the walls so hard that at this softness the run stops after 2.4 s.",
    ),
    Experiment(
        "heave-materials",
        "Heave of three ores",
        "5.2.2",
        "heaved by 100 mm the grains follow the tank at 0.2 Hz; at 1.5 Hz B begins to swing up and down, A and C "
        "sideways, too.",
        lambda quick: materials_batches("heave", quick),
        heaved,
        f"{FEWER}; no gold ore",
        ("B", 0.7),
    ),
    Experiment(
        "roll-centres",
        "Centres of roll",
        "5.3.5",
        "up to 10 deg the height of the centre does not matter; at 20 deg and 1.3 Hz the response about 500 mm is "
        "five times that about 0; at 30 deg the bed is thrown from side to side.",
        lambda quick: {
            f"{centre} mm": Batch(
                f"shaking/roll-centre-{centre}",
                shaken("", quick).changes,
                {"motion.roll.amplitude": ["10 deg", "20 deg", "30 deg"]},
            )
            for centre in ((0, 500) if quick else (0, 100, 200, 500))
        },
        centres,
        "1 bed for 4, 3 s of motion for 8, both at draft accuracy; the lowest and the highest centre only",
        ("500 mm", 0.7),
        "At a height z the grains of a tank rolled about a centre at h feel a slope of φ (1 − (h − z) ω²/g) (small "
        "angles): at 1.3 Hz none at 147 mm below the centre. So about 200 mm the bed lies still, about 0 and 500 mm "
        "it flows, as the source has it; it names neither the tank nor the fill, see the next experiment. At 10 deg "
        "nothing slides: the amplitudes are less than a fifth of a grain.",
    ),
    Experiment(
        "roll-tanks",
        "Centres of roll in other tanks",
        "5.3.5, which does not tell the tank",
        "at 20 deg and 1.3 Hz the response about 500 mm is five times that about 0.",
        tank_batches,
        tanks,
        "1 bed for 2, 3 s of motion for 8; not the deepest",
        ("600 mm, 45 mm deep, 500 mm", 0.7),
    ),
    Experiment(
        "sway-scaling",
        "Sway of similar tanks",
        "5.4.1",
        "tanks of 60, 150 and 180 mm, lined with grains, swayed in proportion (40 mm on 180): the larger two begin "
        "to flow at about 1.2 Hz, the smallest much later, with a lower minor step.",
        scaled_batches,
        scaled,
        "1 bed for 4, 3 s of motion for 8, 4 frequencies for 8 or 16, both at draft accuracy",
        ("180 mm", 0.7),
        "With the amplitude scaled to the width, accelerations are alike at frequencies as 1/√width (Froude): from the "
        "largest tank's onset 1.10 and 1.73 times as high in the others, so tanks of 150 and 180 mm cannot begin at "
        "quite the same one. The smaller come later still, as their angles of repose are larger (5.4.2). Flow begins "
        "here where the response exceeds 2 % of the tank's amplitude; at 1.2 Hz A ω²/g of the largest is tan 13 deg, "
        "less than any tilt at which these beds slide.",
    ),
]
