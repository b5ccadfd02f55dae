"""Run the notebooks and keep what they show: `make notebooks`, or `python docs/notebooks/execute.py hopper`.

Each runs in a kernel of its own, in an empty folder. Of its outputs are kept those that a second run would show again:
no progress bars, no times of cells. Pictures are kept with 128 colours. A notebook that raises, warns or shows where
on this machine it ran is refused.
"""

import io
import re
import sys
import tempfile
from base64 import b64decode, b64encode
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from PIL import Image

HERE = Path(__file__).parent
LONGEST = 900  # s of a cell
COLOURS = 128
BAR = "progress of a run"  # the plain text of a bar
MACHINE = re.compile(r"/(?:tmp|home|root|work|Users|var|mnt|usr)/")


def executed(path: Path) -> nbformat.NotebookNode:
    """A notebook with the outputs of a run. Raises ValueError for outputs that are not to be kept."""
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        where = {"metadata": {"path": folder}}
        NotebookClient(notebook, timeout=LONGEST, kernel_name="python3", resources=where).execute()
    for cell in notebook.cells:
        cell.metadata = nbformat.NotebookNode()
        if cell.cell_type == "code":
            cell.outputs = [kept(output) for output in cell.outputs if output.get("data", {}).get("text/plain") != BAR]
    notebook.metadata.language_info = nbformat.NotebookNode(name="python")
    return notebook


def kept(output: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """An output as it is kept."""
    if output.get("name") == "stderr":
        raise ValueError(f"it warns: {output.text}")
    output.pop("transient", None)
    if "data" in output:
        output.metadata = nbformat.NotebookNode()
        if "image/png" in output.data:
            output.data["image/png"] = small(output.data["image/png"])
    said = [output.get("text", ""), *(text for kind, text in output.get("data", {}).items() if "image" not in kind)]
    if found := MACHINE.search("\n".join(said)):
        raise ValueError(f"it shows a path of this machine, {found[0]}…: give it a path in its own folder")
    return output


def small(picture: str) -> str:
    """A PNG, in base64, with few colours."""
    found, made = Image.open(io.BytesIO(b64decode(picture))).convert("RGB"), io.BytesIO()
    found.quantize(COLOURS, dither=Image.Dither.NONE).save(made, "PNG", optimize=True)
    return b64encode(made.getvalue()).decode("ascii")


def main(names: list[str]) -> None:
    """Run the named notebooks, or all, each in its place."""
    for path in [HERE / f"{name}.ipynb" for name in names] or sorted(HERE.glob("*.ipynb")):
        print(f"{path.stem} …", flush=True)
        nbformat.write(executed(path), path)


if __name__ == "__main__":
    main(sys.argv[1:])
