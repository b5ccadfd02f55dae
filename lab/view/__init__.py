"""cargolab view: an experiment that runs live under a hand.

`controls` says what can be changed; `helm` turns what a hand wants into a smooth motion of the tank; `live` is the
experiment itself, which records all that is done to it, so that `replay` gives the same again, bit for bit. `worker`
runs it in a process of its own. `session` is what a person has before them: pictures by `page`, and what keys, mouse
and sliders do; a front end in `windows` shows the one and passes on the other.
"""
