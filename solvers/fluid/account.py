"""The account of the water: its quantities, with all energies that it has and has lost."""

import numpy as np

from solvers.machine.quantity import directions


def quantities_of(matter, time: float) -> dict[str, np.ndarray]:
    """The quantities of a `solvers.fluid.matter.WaterMatter` at its time (s): (W, *shape) of each by name."""
    sums, thick = matter.diagnostics.sums_at(time, matter.thickness), matter.thickness
    mass = np.maximum(sums["mass"], 1e-300)  # of both phases
    axes = directions(matter.particles.axes)
    centre = np.stack([sums[f"moment_{name}"] for name in axes], axis=1) / mass[:, None]
    down = np.stack(matter.diagnostics.pulls(), axis=1) / max(matter.scene.gravity, 1e-300)
    height = matter.diagnostics.now[-1].to_numpy()
    potential = sums["mass"] * matter.scene.gravity * (height - (centre * down).sum(axis=1)) + sums["pulled"]
    potential += matter.scene.gravity * matter.diagnostics.buoyed(sums, down)
    late = matter.diagnostics.behind.to_numpy()
    (viscous, stored, work), by_parts = matter.forces.counted(late), matter.bodies.work_until(late)
    viscous += matter.damping.total(len(viscous))
    rows = {
        **matter.diagnostics.of_water(sums, mass, centre),
        "water_momentum": np.stack([sums[f"momentum_{name}"] for name in axes], axis=1),
        "water_kinetic": sums["flowing"],
        "water_potential": potential,
        "water_elastic": sums["elastic"],
        "water_total": sums["moving"] + potential + sums["elastic"],
        "water_viscous": viscous * thick,
        "water_diffusive": thick * matter.continuity.diffused.to_numpy().reshape(len(mass), -1).sum(axis=1),
        "water_work": (work + by_parts.sum(axis=1)) * thick,
        "water_wall_energy": stored * thick,
        "water_density_deviation": sums["deviation"],
        "level_depth": matter.diagnostics.gauges.read(),
        "water_escaped": sums["escaped"],
        **matter.gauges.read_and_reset(),
        **matter.edges.read_and_reset(),
        **(matter.inflow.read(thick) if matter.inflow else {}),
        **matter.bodies.read_and_reset(time, thick, by_parts),
    }
    return rows


def snapshot_of(matter, time: float) -> dict[str, np.ndarray]:
    """What is known of each particle of a `solvers.fluid.matter.WaterMatter` at `time` (s), which must be now.

    Places, velocities relative to the tank (W, n, 2) and pressures (W, n), between grains the porosity (W, n).
    """
    p = matter.particles
    vectors = p.place, p.velocity, p.acceleration, [p.deviation]
    place, velocity, push, [deviation] = (p.read(*fields) for fields in vectors)
    told = {
        "position": np.stack(place, axis=-1),
        "velocity": matter.diagnostics.relative(time, place, velocity, push, matter.gas),
        "pressure": matter.diagnostics.whole(matter.constants.pressures(deviation, matter.gas), place),
    }
    rows = {f"{phase}_{name}": told[name][:, part] for phase, part in matter.phases.items() for name in told}
    if p.porous:
        [porosity] = p.read(p.porosity)
        rows["water_porosity"] = np.where(porosity > 0.0, porosity, 1.0)  # not known before the first step
    return rows
