"""Arrays that a study needs again, kept in its folder."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from lab.base.files import replacing
from lab.recording import versions
from lab.report.kept import processor
from lab.studies.engine import code

MADE = "made by"  # the name under which a file says what made it


def remembered(path: Path, said: str, make: Callable[[], Mapping[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Arrays by name from a .npz file; where it is missing this is `said`, and they are made and put there.

    So they are where another code, other packages or another processor made them: a study would tell them as its own.
    """
    here = f"{code()} {sorted(versions().items())} {processor()}"
    if path.is_file():
        with np.load(path) as found:
            arrays = dict(found)
        if str(arrays.pop(MADE, "")) == here:
            return arrays
        said = f"{said}, anew: what was kept was made by other code or on another machine"
    print(said, flush=True)
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as part:
        np.savez(part, **make(), **{MADE: np.array(here)})
    with np.load(path) as found:
        return {name: values for name, values in found.items() if name != MADE}
