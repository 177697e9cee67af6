"""The keys under which houses and centre speak; nothing else crosses between their brokers."""

STREAM = "lumen.fleet.log"
"""The stream of incidents and numbers at the centre's broker (docs/fleet-brokers.md)."""
PRESENCE, INCIDENT, NUMBERS, DESIRED, BUNDLE, ORDER = (
    "fleet.presence", "fleet.incident", "fleet.numbers", "fleet.desired", "fleet.bundle", "fleet.order",
)  # fmt: skip
KEPT = (INCIDENT, NUMBERS)
"""What a centre has to hear once, however long it was off."""


def presence_key(house: str, robot: str) -> str:
    """Where a robot tells of itself."""
    return f"{PRESENCE}.{house}.{robot}"


def incident_key(house: str, robot: str) -> str:
    """Where a robot tells at once what can't wait."""
    return f"{INCIDENT}.{house}.{robot}"


def numbers_key(house: str, robot: str) -> str:
    """Where a robot tells each hour, and at the end of a bundle, what it has counted."""
    return f"{NUMBERS}.{house}.{robot}"


def desired_key(house: str) -> str:
    """Where a house hears what its robots are to run."""
    return f"{DESIRED}.{house}"


def bundle_key(house: str) -> str:
    """Where a house gets the bundles that one of its robots lacks."""
    return f"{BUNDLE}.{house}"


def robot_of(key: str) -> str:
    """HOUSE/ROBOT of a key that leads up, empty for any other."""
    words = key.split(".")
    return "/".join(words[2:4]) if len(words) == 4 else ""
