"""cargolab view: an experiment that runs live and is steered by the user.

`panel.controls` lists what can be changed; `panel.steering` turns the user's settings into a smooth motion of the tank;
`live` is the experiment itself, which records all actions of the user, so that `replay` repeats it bit for bit.
`worker` runs it in a separate process. `session` is the user's side: pictures by `page`, and the actions of keys, mouse
and sliders. A front end in `windows` shows the pictures and passes on the events.
"""
