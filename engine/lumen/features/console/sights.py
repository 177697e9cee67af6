"""The paths of images: the camera, and the robot's shape and poses."""

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route

from lumen.features.console.camera import MEDIA_TYPE, Cameras
from lumen.features.console.jobs import Jobs
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.people import Role
from lumen.features.console.poses import Poses
from lumen.features.console.requests import NO_STORE, DeniedError, Reception

STREAM = "text/event-stream"


class Sights:
    """Serves images and drawings of robots to people who have a role."""

    def __init__(self, reception: Reception, jobs: Jobs) -> None:
        self._reception = reception
        self.cameras, self._jobs = Cameras(reception.watch), jobs
        self._drawings: dict[str, Poses] = {}
        self.routes = [
            Route("/camera/{robot}", self._camera),
            Route("/api/shape", self._shape),
            Route("/api/poses", self._poses),
        ]

    def close(self) -> None:
        self.cameras.close()
        for poses in self._drawings.values():
            poses.closing = True

    def poses(self, robot: str) -> Poses:
        """Return the shapes and poses of a robot, created on the first call."""
        if robot not in self._drawings:
            self._drawings[robot] = Poses(self._reception.watch, self._jobs, robot)
        return self._drawings[robot]

    async def _camera(self, request: Request) -> Response:
        self._reception.person(request, Role.SHOW)
        view = self._reception.robot(request.path_params["robot"])
        if "still" in request.query_params:
            image = await self.cameras.still(view.robot)
            return Response(image, 200 if image else 204, headers=NO_STORE, media_type="image/jpeg")
        return StreamingResponse(self.cameras.stream(view.robot), media_type=MEDIA_TYPE, headers=NO_STORE)

    async def _shape(self, request: Request) -> Response:
        view = self._drawn(request)
        try:
            data = await self.poses(view.robot).shape()
        except DeniedError as error:
            raise DeniedError(error.status, f"the robot cannot be drawn: {error.reason}") from None
        return Response(data, headers=NO_STORE, media_type="application/json")

    async def _poses(self, request: Request) -> Response:
        view = self._drawn(request)
        return StreamingResponse(self.poses(view.robot).stream(), media_type=STREAM, headers=NO_STORE)

    def _drawn(self, request: Request) -> KnownRobot:
        self._reception.person(request, Role.SHOW)
        view = self._reception.robot(request.query_params.get("robot"))
        watch = self._reception.watch
        if watch.link.reached is None or not watch.keys.is_ours(view.robot):
            raise DeniedError(404, "only robots of this console's own project can be drawn")
        return view
