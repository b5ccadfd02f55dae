"""Formulas in LaTeX, between $ or $$ of a page, set as MathML when the pages are built: no script is loaded."""

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.writers.html5 import HTML5Translator


def mathml(latex: str, display: str) -> str:
    """LaTeX as MathML; `display`: inline or block. Raises ExtensionError for what it does not understand."""
    try:
        return convert(latex, display=display)
    except Exception as error:  # the library's errors have no class in common
        raise ExtensionError(f"no formula can be made of {latex!r}: {error}") from error


def inline(translator: HTML5Translator, node: nodes.math) -> None:
    """A formula in a sentence."""
    translator.body.append(mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """A formula on a line of its own, as those of docstrings."""
    translator.body.append(f'<div class="formula">{mathml(node.astext(), "block")}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx calls this."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
