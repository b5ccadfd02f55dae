"""cargolab bench gpu: the same grains, spheres and water on GPUs and on the CPU, compared in results and in speed."""

from functools import partial
from pathlib import Path

from benchmarks.bench import Bench
from benchmarks.devices import Device, device
from benchmarks.gpu import grains, water
from lab.base.errors import LabError
from lab.report.page import Page
from solvers.machine import runtime
from solvers.machine.errors import Unavailable

ARCHES = {"cuda": ("f64", "mixed", "f32"), "vulkan": ("f32",)}
MATTERS = {"grains": grains.DISCS, "spheres": grains.SPHERES, "water": water}
STUDIES = (("cuda", "grains"), ("cuda", "spheres"), ("cuda", "water"), ("vulkan", "grains"), ("vulkan", "spheres"))


def study(page: Page, work: Path, fast: bool, arch: str, matter: str) -> None:
    """Add the section on a matter on one kind of device to the page."""
    precisions = ARCHES[arch]
    page.section(f"{matter.capitalize()} on {arch.upper() if arch == 'cuda' else arch.capitalize()}")
    found, why_not = there(arch, precisions[-1])
    if found is None:
        page.say(f"Not run: {why_not}")
        return
    page.say(f"Device: {found.name}{', which is software on the processor' if found.software else ''}.")
    if found.software and not fast:
        page.say("""Not run: there is no graphics processor here, and software is none; `cargolab bench gpu --fast`
            tries it on small beds.""")
        return
    of_matter = MATTERS[matter]
    try:
        of_matter.correctness(page, work, arch, precisions)
        of_matter.speed(page, work, arch, precisions, fast)
    except LabError as error:
        page.say(f"It broke off: {error}")


def there(arch: str, precision: str) -> tuple[Device | None, str]:
    """The device of an arch, or none and the reason in a sentence."""
    try:
        runtime.choose_arch(arch, precision)
    except Unavailable as error:
        return None, str(error)
    found = device(arch)
    return found, "" if found else f"the driver of {arch} tells of no device."


ABOUT = """Grains in the plane, spheres in space and water, particle by particle, each on its own, with a launch a step
(schedule per-grain): first whether a device gives what the processor gives, then how fast it is. M stands for a
million particle-steps a second, of grains or of particles of water; speeds are medians of several turns. What was not
run on a graphics processor is marked so. Water runs on CUDA alone: Taichi 1.7.4 cannot compile its kernels for
Vulkan."""
BENCH = Bench(
    "gpu",
    "Graphics processors",
    {f"{arch}-{matter}": partial(study, arch=arch, matter=matter) for arch, matter in STUDIES},
    ABOUT,
)
