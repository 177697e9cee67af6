"""Sign-in to the pages by PIN or session cookie, and rate limits for attempts at PINs."""

import base64
import hashlib
import hmac
import json
import math
import secrets
import time
from collections import OrderedDict
from collections.abc import Mapping
from pathlib import Path

from lumen.errors import UsageError
from lumen.features.console.people import ROLES, Person, Role
from lumen.project.home import Home, home_of
from lumen.upkeep.ratelimit import TokenBucket, pause_after
from lumen.upkeep.regular_files import read_regular

COOKIE = "lumen_session"
SESSION_TIME = 16 * 3600.0
"""The lifetime of a session [s], enough for a museum's day."""
SHORTEST_PIN = 4
MAX_NAME = 60
FIRST_PAUSE, LONGEST_PAUSE = 1.0, 60.0
"""An address's first and longest pause after too many wrong PINs [s]; each further wrong PIN doubles the pause."""
FREE_TRIES = 3
"""The number of wrong PINs from which an address must pause; fewer cause no pause, because people mistype."""
ALL_TRIES, ALL_PERIOD = 20, 10.0
"""All addresses together may try this many wrong PINs in a burst, then one per period [s]."""
MAX_ADDRESSES = 1_000
SECRET_FILE = "console.key"
_SECRET_BYTES = 32


class TooFastError(Exception):
    """Too many wrong PINs; the next attempt is allowed after `wait` [s]."""

    def __init__(self, wait: float) -> None:
        self.wait = max(1, math.ceil(wait))
        super().__init__(f"too many wrong PINs: try again in {self.wait} s. Rest needs no PIN")


class Access:
    """Identifies people by the PINs of the roles.

    Without any PIN everyone is an author, which is allowed on loopback only.

    Sessions are signed with `secret`, so they remain valid after the console restarts. An empty secret is replaced by
    a random one, which does not outlive the process.
    """

    def __init__(self, pins: Mapping[Role, str], secret: bytes = b"") -> None:
        self.pins = {role: pin.encode() for role, pin in pins.items()}
        self._secret = secret or secrets.token_bytes(_SECRET_BYTES)
        self._guard = PinGuard()
        self._ended: OrderedDict[str, float] = OrderedDict()

    def person(self, address: str, bearer: str, cookie: str) -> Person:
        """Return the person who sends a request, identified by the PIN in `bearer`, else by the session in `cookie`.

        The role is `NOBODY` if the PIN or session is invalid, and `AUTHOR` if the console has no PINs.

        Raises TooFastError if PINs are tried too fast.
        """
        if not self.pins:
            return Person(Role.AUTHOR)
        if bearer:
            return Person(self.role(address, bearer))
        return self._signed(cookie)

    def role(self, address: str, pin: str) -> Role:
        """Return the role of a PIN, `NOBODY` for a wrong one.

        Raises TooFastError, without checking the PIN, if the attempt comes too soon.
        """
        self._guard.check(address)
        given, found = pin.encode("utf-8", "surrogatepass"), Role.NOBODY
        for role, wanted in self.pins.items():  # no early end: the time taken must not reveal a role
            if hmac.compare_digest(_digest(given), _digest(wanted)) and role > found:
                found = role
        self._guard.note(address, right=found > Role.NOBODY)
        return found

    def sign(self, person: Person) -> str:
        """Return the cookie value of a person's new session, which is valid for `SESSION_TIME`."""
        said = [person.role.word, person.name[:MAX_NAME], time.time() + SESSION_TIME, secrets.token_hex(8)]
        body = base64.urlsafe_b64encode(json.dumps(said).encode()).decode()
        return f"{body}.{self._mark(body)}"

    def end(self, cookie: str) -> None:
        """Refuse the session in this cookie until the process ends."""
        self._ended[cookie] = time.time()
        while len(self._ended) > MAX_ADDRESSES:
            self._ended.popitem(last=False)

    def _signed(self, cookie: str) -> Person:
        body, _, mark = cookie.partition(".")
        if not hmac.compare_digest(mark.encode(), self._mark(body).encode()) or cookie in self._ended:
            return Person(Role.NOBODY)
        role, name, until, _ = json.loads(base64.urlsafe_b64decode(body))
        known = ROLES.get(role, Role.NOBODY)
        return Person(known, name) if time.time() < until and known in self.pins else Person(Role.NOBODY)

    def _mark(self, body: str) -> str:
        pins = b"\0".join(_digest(pin) for _, pin in sorted(self.pins.items()))  # any changed PIN ends all sessions
        return hmac.new(self._secret, body.encode("utf-8", "surrogatepass") + pins, hashlib.sha256).hexdigest()


class PinGuard:
    """Limits attempts at PINs.

    An address with several wrong PINs must pause, longer after each further one. All addresses share one limit.
    """

    def __init__(self) -> None:
        self._wrong: OrderedDict[str, tuple[int, float]] = OrderedDict()
        self._all = TokenBucket(ALL_TRIES, time.monotonic())

    def check(self, address: str) -> None:
        """Raise TooFastError if this address, or every address, must wait."""
        now = time.monotonic()
        count, at = self._wrong.get(address, (0, 0.0))
        pause = pause_after(count - FREE_TRIES + 1, FIRST_PAUSE, LONGEST_PAUSE)
        if (left := at + pause - now) > 0:
            raise TooFastError(left)
        if left := self._all.wait(now, 1.0 / ALL_PERIOD, ALL_TRIES):
            raise TooFastError(left)

    def note(self, address: str, *, right: bool) -> None:
        """Record an attempt from an address. A `right` PIN clears the address's count of wrong ones."""
        if right:
            self._wrong.pop(address, None)
            return
        self._all.tokens -= 1.0
        self._wrong[address] = self._wrong.pop(address, (0, 0.0))[0] + 1, time.monotonic()
        while len(self._wrong) > MAX_ADDRESSES:
            self._wrong.popitem(last=False)


def pins_from(said: Mapping[str, str], environment: Mapping[str, str]) -> dict[Role, str]:
    """Return each role's PIN from the environment; `said` maps the role's word to its variable.

    Raises UsageError if a PIN is missing, too short or used twice.
    """
    found: dict[Role, str] = {}
    for word, variable in said.items():
        pin = environment.get(variable.removeprefix("$"), "")
        if not pin:
            raise UsageError(f"the PIN for {word} is missing: set the environment variable {variable}")
        if len(pin) < SHORTEST_PIN:
            raise UsageError(f"the PIN for {word}, in {variable}, is too short: use at least {SHORTEST_PIN} characters")
        if pin in found.values():
            raise UsageError(
                f"the PIN for {word}, in {variable}, is also the PIN of another role: give each role its own"
            )
        found[ROLES[word]] = pin
    return found


def secret_in(root: Path) -> bytes:
    """Return the key that signs sessions from the project's home folder; create it if it is missing or invalid.

    Return empty bytes if the folder is missing or the key can't be written.
    """
    home = Home(home_of(root))
    try:
        kept = read_regular(home.folder / SECRET_FILE, 2 * _SECRET_BYTES, follow=False)
    except OSError:
        kept = b""
    if len(kept) == _SECRET_BYTES:
        return kept
    new = secrets.token_bytes(_SECRET_BYTES)
    return b"" if not home.folder.is_dir() or home.write(SECRET_FILE, new) else new


def _digest(pin: bytes) -> bytes:
    return hashlib.sha256(pin).digest()
