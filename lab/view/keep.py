"""Make video, figures and summary of a kept live experiment, in a separate process."""

import sys
from pathlib import Path

from lab.base.progress import Progress
from lab.runs.runner import report

if __name__ == "__main__":
    with Progress(quiet=True) as progress:
        report(Path(sys.argv[1]), progress, video=True)
