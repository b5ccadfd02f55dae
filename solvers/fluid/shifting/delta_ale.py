"""x"""

from solvers.fluid.shifting.delta_plus import DeltaPlus


class DeltaAle(DeltaPlus):
    """x"""

    flows = True
    weighs = 1.0


class Sun(DeltaPlus):
    """x"""

    flows = True
    weighs = 0.0
