"""The choice of a scene's walls: those of the plane, or of the solid that its outline stands for."""

from solvers.machine.state import State
from solvers.tank.pieces import Pieces
from solvers.tank.solids.faces import FaceWalls
from solvers.tank.solids.mesh import Mesh
from solvers.tank.solids.prism import PrismWalls
from solvers.tank.solids.solid import Prism
from solvers.tank.solids.turned import TurnedWalls
from solvers.tank.walls import Walls

AnyWalls = Walls | PrismWalls | TurnedWalls | FaceWalls


def make_walls(arrays: State, scene, pieces: Pieces) -> AnyWalls:
    """The walls of a scene (`solvers.scene.Scene`)."""
    if scene.solid is None:
        return Walls(arrays, scene.tanks, pieces, scene.apart)
    if isinstance(scene.solid, Prism):
        return PrismWalls(arrays, scene.tanks, pieces, scene.solid)
    if isinstance(scene.solid, Mesh):
        return FaceWalls(arrays, scene.tanks, pieces, scene.solid)
    return TurnedWalls(arrays, scene.tanks, pieces, scene.solid)
