"""Play in the gears: a joint turns a little while its motor stands still."""

from lumen.features.simulation.imperfections import BACKLASH
from lumen.features.simulation.model_terms import PLAY_SUFFIX
from lumen.features.simulation.physics import mjcf
from lumen.language.robots import Body

_GEAR_INERTIA, _GEAR_DAMPING = 0.01, 0.01
"""Of the gears' last wheel [kg m^2], [N m s/rad]; chosen: with less the robot rattles where it rests."""

_STIFFNESS, _HARDNESS = (0.005, 1.0), (0.99, 0.999, 0.001)
"""How hard teeth meet: `solreflimit`, `solimplimit`."""


def loosen(robot: mjcf.RootElement, body: Body) -> None:
    """Give each joint that turns a second one behind it, which no motor turns, free within the gear's play.

    The first one is the motor's: its servo, friction and inertia end there. The link hangs behind the second.
    """
    for name in body.joints:
        if name not in (*body.hands, *body.slides):
            motor = robot.find("joint", name)
            motor.parent.add(
                "joint",
                name=name + PLAY_SUFFIX,
                dclass=motor.dclass,
                type=motor.type,
                pos=motor.pos,
                axis=motor.axis,
                limited=True,
                range=(-BACKLASH / 2, BACKLASH / 2),
                armature=_GEAR_INERTIA,
                damping=_GEAR_DAMPING,
                frictionloss=0.0,
                solreflimit=_STIFFNESS,
                solimplimit=_HARDNESS,
            )
