"""The S175 container ship at rest, by strips of her own lines: ShipX VERES, in T. I. Fossen's Marine Systems Simulator.

Added mass (4, 5) in kt and kt m², damping (4, 5) in kt/s and kt m²/s, in sway, heave, roll, pitch and yaw about her
centre of gravity, 9.55 m over the keel, at angular frequencies (4,) in rad/s; force in waves from abeam (4, 2) in MN/m,
sway and heave. From github.com/cybergalactic/MSS, HYDRO/vessels_shipx/s175/s175.mat, speed 0.
"""

import numpy as np

FREQUENCY = np.array([0.3926991, 0.5235988, 0.7853982, 1.047198])
ADDED_MASS = np.array(
    [
        [33.83, 32.33, 304.3, 41260.0, 70900.0],
        [35.33, 25.16, 313.8, 31340.0, 76810.0],
        [22.52, 20.07, 283.4, 22470.0, 60150.0],
        [9.704, 20.60, 227.1, 20410.0, 26980.0],
    ]
)
DAMPING = np.array(
    [
        [1.652, 15.51, 3.706, 20880.0, 2142.0],
        [6.111, 15.84, 14.67, 22400.0, 8706.0],
        [18.81, 13.30, 66.16, 21690.0, 39020.0],
        [20.15, 9.361, 72.31, 18460.0, 46320.0],
    ]
)
FORCE = np.array([[8.120, 24.02], [13.70, 20.94], [19.96, 15.44], [16.42, 11.06]])
DISPLACEMENT, KB, LCB, KM = 24609.62, 5.207, 84.953, 10.546  # t, m: that program's of the same lines
