"""Messages per second, counted by key."""

import pytest

from lumen.upkeep import ratelimit
from lumen.upkeep.ratelimit import BURST, RateLimiter, TokenBucket


def test_a_burst_and_then_the_rate() -> None:
    now = 0.0
    limiter = RateLimiter(lambda: now)
    assert [limiter.wait("face", 2.0) for _ in range(11)] == [0.0] * int(2 * BURST) + [0.5]
    now = 0.5
    assert [limiter.wait("face", 2.0), limiter.wait("face", 2.0)] == [0.0, 0.5]
    assert limiter.wait("sonar", 2.0) == 0.0


def test_many_keys_cost_only_the_keys_that_were_used_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ratelimit, "MAX_KEYS", 3)
    limiter = RateLimiter(lambda: 0.0)
    for key in ("a", "b", "c", "a", "d"):
        limiter.wait(key, 0.2)  # a burst of one
    assert [bool(limiter.wait(key, 0.2)) for key in ("a", "c", "d")] == [True] * 3
    assert limiter.wait("b", 0.2) == 0.0


def test_a_bucket_is_never_fuller_than_full() -> None:
    bucket = TokenBucket(20.0, 0.0)
    assert bucket.wait(100.0, 0.1, 20.0) == 0.0
    assert bucket.tokens == 20.0
    bucket.tokens = 0.5
    assert bucket.wait(100.0, 0.1, 20.0) == 5.0
