"""The routing keys of messages between houses and the centre; their brokers exchange no other messages."""

STREAM = "lumen.fleet.log"
"""The stream of incidents and numbers at the centre's broker (docs/fleet-brokers.md)."""
PRESENCE, INCIDENT, NUMBERS, DESIRED, BUNDLE, ORDER = (
    "fleet.presence", "fleet.incident", "fleet.numbers", "fleet.desired", "fleet.bundle", "fleet.order",
)  # fmt: skip
KEPT = (INCIDENT, NUMBERS)
"""The messages that the stream keeps for the centre, so that none is lost or repeated while the centre is off."""


def presence_key(house: str, robot: str) -> str:
    """Return the key on which a robot reports its presence."""
    return f"{PRESENCE}.{house}.{robot}"


def incident_key(house: str, robot: str) -> str:
    """Return the key on which a robot reports an urgent incident at once."""
    return f"{INCIDENT}.{house}.{robot}"


def numbers_key(house: str, robot: str) -> str:
    """Return the key on which a robot reports its counts each hour, and at the end of a bundle."""
    return f"{NUMBERS}.{house}.{robot}"


def desired_key(house: str) -> str:
    """Return the key on which a house receives the versions that its robots should run."""
    return f"{DESIRED}.{house}"


def bundle_key(house: str) -> str:
    """Return the key on which a house receives the bundles that one of its robots lacks."""
    return f"{BUNDLE}.{house}"


def robot_of(key: str) -> str:
    """Return `HOUSE/ROBOT` of a key on which a robot reports; empty for any other key."""
    words = key.split(".")
    return "/".join(words[2:4]) if len(words) == 4 else ""
