"""Drag laws by name, a line each.

A law is the coefficient β/(1 − ε) (kg/(m³ s)) of F_d = V_g β/(1 − ε) (u_f − u_g), the drag on a grain of the volume V_g
that moves through water of the velocity u_f at the porosity ε. The pressure's gradient acts on the grain besides, whole
(model A of Gidaspow 1994). Speeds are those between the grains, not superficial ones.
"""

from solvers.mixture.drag.di_felice import DiFelice
from solvers.mixture.drag.ergun import Ergun
from solvers.mixture.drag.gidaspow import Gidaspow
from solvers.mixture.drag.wen_yu import WenYu

DRAG = {"di-felice": DiFelice, "ergun": Ergun, "wen-yu": WenYu, "gidaspow": Gidaspow}
