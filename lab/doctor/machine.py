"""What the lab finds on a machine, and what follows from it; nothing is run or changed."""

import importlib.util
import os
import platform
import shutil
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from lab import __version__
from lab.base.caches import lacking
from lab.base.memory import machine_memory

GOOD, SLOWER, MISSING = "good", "slower", "missing"
LITTLE_DISK, LITTLE_MEMORY = 2 * 2**30, 2 * 2**30  # bytes
EXTRAS = {  # packages that few need, what they are for, and the extra that brings them
    "weasyprint": ("PDF of `cargolab report`", "pdf"),
    "capytaine": ('ships in space (ship.hydrodynamics = "hull")', "ship3d"),
    "distributed": ("sweeps on a cluster (--cluster)", "cluster"),
    "gsd": ("`cargolab export --to gsd`", "export"),
    "h5netcdf": ("`cargolab export --to netcdf`", "export"),
}


@dataclass(frozen=True)
class Examined:
    """What was looked at, what was found, how good that is, and what follows."""

    what: str
    found: str
    verdict: str = GOOD
    follows: str = ""


def examine(folder: Path | None = None) -> list[Examined]:
    """All findings, in the order in which they are told. folder: where results would be written."""
    looks: tuple[Callable[[], Examined], ...] = (
        _python,
        _cores,
        _vectors,
        _memory,
        _cuda,
        _vulkan,
        _display,
        _ffmpeg,
        _cache,
        lambda: _disk(folder or Path.cwd()),
        _compiling,
    )
    return [*(look() for look in looks), *_extras()]


def as_objects(findings: list[Examined]) -> list[dict[str, str]]:
    """The findings as JSON has them."""
    return [asdict(one) for one in findings]


def told(findings: list[Examined]) -> str:
    """The findings as lines of text."""
    width = max(len(one.what) for one in findings)
    lines = []
    for one in findings:
        mark = {GOOD: " ", SLOWER: "~", MISSING: "-"}[one.verdict]
        lines.append(f"{mark} {one.what:<{width}}  {one.found}{f': {one.follows}' if one.follows else ''}")
    return "\n".join(lines) + "\n"


def _python() -> Examined:
    return Examined(
        "lab", f"{__version__}, Python {platform.python_version()}, {platform.system()} {platform.machine()}"
    )


def _cores() -> Examined:
    from solvers.machine.runtime import available_cores

    here, whole = available_cores(), os.cpu_count() or 1
    follows = "" if here > 1 else "several beds run one after the other, and films are painted after the run"
    of_all = f" of {whole}" if whole != here else ""
    return Examined("cores", f"{here}{of_all} may be used", GOOD if here > 1 else SLOWER, follows)


def _vectors() -> Examined:
    from solvers.machine.wide import registers

    bits = registers()
    if bits:
        return Examined("vectors", f"{'AVX-512' if bits >= 512 else 'AVX2'}, registers of {bits} bits")
    return Examined(
        "vectors",
        "none that the lab uses",
        SLOWER,
        "grains and water are computed number by number, which takes longer",
    )


def _memory() -> Examined:
    size = machine_memory()
    follows = "" if size > LITTLE_MEMORY else "large tanks of water do not fit; half of it may be used by a run"
    return Examined("memory", f"{size / 2**30:.1f} GiB", GOOD if size > LITTLE_MEMORY else SLOWER, follows)


def _cuda() -> Examined:
    from solvers.machine.runtime import has_cuda

    if has_cuda():
        return Examined("CUDA", "there is a device", GOOD, "large scenes run on it (run.arch)")
    return Examined("CUDA", "no device", MISSING, "all runs on the cores, which suits most presets")


def _vulkan() -> Examined:
    from solvers.machine.runtime import has_vulkan

    if has_vulkan():
        return Examined("Vulkan", "there is a device", GOOD, "grains in 32 bits run on it, and the faster window")
    return Examined("Vulkan", "no device", MISSING, "`cargolab view` draws its window by the processor")


def _display() -> Examined:
    from lab.view.windows import has_display

    if has_display():
        return Examined("display", "there is one")
    return Examined("display", "none", MISSING, "`cargolab view` opens no window; films need none")


def _ffmpeg() -> Examined:
    from lab.paint.encoder import ffmpeg

    try:
        return Examined("ffmpeg", ffmpeg())
    except Exception as error:
        said = (str(error).splitlines() or ["?"])[0]
        return Examined("ffmpeg", "none", MISSING, f"no films, but single pictures by `render --png` ({said})")


def _cache() -> Examined:
    from lab.doctor.cache import size_of, stores

    if said := lacking():
        return Examined("cache", "no folder", SLOWER, said.removesuffix("."))
    whole = sum(size_of(store.folder) for store in stores())
    return Examined("cache", f"{whole / 2**20:.0f} MiB", GOOD, "`cargolab cache` shows it")


def _disk(folder: Path) -> Examined:
    free = shutil.disk_usage(folder).free
    follows = "" if free > LITTLE_DISK else "a run of many pictures may not fit; choose another folder with --out"
    return Examined("disk", f"{free / 2**30:.1f} GiB free here", GOOD if free > LITTLE_DISK else SLOWER, follows)


def _compiling() -> Examined:
    from solvers.machine.compiling import quick

    if quick():
        return Examined(
            "kernels", "CARGOLAB_COMPILE=quick", SLOWER, "they compile in half the time and run a fifth slower"
        )
    return Examined(
        "kernels", "compiled to run fast", GOOD, "new ones take seconds for grains, half a minute for water"
    )


def _extras() -> list[Examined]:
    found = []
    for package, (purpose, extra) in EXTRAS.items():
        if importlib.util.find_spec(package) is not None:
            found.append(Examined(package, "installed"))
        else:
            remedy = f"pip install 'cargo-shift-lab[{extra}]' for {purpose}"
            found.append(Examined(package, "not installed", MISSING, remedy))
    return found


def works() -> bool:
    """Whether a run is possible at all: Taichi is there for this Python."""
    return importlib.util.find_spec("taichi") is not None and sys.version_info[:2] < (3, 14)
