"""The visitor in the hall: a figure of adjustable height that faces the robot."""

from math import atan2, cos, sin

from lumen.features.simulation.model_terms import STAGE_SITE
from lumen.features.simulation.physics import mujoco
from lumen.language.stories import Visitor

VISITOR_BODY = "visitor"
FIGURE_HEIGHT = 1.65
"""The height of the figure in the hall's MJCF [m]."""

_AWAY = (0.0, 0.0, -10.0)


class VisitorFigure:
    """Moves and scales the hall's body `visitor`, which is out of sight until placed."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        body = model.body(VISITOR_BODY)
        self._mocap = body.mocapid[0]
        self._geoms = slice(body.geomadr[0], body.geomadr[0] + body.geomnum[0])
        self._sizes = model.geom_size[self._geoms].copy()
        self._places = model.geom_pos[self._geoms].copy()
        self._bounds = model.geom_rbound[self._geoms].copy()
        self._boxes = model.geom_aabb[self._geoms].copy()
        self._site = model.site("visitor_face").id
        self._face = model.site_pos[self._site].copy()
        self._stage = model.site(STAGE_SITE).pos.copy()
        self._visitor: Visitor | None = None
        self.place(None)

    def place(self, visitor: Visitor | None) -> None:
        """Place the figure on the floor at the visitor's position, facing the robot's start; None removes it."""
        changed = visitor and (self._visitor is None or visitor.height != self._visitor.height)
        self._visitor = visitor
        if visitor is None:
            self._data.mocap_pos[self._mocap] = _AWAY
            return
        turn = atan2(-visitor.y, -visitor.x)
        self._data.mocap_pos[self._mocap] = (self._stage[0] + visitor.x, self._stage[1] + visitor.y, 0.0)
        self._data.mocap_quat[self._mocap] = (cos(turn / 2), 0.0, 0.0, sin(turn / 2))
        if changed:
            self._scale(visitor.height / FIGURE_HEIGHT)

    def face(self) -> tuple[float, float, float] | None:
        """Return the position of the face in the hall [m]; None without a visitor."""
        if self._visitor is None:
            return None
        x, y, z = self._face * (self._visitor.height / FIGURE_HEIGHT)
        turn = atan2(-self._visitor.y, -self._visitor.x)
        ahead, left, up = self._data.mocap_pos[self._mocap]
        return (
            float(ahead + cos(turn) * x - sin(turn) * y),
            float(left + sin(turn) * x + cos(turn) * y),
            float(up + z),
        )

    def _scale(self, factor: float) -> None:
        model = self._model
        model.site_pos[self._site] = self._face * factor
        model.geom_size[self._geoms] = self._sizes * factor
        model.geom_pos[self._geoms] = self._places * factor
        model.geom_rbound[self._geoms] = self._bounds * factor
        model.geom_aabb[self._geoms] = self._boxes * factor
