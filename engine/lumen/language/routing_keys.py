"""The routing keys that Lumen itself uses; all others are free for an exhibition's own messages."""

from collections.abc import Mapping

from lumen.language.built_in_routes import BUILT_IN_ROUTES

KEY_PREFIXES = ("avatar", "lumen")
"""The first words of all keys of Lumen: `avatar` for robots, `lumen` for the software that controls them."""

DEFAULT_KEYS: Mapping[str, str] = {
    **{name: route.key for name, route in BUILT_IN_ROUTES.items()},
    "ask": "lumen.{robot}.ask",
    "answer": "lumen.{robot}.answer",
}
"""The routes that Lumen and its modules use, with their default keys."""

DEFAULT_ALIASES: Mapping[str, str] = {name: route.alias for name, route in BUILT_IN_ROUTES.items() if route.alias}
"""The keys of 2015 by route, which allow only one robot; for routes that lumen.yaml does not list (`Route.alias`)."""

SHARED_ROUTES = frozenset((
    "heard", "gender", "wav_stream", "text_stream", "text_to_speech", "face", "recognised", "face_tracking", "human",
    "visual_command", "social_perception", "social_expression", "fact", "forgotten", "journal",
))  # fmt: skip
"""Routes between modules and behaviours, whose keys a project's route of any name may use."""

CONFIG_COMMAND, CONFIG_STATUS = "lumen.{robot}.config.command", "lumen.{robot}.config.status"
"""Keys without a route: orders to reload, and their results."""
OPERATOR_REQUEST, OPERATOR_ANSWER = "lumen.{robot}.operator.request", "lumen.operator.answer"
"""The key of operators' requests, and the key of all answers, which a `correlation_id` relates to their requests."""
SKILL_CALL, SKILL_ANSWER = "lumen.{robot}.skill.{module}", "lumen.{robot}.skill_answer"
"""The keys on which a module receives the calls of its skills, and answers them."""
TOLD = "lumen.{robot}.event"
"""The key on which a robot receives events from others of its house."""
SHARED_KEY = "lumen.{house}.shared"
"""The key on which the robots of a house publish the values that they share."""
INTERNAL_ALIASES: Mapping[str, str] = {
    CONFIG_COMMAND: "lumen.config.command",
    CONFIG_STATUS: "lumen.config.status",
    OPERATOR_REQUEST: "lumen.operator.request",
}
"""The keys without a robot's name, which these messages have too while there is only one robot."""
INTERNAL_KEYS = (*INTERNAL_ALIASES.values(), *INTERNAL_ALIASES, OPERATOR_ANSWER, TOLD, SHARED_KEY)


def key_of_robot(key: str, robot: str) -> str:
    """Return the key with the robot's name in it."""
    return key.replace("{robot}", robot)


def key_of_house(key: str, house: str) -> str:
    """Return the key with the house's name in it."""
    return key.replace("{house}", house)


def default_key(route: str, robot: str) -> str:
    """Return the default key of one of Lumen's routes for that robot. Raises KeyError for any other route."""
    return DEFAULT_KEYS[route].replace("{robot}", robot)
