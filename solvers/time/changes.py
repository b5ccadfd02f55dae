"""Moments at which what a matter is made of changes: a run stops there, and goes on with other numbers."""


def up_to_change(run, target: int) -> int:
    """The base step, at most `target`, up to which a `solvers.simulation.Simulation` may run as it is.

    Matters whose moment has come change first; from there on steps are base steps, until the lists are rebuilt. While
    a run settles its clock has not started, and nothing changes.
    """
    for matter in run.matters.values() if run.origin == 0.0 else ():
        if run.steps >= matter.changes:
            matter.change()
            run.clock.multiple.fill(1)
        target = min(target, matter.changes)
    return target
