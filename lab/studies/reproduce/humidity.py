"""Humid air: the pull of capillary bridges against the angle of repose."""

from collections.abc import Mapping, Sequence

from lab.measures.value import Value
from lab.studies.reproduce.curves import against
from lab.studies.reproduce.estimates import Verdict, difference
from lab.studies.reproduce.experiment import ONE_BED, Experiment, Row, Told, counted, less, observed
from lab.studies.reproduce.runs import Batch, Outcome
from lab.studies.reproduce.tilting import ANGLE_RATE, tilted

KEY = "material.humidity"
LAWS = {"as printed": "wet", "with asperities of 1 nm": "wet-rough"}
DRY = "dry"


def batches(quick: bool) -> dict[str, Batch]:
    """Both readings over the humidity, and the same bed dry; for the one without a threshold two humidities suffice."""
    ends, between = ["50 %", "90 %"], ["50 %", "60 %", "65 %", "70 %", "80 %", "90 %"]
    runs = {DRY: tilted("tilting/wet", quick, rate=ANGLE_RATE, **{"contact.cohesion": "none"})}
    for says, name in list(LAWS.items())[quick:]:
        humidities = between if name == "wet-rough" and not quick else ends
        runs[says] = Batch(f"tilting/{name}", tilted("", quick, rate=ANGLE_RATE).changes, {KEY: humidities})
    return runs


def tell(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """No effect below some 60 %, by either reading."""
    dry = found[DRY][0]["critical_angle"]
    rows = [observed("dry", "", counted(dry), None)]
    for says in (name for name in LAWS if name in found):
        for one in found[says]:
            rows.append(_row(f"{says}, {one.setting[KEY]}", one, dry))
    families = {says: outcomes for says, outcomes in found.items() if says != DRY}
    figure = against(KEY, "humidity (%)", families, "critical_angle", "critical angle (deg)")
    if dry and dry.value is not None:
        figure.axes[0].axhline(dry.value, color="0.5", ls=":", lw=1.0, label="dry")
    return Told(rows, figure)


def _row(quantity: str, one: Outcome, dry: Value | None) -> Row:
    """Below a humidity of 60 % beside the dry bed."""
    angle = one["critical_angle"]
    if float(str(one.setting[KEY]).split()[0]) >= 60.0:
        return observed(quantity, "", counted(angle), None)
    apart = difference(angle, dry)
    verdict = Verdict.CANNOT_TELL if apart is None else apart.lies(-ONE_BED.within, ONE_BED.within)
    text = "" if apart is None else less(apart, "deg")
    return Row(quantity, "as dry", counted(angle), text, ONE_BED.words("deg"), verdict)


EXPERIMENTS = [
    Experiment(
        "tilt-humidity",
        "Tilt in humid air",
        "4.2.2 and 7.3.3",
        "below a humidity of about 60 % wet and dry cargo behave alike in the tilting box.",
        batches,
        tell,
        "the law with asperities only, 2 beds for 4, two humidities for six, 20 deg/s for 5, draft accuracy",
        ("with asperities of 1 nm", 0.8),
        "As the law is printed, the pull of touching grains does not depend on the humidity, which sets its range "
        "alone; so it cannot have a threshold, but four beds at 50 % scatter too much to show that. Asperities, our "
        "addition, give it one.",
    )
]
