"""What xarray is told of a quantity beside its numbers, in words that files can hold."""

from solvers.machine.quantity import Quantity


def attributes(quantity: Quantity) -> dict[str, object]:
    """Of a quantity's array: `long_name`, `units` where all components have one, else `component_units`, and more.

    `units` is one that pint reads. `cell_methods` is by the CF conventions: a mean over the time since the last sample,
    or the value of the instant; `never` stands for "has not happened".
    """
    units = quantity.units
    found: dict[str, object] = {"long_name": quantity.label}
    found |= {"units": units[0]} if len(set(units)) == 1 else {"component_units": ", ".join(units)}
    if quantity.name != "time":
        found["mean_over_sample"] = int(quantity.mean)
        found["cell_methods"] = "time: mean" if quantity.mean else "time: point"
    if quantity.never is not None:
        found["never"] = float(quantity.never)
    return found
