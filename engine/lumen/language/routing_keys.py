"""The routing keys that Lumen itself uses; every other key is free for an exhibition's own messages."""

from collections.abc import Mapping

KEY_PREFIXES = ("avatar", "lumen")
"""What every key of ours begins with: `avatar` those of robots, `lumen` those of what thinks for them."""

DEFAULT_KEYS: Mapping[str, str] = {
    "image": "avatar.{robot}.data.image",
    "joint": "avatar.{robot}.data.joint",
    "sonar": "avatar.{robot}.data.sonar",
    "tactile": "avatar.{robot}.data.tactile",
    "battery": "avatar.{robot}.data.battery",
    "recording": "avatar.{robot}.data.recording",
    "command": "avatar.{robot}.command",
    "stop": "avatar.{robot}.stop",
    "aim": "avatar.{robot}.aim",
    "report": "avatar.{robot}.event.command",
    "noticed": "avatar.{robot}.event.noticed",
    "hall": "avatar.{robot}.hall",
    "seen": "avatar.{robot}.hall.seen",
    "presence": "lumen.{robot}.presence",
    "state": "lumen.{robot}.state",
    "motion": "lumen.motion.{robot}.command",
    "heard": "lumen.{robot}.audio.speech.recognition",
    "listening": "lumen.{robot}.audio.listening",
    "gender": "lumen.{robot}.audio.gender.identification",
    "wav_stream": "lumen.{robot}.audio.wav.stream",
    "text_stream": "lumen.{robot}.audio.text.stream",
    "text_to_speech": "lumen.{robot}.audio.text.to.speech",
    "face": "lumen.{robot}.visual.face.detection",
    "recognised": "lumen.{robot}.visual.face.recognition",
    "face_tracking": "lumen.{robot}.visual.face.tracking",
    "human": "lumen.{robot}.visual.human.detection",
    "visual_command": "lumen.{robot}.visual.command",
    "social_perception": "lumen.{robot}.social.perception",
    "social_expression": "lumen.{robot}.social.expression",
    "fact": "lumen.{robot}.persistence.fact",
    "forgotten": "lumen.{robot}.persistence.forgotten",
    "journal": "lumen.{robot}.persistence.journal",
    "ask": "lumen.{robot}.ask",
    "answer": "lumen.{robot}.answer",
    "trouble": "lumen.{robot}.trouble",
}
"""The routes that Lumen and its modules use, and the key of each where lumen.yaml does not say otherwise."""

DEFAULT_ALIASES: Mapping[str, str] = {
    "presence": "lumen.presence",
    "state": "lumen.state",
    "heard": "lumen.audio.speech.recognition",
    "gender": "lumen.audio.gender.identification",
    "wav_stream": "lumen.audio.wav.stream",
    "text_stream": "lumen.audio.text.stream",
    "text_to_speech": "lumen.audio.text.to.speech",
    "face": "lumen.visual.face.detection",
    "recognised": "lumen.visual.face.recognition",
    "face_tracking": "lumen.visual.face.tracking",
    "human": "lumen.visual.human.detection",
    "visual_command": "lumen.visual.command",
    "trouble": "lumen.trouble",
}
"""The keys of 2015, which knew of one robot, for routes that lumen.yaml does not list (`Route.alias`)."""

SHARED_ROUTES = frozenset((
    "heard", "gender", "wav_stream", "text_stream", "text_to_speech", "face", "recognised", "face_tracking", "human",
    "visual_command", "social_perception", "social_expression", "fact", "forgotten", "journal",
))  # fmt: skip
"""Where modules and behaviours speak with each other: any route may send under their keys, whatever its name."""

CONFIG_COMMAND, CONFIG_STATUS = "lumen.{robot}.config.command", "lumen.{robot}.config.status"
"""Keys of ours that have no route: orders to reload, and what comes of them."""
OPERATOR_REQUEST, OPERATOR_ANSWER = "lumen.{robot}.operator.request", "lumen.operator.answer"
"""What operators ask, and the answers, which are told apart by their `correlation_id`."""
TOLD = "lumen.{robot}.event"
"""Where a robot hears what others of its house tell it."""
SHARED_KEY = "lumen.{house}.shared"
"""Where the robots of a house tell what they have in common."""
INTERNAL_ALIASES: Mapping[str, str] = {
    CONFIG_COMMAND: "lumen.config.command",
    CONFIG_STATUS: "lumen.config.status",
    OPERATOR_REQUEST: "lumen.operator.request",
}
"""What these are called where there is one robot."""
INTERNAL_KEYS = (*INTERNAL_ALIASES.values(), *INTERNAL_ALIASES, OPERATOR_ANSWER, TOLD, SHARED_KEY)


def key_of_robot(key: str, robot: str) -> str:
    """The key with the robot's name in it."""
    return key.replace("{robot}", robot)


def key_of_house(key: str, house: str) -> str:
    """The key with the house's name in it."""
    return key.replace("{house}", house)


def default_key(route: str, robot: str) -> str:
    """The key of one of our routes for that robot, where lumen.yaml does not say otherwise."""
    return DEFAULT_KEYS[route].replace("{robot}", robot)
