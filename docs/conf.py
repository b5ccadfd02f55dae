"""How the pages are built: `make docs`. They are viewed without a network: no script or font comes from elsewhere."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent)]

from lab import __version__  # noqa: E402

project = "Cargo Shift Lab"
copyright = "the Cargo Shift Lab authors, MIT"
version = release = __version__

extensions = ["myst_nb", "insert", "mathml"]
exclude_patterns = ["_build", "_ext"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
nitpicky = True
myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_links_external_new_tab = False
suppress_warnings = ["myst.header"]  # pages of results begin some parts two levels down

nb_execution_mode = "off"  # pages show the outputs that are kept: `make notebooks`
html_math_renderer = "mathml"

html_theme = "furo"
html_title = f"Cargo Shift Lab {version}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_show_sourcelink = False
html_copy_source = False
linkcheck_timeout = 20
linkcheck_retries = 2
