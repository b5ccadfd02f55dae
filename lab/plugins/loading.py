"""Loading plug-ins, and leave to do so.

A preset names them in `plugins`: paths, or names of entry points of installed packages (group `cargolab.plugins`). A
file is code that would run, so it is loaded only where the user allows it (`allow`, `--plugins`), and each recording
keeps the hash of what was loaded (`hashes`).
"""

import os
import sys
from collections.abc import Callable, Sequence
from hashlib import blake2b
from importlib.metadata import entry_points
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

from lab.base.errors import LabError
from lab.base.files import read_bytes
from lab.plugins.guard import told, within

GROUP = "cargolab.plugins"  # of entry points
ALLOWED = "CARGOLAB_PLUGINS"  # the environment variable by which a process allows its children what it was allowed
LARGEST = 1_000_000  # bytes

hashes: dict[str, str] = {}  # of what was loaded, by the name of the file, package or notebook
asking: list[Callable[[str], bool]] = []  # at a terminal: the function that asks the user, put there by the command
_loaded: dict[str, str] = {}  # the hash of each file, by its path
_loading: list[str] = []  # the name of the plug-in that is being loaded


def allow() -> None:
    """Let the plug-ins that presets name be loaded, in this process and its children."""
    os.environ[ALLOWED] = "1"


def admit(names: Sequence[str]) -> None:
    """Load the plug-ins that a preset names, each once. Raises LabError, one sentence."""
    for name in names:
        if not isinstance(name, str):
            raise LabError("plugins: a list of files, or of names of installed plug-ins, is needed.")
        if name.endswith(".py"):
            _admit_file(name)
        elif name not in hashes:
            _admit_package(name)


def load_file(path: Path | str) -> None:
    """Load a plug-in that the user names, which is leave to run it. Raises LabError."""
    where, content = _content(str(path))
    _load(where, content)


def _admit_file(path: str) -> None:
    where, content = _content(path)
    if _loaded.get(where) == _hash(content):
        return
    if not (os.environ.get(ALLOWED) or any(ask(where) for ask in asking)):
        raise LabError(
            f"plugins: {where} is code that would run: look at it, and allow it with --plugins (in Python: "
            "cargolab.plugin of its path)."
        )
    _load(where, content)


def _content(path: str) -> tuple[str, bytes]:
    """The whole path of a file, and what is in it."""
    where = os.path.abspath(path)
    try:
        content = read_bytes(where, LARGEST + 1)
    except OSError as error:
        raise LabError(f"plugins: {where} cannot be read ({error.strerror}): put it there, or leave it out.") from None
    if content is None or len(content) > LARGEST:
        raise LabError(f"plugins: {where} is no file of Python.")
    return where, content


def _load(where: str, content: bytes) -> None:
    name = Path(where).name
    spec = spec_from_file_location(f"cargolab_plugin_{Path(where).stem}_{_hash(content)}", where)
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # Taichi asks for the source of its functions there
    _loading.append(name)
    try:
        with within():
            spec.loader.exec_module(module)
    except LabError as error:
        raise LabError(f"{where}: {error}") from None
    except Exception as error:
        raise LabError(f"{where}: cannot be loaded: {told(error)}.") from error
    finally:
        _loading.pop()
    _loaded[where] = hashes[name] = _hash(content)


def _admit_package(name: str) -> None:
    """Load an entry point; who installed its package has allowed it."""
    found = [one for one in entry_points(group=GROUP) if one.name == name]
    if not found:
        known = ", ".join(sorted(one.name for one in entry_points(group=GROUP))) or "none"
        raise LabError(f"plugins: no plug-in {name!r} is installed (there are {known}); a file ends in .py.")
    _loading.append(name)
    try:
        found[0].load()
    except Exception as error:
        raise LabError(f"plugins: {name}: cannot be loaded: {told(error)}.") from error
    finally:
        _loading.pop()
    hashes[name] = getattr(found[0].dist, "version", "unknown")


def owner(function: object) -> str:
    """The plug-in that a function is of; one from elsewhere, as a notebook, is noted with the hash of its source."""
    if _loading:
        return _loading[-1]
    from inspect import getsource

    name = f"{getattr(function, '__module__', '')}.{getattr(function, '__qualname__', type(function).__name__)}"
    try:
        hashes[name] = _hash(getsource(function).encode())
    except (OSError, TypeError):
        hashes[name] = "unknown"
    return name


def local() -> bool:
    """Whether something is registered that another process cannot load: it was defined in a notebook or a script."""
    return any(not name.endswith(".py") and "." in name for name in hashes)


def _hash(content: bytes) -> str:
    return blake2b(content, digest_size=16).hexdigest()
