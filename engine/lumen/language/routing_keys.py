"""The routing keys that Lumen itself uses; every other key is free for an exhibition's own messages."""

from collections.abc import Mapping

from lumen.language.built_in_routes import BUILT_IN_ROUTES

KEY_PREFIXES = ("avatar", "lumen")
"""What every key of ours begins with: `avatar` those of robots, `lumen` those of what thinks for them."""

DEFAULT_KEYS: Mapping[str, str] = {
    **{name: route.key for name, route in BUILT_IN_ROUTES.items()},
    "ask": "lumen.{robot}.ask",
    "answer": "lumen.{robot}.answer",
}
"""The routes that Lumen and its modules use, and the key of each where lumen.yaml does not say otherwise."""

DEFAULT_ALIASES: Mapping[str, str] = {name: route.alias for name, route in BUILT_IN_ROUTES.items() if route.alias}
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
