"""Attacks from anywhere: messages through RabbitMQ."""

from tests.attack import messages
from tests.attack.attacks import Attack, Kind
from tests.attack.sound import sound
from tests.attack.targets import BrokenError, Exhibition

STREAM = ".persistence.journal"
"""The end of the keys of streams."""


class Remote:
    """The lane that sends messages through RabbitMQ, which has processed all of a batch before a check.

    A stream can't hold every header, and RabbitMQ closes the connection that sends such a header. So this lane waits
    until each message to a stream is processed.
    """

    kinds = (Kind.MESSAGE,)
    batch = 250

    def __init__(self, url: str) -> None:
        self._sound, self._target, self._stranger = sound(), Exhibition(url), messages.Stranger(url)
        self._refused, self.size = 0, self._target.size

    def strike(self, attack: Attack) -> str:
        message = messages.message(attack.random, self._sound)
        self._stranger.send(message)
        if str(message.key).endswith(STREAM):
            self._stranger.settle()
            if self._stranger.ended > self._refused:
                self._refused = self._stranger.ended
                return "refused by RabbitMQ"
        return "messages taken by RabbitMQ"

    def check(self) -> None:
        self._stranger.settle()
        if self._stranger.ended > self._refused:
            raise BrokenError("RabbitMQ hung up on who attacked: what was sent last may have been lost")
        self._target.check()

    def close(self) -> None:
        self._stranger.close()
        self._target.close()
