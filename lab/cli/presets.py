"""Commands on the keys of presets."""

from pathlib import Path

import click

from lab.base.data import PRESETS
from lab.cli.options import FilePath


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
