"""The physics manual is made of docstrings: each law has formula, source, limits and units; formulas are set."""

import re
import sys
from pathlib import Path

import pytest

from solvers.fluid.diffusion import DIFFUSION
from solvers.fluid.kernels import KERNELS
from solvers.fluid.shifting import SHIFTING
from solvers.fluid.states import STATES
from solvers.fluid.viscosity import VISCOSITY
from solvers.grains.integrators import INTEGRATORS
from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL
from solvers.motion import IN_SPACE, MOTIONS

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "_ext"))
from docstrings import headline, in_markdown, text_of, things  # noqa: E402
from formula import inline, mathml  # noqa: E402

TABLES = {
    "NORMAL": NORMAL,
    "TANGENTIAL": TANGENTIAL,
    "ROLLING": ROLLING,
    "COHESION": COHESION,
    "INTEGRATORS": INTEGRATORS,
    "MOTIONS": MOTIONS,
    "IN_SPACE": IN_SPACE,
    "KERNELS": KERNELS,
    "STATES": STATES,
    "DIFFUSION": DIFFUSION,
    "VISCOSITY": VISCOSITY,
    "SHIFTING": SHIFTING,
}
LAWS = [(table, name, law) for table, laws in TABLES.items() for name, law in laws.items()]
IN_WORDS = re.compile(r"[A-Z]\w+ (?:and \w+ |et al\. )?\(?(1[6-9]|20)\d\d")  # an author with a year


@pytest.mark.parametrize(("table", "name", "law"), LAWS, ids=[f"{table}-{name}" for table, name, _ in LAWS])
def test_every_law_has_formula_source_limits_and_units(table, name, law):
    """Where a law needs no source, "Source: none is needed" gives the reason."""
    text = text_of(law)
    formula, source, _ = headline(re.split(r"\n\s*\n", text)[0])
    assert "=" in formula and "<math" in mathml(formula)
    assert source or IN_WORDS.search(text) or re.search(r"Source: none is needed, \w+", text)
    assert re.search(r"\n\nLimits: \S", text) and re.search(r"\n\nUnits: \S", text)


def test_every_table_of_laws_is_in_the_manual():
    asked = " ".join(path.read_text(encoding="utf-8") for path in sorted((DOCS / "physics").rglob("*.md")))
    assert [table for table in TABLES if not re.search(rf"registry \S+ {table} ", asked)] == []


def test_every_module_of_a_ships_physics_is_in_the_manual():
    pages = [path for folder in ("physics", "naval") for path in sorted((DOCS / folder).rglob("*.md"))]
    asked = " ".join(path.read_text(encoding="utf-8") for path in pages)
    modules = [path for path in (DOCS.parent / "solvers" / "ship").rglob("*.py") if path.name != "__init__.py"]
    plain = {"panels", "quantities", "vessel"}  # what they say is no physics
    missing = [path.stem for path in modules if not re.search(rf"\.{path.stem}\b", asked)]
    assert set(missing) - plain == set()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("ξ^(3/2)", "<msup><mrow><mi>ξ</mi></mrow><mrow><mrow><mn>3</mn>"),
        ("a b/c", "<mi>a</mi><mfrac><mrow><mi>b</mi></mrow><mrow><mi>c</mi></mrow></mfrac>"),
        ("a/2h", "<mfrac><mrow><mi>a</mi></mrow><mrow><mn>2</mn><mi>h</mi></mrow></mfrac>"),
        ("cos μ(y−η) / (μ−K)", '<mi>η</mi><mo>)</mo></mrow><mo stretchy="false">/</mo><mrow><mo>(</mo>'),
        ("F_n²", "<msubsup>"),
        ("√(g h)", "<msqrt><mrow><mi>g</mi><mi>h</mi></mrow></msqrt>"),
        ("[[a, 0], [0, b]]", "<mtr><mtd><mrow><mn>0</mn></mrow></mtd><mtd><mrow><mi>b</mi></mrow></mtd></mtr>"),
    ],
)
def test_a_formula_is_set_as_it_is_meant(text, said):
    """A stroke divides what stands side by side with it; with spaces around it, it stays as it is written."""
    assert said in mathml(text)


@pytest.mark.parametrize("text", ["a (b", "a) b", "a_", "√"])
def test_a_formula_that_is_not_one_is_refused(text):
    with pytest.raises(ValueError):
        mathml(text)


def test_a_sentence_has_its_indices_lowered_and_its_signs_kept():
    said = inline("|F_t| ≤ μ F_n, e^(i(ky − ωt)), E* and `u_s` <1")
    assert said == ("&#124;F<sub>t</sub>&#124; ≤ μ F<sub>n</sub>, e<sup>i(ky − ωt)</sup>, E&#42; and `u_s` &lt;1")


def test_a_docstring_becomes_formula_source_and_sentences():
    class Law:
        """F = k ξ (Hooke 1678): a spring.

        Limits: small ξ.
        """

    formula, source, rest, limits = in_markdown(text_of(Law)).split("\n\n")
    assert "<math" in formula and source == "*Source:* Hooke 1678."
    assert (rest, limits) == ("A spring.", "*Limits:* small ξ.")


def test_an_entry_of_a_list_has_its_formula_set_unless_it_is_a_sentence():
    assert "<math" in things("solvers.mixture.drag.ergun", "Ergun")
    assert "<math" not in things("solvers.ship.naval.grain_code", "heeling_arm")
