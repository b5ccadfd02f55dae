"""The status of a world. The checks that stop one are the matters' own."""

RUNNING, WAITING, NO_ROOM, TOO_FAST, OVER = range(5)
