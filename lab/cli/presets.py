"""Commands on what presets are made of: their keys, cargoes, and outlines of grains."""

from pathlib import Path

import click

from lab.base.data import PRESETS
from lab.cli.options import FilePath, json_option, tell, tell_json


@click.command()
@click.option("--reference", "page", is_flag=True, help="The reference of all keys as a page in Markdown instead.")
@click.option(
    "--out",
    type=FilePath(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write it to a file.  [default: print it]",
)
def schema(page: bool, out: Path | None) -> None:
    """Show the keys of presets: as JSON Schema, with which editors complete them, or as a page.

    \b
    cargolab schema --out preset.schema.json   and, as the first line of a preset beside it:
    #:schema ./preset.schema.json
    """
    from lab.base.files import write_text
    from lab.preset.editor import text_of_schema
    from lab.preset.reference import reference

    text = reference() if page else text_of_schema()
    if out is None:
        click.echo(text, nl=False)
        return
    write_text(out, text)
    if not page and out.resolve() == (PRESETS / "schema.json").resolve():
        from lab.preset.kept.written import write_keys

        write_keys()
    click.echo(out if page else f"{out}; a preset beside it names it in its first line: #:schema ./{out.name}")


@click.command()
@click.argument("name", required=False, default="")
@json_option
def cargoes(name: str, as_json: bool) -> None:
    """List the cargoes of the library, or show one with its sources: NAME, or the path of a cargo file.

    \b
    cargolab cargoes
    cargolab cargoes soybeans
    cargolab cargoes mine.toml       checks a file of one's own
    cargolab run imsbc/tilting-box-quick --set grains.cargo=soybeans
    """
    from lab.preset.cargo.cargoes import asked
    from lab.preset.cargo.told import as_objects, card, table

    found = asked(name)
    if as_json:
        tell_json(as_objects(found))
    elif name:
        tell(card(next(iter(found.values()))))
    else:
        tell(table(found))


@click.command()
@click.argument("picture", type=FilePath(path_type=Path))
@click.option("--width", metavar="LENGTH", help="Width of the grain, e.g. '6 mm'.  [default: in pixels]")
@click.option("--points", type=int, default=120, show_default=True, metavar="N", help="Points of the outline.")
@click.option(
    "--out",
    type=FilePath(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="The CSV file.  [default: the picture's name with .csv]",
)
def outline(picture: Path, width: str | None, points: int, out: Path | None) -> None:
    """Trace the outline of a grain in PICTURE, for `shapes.NAME.contour` of a preset.

    \b
    cargolab outline bean.jpg --width "12 mm"
    The grain must stand out from a plain ground and lie within the picture; the largest thing in it is taken.
    """
    from lab.assembly.traced import trace
    from lab.preset.units import parse, show

    found = trace(picture, None if width is None else parse(width, "m"), points)
    path = found.write(out or picture.with_suffix(".csv"))
    size = show(found.equal, "m") if found.in_metres else f"{found.equal:.4g} pixels"
    click.echo(f"{path}; the disc of equal area has a diameter of {size}")
