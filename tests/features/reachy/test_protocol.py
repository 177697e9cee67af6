"""The fake of Reachy Mini's daemon answers as the real one, which was recorded."""

import json

from tests.features.reachy.fake import FakeDaemon
from tests.features.reachy.protocol import RECORDED, observed


def test_the_fake_answers_as_the_real_daemon_did(daemon: FakeDaemon) -> None:
    recorded, found = json.loads(RECORDED.read_text()), observed(daemon.url)
    assert found.keys() == recorded.keys()
    assert {name: found[name] for name in recorded} == recorded
