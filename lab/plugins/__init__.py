"""Plug-ins: files of Python with measures, quantities, colours, laws or motions of a user's own."""
