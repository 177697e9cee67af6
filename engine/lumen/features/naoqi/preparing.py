"""Prepares the robot after each connection, before the first command."""

import logging
import re
from collections.abc import Sequence

from lumen.errors import RobotFailedError, RobotModelError, RobotUnreachableError
from lumen.features.naoqi.session import NaoqiSession
from lumen.language.diagnostics import did_you_mean
from lumen.language.robots import Body

REQUIRED_SERVICES = ("ALMotion", "ALRobotPosture", "ALMemory")
OPTIONAL_SERVICES = {
    "ALTextToSpeech": "it does not speak",
    "ALVideoDevice": "it has no camera images",
    "ALSonar": "only its bumpers stop it at a wall",
    "ALLeds": "its lights stay as they are",
    "ALSoundLocalization": "it does not look towards sounds",
    "ALAnimatedSpeech": "it speaks with Lumen's gestures only",
    "ALAutonomousBlinking": "Lumen makes it blink",
    "ALAudioPlayer": "it plays no sounds",
    "ALAudioDevice": "its microphones hear nothing",
    "ALAutonomousLife": "make sure that no other program moves it",
    "ALSystem": "its version is unknown",
}
"""The optional services, each with the effect of its absence."""
OLDEST_NAOQI, TESTED_NAOQI = (2, 1), ((2, 1), (2, 8))
AUTONOMOUS_LIFE_TIMEOUT = 10.0
"""The time limit for the end of autonomous life [s], which first finishes the robot's present activity."""

_log = logging.getLogger(__name__)


def prepare(session: NaoqiSession, body: Body, *, again: bool) -> None:
    """Take the robot over: end autonomous life and switch on the reflexes.

    After a lost connection (`again`), also end old commands. Raises RobotError if the robot lacks a required service or
    a joint of this body, or if its NAOqi is too old.
    """
    _find(session)
    _check_version(session)
    _check_joints(session, body)
    if session.has("ALAutonomousLife") and session.request("ALAutonomousLife", "getState") != "disabled":
        session.request("ALAutonomousLife", "setState", "disabled", patience=AUTONOMOUS_LIFE_TIMEOUT)
    if again:
        halt(session, list(body.joints))
    _protect(session)


def halt(session: NaoqiSession, joints: Sequence[str]) -> None:
    """Stop a walk after its current step, these joints' motions, and speech; the robot keeps its balance."""
    session.post("ALMotion", "stopMove").wait(2.0)
    session.post("ALMotion", "killTasksUsingResources", list(joints)).wait(1.0)
    if session.has("ALTextToSpeech"):
        session.post("ALTextToSpeech", "stopAll").wait(1.0)


def _find(session: NaoqiSession) -> None:
    if missing := session.find(REQUIRED_SERVICES):
        raise RobotUnreachableError(
            f"there is no {missing[0]} at {session.url}: check that NAOqi has started and that this is a NAO"
        )
    for name in session.find(OPTIONAL_SERVICES):
        _log.warning("this robot has no %s: %s", name, OPTIONAL_SERVICES[name])


def _check_version(session: NaoqiSession) -> None:
    if not session.has("ALSystem"):
        return
    text = str(session.request("ALSystem", "systemVersion"))
    found = re.match(r"(\d+)\.(\d+)", text)
    if found is None:
        _log.warning("the robot reports the NAOqi version `%s`, which Lumen cannot read", text[:40])
        return
    version = int(found[1]), int(found[2])
    if version < OLDEST_NAOQI:
        raise RobotModelError(f"the robot has NAOqi {text}: Lumen needs 2.1 or newer")
    if not TESTED_NAOQI[0] <= version <= TESTED_NAOQI[1]:
        _log.warning("the robot has NAOqi %s: Lumen was written for 2.1 to 2.8", text)


def _check_joints(session: NaoqiSession, body: Body) -> None:
    """Raise RobotModelError if the robot lacks a joint of the body, for example on a model without hands."""
    names = list(map(str, session.request("ALMotion", "getBodyNames", "Body")))
    for joint in body.joints:
        if joint not in names:
            raise RobotModelError(
                f"this robot has no {joint}, but models/{body.name} does: {did_you_mean(joint, names)}"
            )


def _protect(session: NaoqiSession) -> None:
    """Switch on NAOqi's reflexes: the fall manager, collision protection, and adaptive stiffness.

    Failures are only logged. Raises RobotLostError if the connection breaks.
    """
    for method, *arguments in (
        ("setFallManagerEnabled", True),
        ("setExternalCollisionProtectionEnabled", "All", True),
        ("setSmartStiffnessEnabled", True),
    ):
        call = session.post("ALMotion", str(method), *arguments)
        try:
            if call.wait(2.0):
                call.result()
        except RobotFailedError as error:
            _log.warning("the reflex %s could not be switched on: %s", method, error)
