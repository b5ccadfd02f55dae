"""A page with a player: one file that any browser opens, with the data of a recording in it and no server behind it."""

from lab.export.html.page import write_html

__all__ = ["write_html"]
