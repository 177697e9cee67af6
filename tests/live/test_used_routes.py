"""A saved behaviour that hears another event, or publishes to another route, gets the route that comes with Lumen."""

from pathlib import Path

from tests import ROOT
from tests.copying import copied_project
from tests.live.shows import Live
from tests.waiting import Collector

HELLO = "behaviors/hello.yaml"
KEY, ALIAS = "lumen.NAO.audio.gender.identification", "lumen.audio.gender.identification"
TEXTS = "lumen.NAO.audio.text.stream"


def test_the_running_bus_listens_to_what_a_saved_behaviour_hears(tmp_path: Path) -> None:
    live = Live(copied_project(ROOT / "examples" / "minimal", tmp_path / "minimal"))
    bus, said = live.show.loop.bus, Collector()
    bus.subscribe(TEXTS, said)
    bus.publish(KEY, {"gender": "female"})
    live.live(0.5)
    assert live.states == {"waiting"}
    published = "{target: greeting, actions: {publish: {route: text_stream, body: {text: event.data.gender}}}}"
    live.edit("{face: greeting}", f"{{face: greeting, gender: {published}}}", HELLO)
    live.until(lambda: "applied" in live.verdicts)
    bus.publish(ALIAS, {"gender": "male"})
    live.until(lambda: "greeting" in live.states)
    live.until(lambda: {"text": "male"} in said.bodies)
    live.edit(f", gender: {published}", "", HELLO)
    live.until(lambda: live.verdicts.count("applied") == 2)
    assert {event for _, event in live.show.loop.inbox._undo} == {"face", "heard"}
    assert live.show.loop.project.routes.keys() == {"face", "heard"}
    live.close()
