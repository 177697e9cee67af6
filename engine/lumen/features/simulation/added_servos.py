"""Position servos for joints whose model has none: `motors` of `models/NAME.yaml`."""

from math import inf

from lumen.features.simulation.physics import mjcf
from lumen.language.robots import Body


def add_servos(robot: mjcf.RootElement, body: Body) -> None:
    """Give joints without a servo of their name one, in place of other motors that drive them.

    It gives all the joint's `effort` where it is `body.give` [rad] off, and is damped critically (MuJoCo's `dampratio`,
    from the masses in the zero posture). A joint that the model lacks, or whose effort nobody says, gets none.
    """
    if not body.give:
        return
    driving: dict[str, list[mjcf.Element]] = {}
    for motor in robot.find_all("actuator"):
        if getattr(motor, "joint", None) is not None:
            driving.setdefault(motor.joint.name, []).append(motor)
    for name, joint in body.joints.items():
        element, motors = robot.find("joint", name), driving.get(name, [])
        if element is None or name in body.shared or joint.effort == inf or any(_serves(m, name) for m in motors):
            continue
        for motor in motors:
            motor.remove()
        robot.actuator.add(
            "position",
            name=name,
            joint=element,
            kp=joint.effort / body.give,
            dampratio=1,
            ctrlrange=(joint.minimum, joint.maximum),
            forcerange=(-joint.effort, joint.effort),
        )


def _serves(motor: mjcf.Element, name: str) -> bool:
    return bool(motor.tag == "position" and motor.name == name)
