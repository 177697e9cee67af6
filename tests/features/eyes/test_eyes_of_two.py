"""One process of eyes serves two robots: each robot hears what its own camera sees."""

from dataclasses import replace

import pytest

import lumen
from lumen.bus import connect
from lumen.bus.aliases import aliases_of
from lumen.bus.validated import by_key, validated
from lumen.language.modules import EYES, ModuleSettings
from lumen.language.projects import Project
from lumen.run.parts.module import ModulePart
from tests.features.eyes.test_eyes import Pixels, body, photographed  # noqa: F401  a photograph of a face
from tests.waiting import Collector, until


@pytest.fixture
def two() -> Project:
    shipped = lumen.load()
    eyes = ModuleSettings(False, {"robots": ["Ben"], "every": 0.01})
    return replace(shipped, robot="Ana", modules={EYES: eyes})


def test_each_robot_hears_what_its_own_camera_sees(two: Project, photographed: Pixels) -> None:  # noqa: F811
    bus, stranger = validated(connect("memory://two-cameras"), two), connect("memory://two-cameras")
    seen, there = Collector(), Collector()
    stranger.subscribe("lumen.*.visual.face.detection", seen)
    stranger.subscribe("lumen.Ben.presence", there)
    part = ModulePart(EYES, two, bus, lambda who, text: None, None, awaited=True)
    part.begin(0.0)
    stranger.publish("avatar.Ben.data.image", body(photographed, 1.0))
    part.tick(0.0, [])
    until(lambda: bool(seen.messages))
    assert {message.key for message in seen.messages} == {"lumen.Ben.visual.face.detection"}
    stranger.publish("avatar.Ana.data.image", body(photographed, 2.0))
    part.tick(0.1, [])
    until(lambda: len(seen.messages) == 2)
    assert seen.messages[1].key == "lumen.Ana.visual.face.detection"
    assert (there.bodies[0]["parts"], there.bodies[0]["state"]) == ([EYES], "here")
    assert sorted(line.split(":")[0] for line in part.summary()) == ["eyes of Ana", "eyes of Ben"]
    part.close()
    bus.close()
    stranger.close()


def test_where_two_are_served_no_alias_is_used_and_both_have_routes(two: Project) -> None:
    assert aliases_of(two) == {}
    keys = by_key(two)
    assert keys["lumen.Ana.visual.face.detection"] == keys["lumen.Ben.visual.face.detection"]
