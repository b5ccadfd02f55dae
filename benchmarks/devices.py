"""The graphics processors of this machine, with the names that their drivers give."""

import ctypes
import sys
from dataclasses import dataclass
from functools import cache

CUDA = "nvcuda.dll" if sys.platform == "win32" else "libcuda.so.1"
VULKAN = "vulkan-1.dll" if sys.platform == "win32" else "libvulkan.so.1"
NAME = 256  # bytes, of a name in either
# Of VkPhysicalDeviceType, in the order in which Taichi takes them: discrete, integrated, virtual, other, a processor.
TAKEN_FIRST = (2, 1, 3, 0, 4)
A_PROCESSOR = 4
PROPERTIES = 4096  # bytes; VkPhysicalDeviceProperties has 824


@dataclass(frozen=True)
class Device:
    """A device's name, and whether the processor does its work in software."""

    name: str
    software: bool = False


def device(arch: str) -> Device | None:
    """The device that an arch, "cuda" or "vulkan", computes on; None if its driver tells of none."""
    found = _cuda_devices() if arch == "cuda" else _vulkan_devices()
    return found[0] if found else None


@cache
def _cuda_devices() -> list[Device]:
    """The devices in the order of the CUDA driver."""
    try:
        driver = ctypes.CDLL(CUDA)
    except OSError:
        return []
    number, name = ctypes.c_int(0), ctypes.create_string_buffer(NAME)
    if driver.cuInit(0) or driver.cuDeviceGetCount(ctypes.byref(number)):
        return []
    found = []
    for index in range(number.value):
        handle = ctypes.c_int()
        if not driver.cuDeviceGet(ctypes.byref(handle), index) and not driver.cuDeviceGetName(name, NAME, handle):
            found.append(Device(name.value.decode(errors="replace")))
    return found


class _Create(ctypes.Structure):
    """VkInstanceCreateInfo; of the application, layers and extensions nothing is said."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("next", ctypes.c_void_p),
        ("flags", ctypes.c_uint32),
        ("application", ctypes.c_void_p),
        ("layers", ctypes.c_uint32),
        ("layer_names", ctypes.c_void_p),
        ("extensions", ctypes.c_uint32),
        ("extension_names", ctypes.c_void_p),
    )


@cache
def _vulkan_devices() -> list[Device]:
    """The devices of Vulkan, the one that Taichi takes first."""
    try:
        loader = ctypes.CDLL(VULKAN)
    except OSError:
        return []
    instance, number = ctypes.c_void_p(), ctypes.c_uint32(0)
    if loader.vkCreateInstance(ctypes.byref(_Create(type=1)), None, ctypes.byref(instance)):
        return []
    try:
        loader.vkEnumeratePhysicalDevices(instance, ctypes.byref(number), None)
        handles = (ctypes.c_void_p * number.value)()
        loader.vkEnumeratePhysicalDevices(instance, ctypes.byref(number), handles)
        kinds = sorted((_vulkan_properties(loader, handle) for handle in handles), key=lambda found: found[0])
    finally:
        loader.vkDestroyInstance(instance, None)
    return [found for _, found in kinds]


def _vulkan_properties(loader: ctypes.CDLL, handle: int) -> tuple[int, Device]:
    """A device, and its place in the order in which Taichi takes them."""
    held = ctypes.create_string_buffer(PROPERTIES)
    loader.vkGetPhysicalDeviceProperties(ctypes.c_void_p(handle), held)
    # Versions of the interface and the driver, vendor, device and kind, 4 bytes each, and the name.
    kind = int.from_bytes(held[16:20], sys.byteorder)
    name = held[20 : 20 + NAME].split(b"\0", 1)[0].decode(errors="replace")
    return TAKEN_FIRST.index(kind), Device(name, kind == A_PROCESSOR)
