"""Diffusion of density by name: what is diffused, and whether renormalised gradients correct it."""

from solvers.fluid.diffusion.antuono import Antuono
from solvers.fluid.diffusion.fourtakas import Fourtakas
from solvers.fluid.diffusion.molteni import Molteni
from solvers.fluid.diffusion.none import NoDiffusion

DIFFUSION = {"antuono": Antuono, "fourtakas": Fourtakas, "molteni": Molteni, "none": NoDiffusion}
