"""The calls in a NAOqi script: those that move joints, are left out, or don't change a motion.

The joints of a chain are in ALMotion's order ("Joints", "Effectors & Chains" in NAOqi's documentation).
"""

from collections.abc import Mapping

from lumen.project.formats.known import FormatTable, Known

ALMOTION_CALLS = {
    "angleInterpolationBezier": ("names", "times", "keys"),
    "angleInterpolation": ("names", "keys", "times"),
}
PAUSE, WAIT = "sleep", "wait"

_HEAD = ("HeadYaw", "HeadPitch")
_ARM = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand")
_LEG = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
_ARMS = {side: tuple(side + joint for joint in _ARM) for side in "LR"}
_LEGS = {side: tuple(side + joint for joint in _LEG) for side in "LR"}
_BODY = (*_HEAD, *_ARMS["L"], *_LEGS["L"], *_LEGS["R"], *_ARMS["R"])
CHAINS: Mapping[str, tuple[str, ...]] = {
    "Head": _HEAD, "LArm": _ARMS["L"], "RArm": _ARMS["R"], "LLeg": _LEGS["L"], "RLeg": _LEGS["R"],
    "Arms": (*_ARMS["L"], *_ARMS["R"]), "Legs": (*_LEGS["L"], *_LEGS["R"]),
    "Body": _BODY, "Joints": _BODY, "JointActuators": _BODY, "Actuators": _BODY,
}  # fmt: skip

_READS = "it reads a value; if a motion uses that value, the use is listed"
_COMPUTES = "it computes a value; if a motion uses that value, the use is listed"
_CONNECTS = "it connects the script to the robot"
_SHOWS = "it prints or reads text in the terminal"
_BOX = "it ends a Choregraphe box"
_STILL = "it does not move the robot"
_SPEED = "write a keyframe with a time"
_WALK = "in a behaviour: `walk: {x: 0.3, y: 0, theta: 0}`"
_SAY = "in a behaviour: `say: Hello`"

CALLS = Known(
    read=frozenset((*ALMOTION_CALLS, PAUSE, WAIT, "append", "list", "radians", "float")),
    lost={
        "goToPosture": "in a behaviour: `posture: Stand`", "applyPosture": "in a behaviour: `posture: Stand`",
        "wakeUp": "in a behaviour: `wake: true`", "rest": "in a behaviour: `rest: true`",
        "say": _SAY, "playFile": "in a behaviour: `sound: sounds/NAME.wav`", "play": "in a behaviour: `play: NAME`",
        "runBehavior": "import that behaviour too, and `play` it", "startBehavior": "import that behaviour too",
        "openHand": "write a keyframe: {RHand: 1}", "closeHand": "write a keyframe: {RHand: 0}",
        "setAngles": _SPEED, "changeAngles": _SPEED, "setAngle": _SPEED, "changeAngle": _SPEED,
        "angleInterpolationWithSpeed": _SPEED, "setPosition": _SPEED, "setPositions": _SPEED, "changePosition": _SPEED,
        "positionInterpolation": _SPEED, "positionInterpolations": _SPEED, "transformInterpolation": _SPEED,
        "transformInterpolations": _SPEED, "setTransform": _SPEED, "setTransforms": _SPEED, "changeTransform": _SPEED,
        "moveTo": _WALK, "move": _WALK, "moveToward": _WALK, "walkTo": _WALK, "setWalkTargetVelocity": _WALK,
        "walkInit": _WALK, "moveInit": _WALK, "setFootSteps": _WALK, "setFootStepsWithSpeed": _WALK,
        "stopMove": _WALK, "stopWalk": _WALK,
        "setStiffnesses": "in Lumen, motors are stiff from `wake` to `rest`",
        "stiffnessInterpolation": "in Lumen, motors are stiff from `wake` to `rest`",
        "fadeRGB": "in a behaviour: `eyes: red`", "setLanguage": "write `languages` in lumen.yaml",
    },
    meaningless={
        **dict.fromkeys(("get…", "is…"), _READS),
        **dict.fromkeys(
            ("range", "xrange", "len", "zip", "int", "str", "max", "min", "abs", "sum", "round", "sorted", "map",
             "enumerate", "isinstance", "dict", "set", "tuple", "bool", "repr", "type", "sin", "cos", "sqrt", "pi",
             "format", "join", "split", "strip", "lower", "upper", "keys", "items", "values", "index", "count", "copy",
             "deepcopy", "extend", "insert", "pop", "remove", "sort", "reverse", "clear", "update", "time", "degrees",
             "reversed", "any", "all", "filter"), _COMPUTES),
        **dict.fromkeys(
            ("ALProxy", "ALBroker", "Session", "service", "connect", "Application", "session", "ArgumentParser",
             "add_argument", "parse_args", "OptionParser", "add_option", "set_defaults", "exit", "__init__", "super",
             "shutdown", "start", "ALModule", "quit", "abspath", "dirname", "ping"), _CONNECTS),
        **dict.fromkeys(
            ("print", "info", "warn", "warning", "error", "debug", "log", "input", "raw_input", "write", "flush",
             "print_exc", "basicConfig", "getLogger"), _SHOWS),
        **dict.fromkeys(("onStopped", "onUnload", "onReady", "onInput_onStop"), _BOX),
        **dict.fromkeys(("killAll", "killMove", "waitUntilMoveIsFinished", "setFallManagerEnabled"), _STILL),
    },
)  # fmt: skip
KNOWN: FormatTable = {
    "call": CALLS,
    "handle": Known(frozenset(("type", "time", "angle")), meaningless={"after the last key": "no movement follows"}),
}
"""The parts of a script that are recognized: calls by their last name (`get…` stands for all that begin with `get`),
and a key's handles, such as `[3, -0.1, 0]`."""


def is_reading(name: str) -> bool:
    """Return whether a call's name, such as `getAngles` or `isRunning`, shows that it only reads a value."""
    return any(name.startswith(word) and name[len(word) : len(word) + 1].isupper() for word in ("get", "is"))
