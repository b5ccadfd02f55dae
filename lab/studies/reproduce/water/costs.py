"""What a run of water cost."""

from lab.studies.reproduce.runs import Outcome

COSTS = ("run", "particles", "steps", "time step", "time")


def cost(label: str, one: Outcome) -> list[str]:
    """The cells of a run: its name, particles of both phases, steps, mean step and time with compiling and output.

    The steps are those of particles: an empty tank has none.
    """
    recording, wall = one.recording, f"{one.cost['wall_s']:.0f} s"
    particles = recording.volume.shape[1] + recording.air_volume.shape[1]
    if not particles:
        return [label, "0", "none", "none", wall]
    steps = one.cost["grain_steps"] / particles
    mean = 1e6 * float(recording.series["time"][-1]) / steps
    return [label, f"{particles}", f"{steps:.0f}", f"{mean:.3g} µs", wall]
