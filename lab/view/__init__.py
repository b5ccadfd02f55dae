"""cargolab view: an experiment that runs live and is steered by the user.

`controls` lists what can be changed; `helm` turns the user's settings into a smooth motion of the tank; `live` is the
experiment itself, which records all that the user does, so that `replay` repeats it bit for bit. `worker` runs it in a
process of its own. `session` holds the user's side: pictures by `page`, and the actions of keys, mouse and sliders; a
front end in `windows` shows the pictures and passes on the events.
"""
