"""Places in the tools: stories, exploring, the diff of two versions, the editor."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.definitions import definitions
from lumen.features.editor.renaming import renamable, rename
from lumen.insight.changes.projects import changes
from lumen.insight.exploration import explore
from lumen.lint import check_files
from lumen.statechart import Machine
from tests import ROOT
from tests.features.editor.test_services import SHIPPED, TOUR, place
from tests.reload.test_changes import FILES
from tests.tour.conftest import copy, project

__all__ = ["copy", "project"]

STAGE = "stage: {x: [-0.4, 0.4], y: [-0.6, 0.6]}"
PLACES = STAGE + "\nplaces:\n  organ: {x: 0.3, y: 0.5, heading: 90}\n  clock: {x: -0.3, y: -0.5}\n"

GUIDE = """\
id: guide
context: {next: clock, was: ''}
initial: door
states:
  door:
    after: {2s: walking}
  walking:
    do:
      - {walk: {to: organ}}
      - {say: {any: "Here is the {{ state.place }}"}}
      - {walk: {to: "{{ context.next }}"}}
    onDone: there
    onError: lost
  there:
    entry: {assign: {was: state.place}}
    always: {guard: "state.place == 'clock'", target: shown}
    after: {2s: door}
  shown:
    after: {2s: door}
  lost:
    after: {2s: door}
"""
TOURIST = """\
behavior: guide
never: [lost]
steps:
  - expect: {place: organ, said: Here is the organ}
  - expect: {place: clock, state: shown, context: {was: clock}}
  - expect: {place: organ, within: 60s}
"""


@pytest.fixture
def guide(copy: Path) -> Path:
    """The shipped exhibition with places, a guide and a story about it."""
    main_file = copy / "lumen.yaml"
    main_file.write_text(main_file.read_text("utf-8").replace(STAGE, PLACES), "utf-8")
    (copy / "behaviors" / "guide.yaml").write_text(GUIDE, "utf-8")
    (copy / "behaviors" / "stories" / "tourist.yaml").write_text(TOURIST, "utf-8")
    return copy


def test_a_story_goes_from_place_to_place(guide: Path) -> None:
    assert main(["test", str(guide), "tourist"]) == 0


def test_a_story_says_where_the_robot_is_in_place_of_where_it_should_be(
    guide: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    story = guide / "behaviors" / "stories" / "tourist.yaml"
    steps = "behavior: guide\nsteps:\n  - expect: {place: clock, within: 60s}\n  - expect: {place: organ, within: 1s}\n"
    story.write_text(steps, "utf-8")
    assert main(["test", str(guide), "tourist"]) == 1
    assert "expected the robot to be at `organ` within 1 s, but it is at `clock`" in capsys.readouterr().out


def test_exploring_knows_where_a_walk_leads() -> None:
    machine = Machine.from_dict({"id": "m", "states": {
        "a": {"do": [{"walk": {"to": "organ"}}, {"walk": {"to": "clock"}}], "onDone": "b"},
        "b": {"always": {"guard": "state.place == 'clock'", "target": "c"}},
        "c": {"type": "final"},
    }, "initial": "a"}, "m")  # fmt: skip
    assert explore(machine, {}).never_entered == ()


def test_what_changes_of_places_is_told() -> None:
    def edited(text: str) -> dict[str, bytes]:
        main_file = FILES["lumen.yaml"].decode().replace("story: visitor", "").replace(STAGE, text)
        files = {name: content for name, content in FILES.items() if not name.startswith("behaviors/stories/")}
        return {**files, "lumen.yaml": main_file.encode()}

    old, new = edited(PLACES), edited(PLACES.replace("x: 0.3", "x: 0.2").replace("clock", "globe"))
    before, after = (check_files(ROOT, files)[0] for files in (old, new))
    assert before
    assert after
    assert [change.sentence for change in changes(before, after)] == [
        "place `organ` changed",
        "place `clock` removed",
        "place `globe` added",
    ]


def test_the_editor_completes_places_and_finds_where_they_stand() -> None:
    text = SHIPPED.text(TOUR)
    walks: Analysis = SHIPPED.changed("lumen.yaml", SHIPPED.text("lumen.yaml").replace(STAGE, PLACES))
    assert walks.index  # an editor has the names by the next key
    begun = walks.changed(TOUR, text.replace("{posture: Stand}", "{walk: {to: }}", 1))
    proposed = {item.text for item in complete(begun, *place(begun, TOUR, "{walk: {to: |}}"))}
    assert {"organ", "clock"} <= proposed
    assert "Stand" not in proposed
    whole = walks.changed(TOUR, text.replace("{posture: Stand}", "{walk: {to: organ}}", 1))
    [found] = definitions(whole, *place(whole, TOUR, "{walk: {to: or|gan}}"))
    assert found.file == "lumen.yaml"
    assert whole.text("lumen.yaml").split("\n")[found.line - 1][found.column - 1 :].startswith("organ: {x: 0.3")
    word = renamable(whole, *place(whole, TOUR, "{walk: {to: or|gan}}"))
    assert word
    renamed = rename(whole, word, "pipes")
    assert {edit.place.file for edit in renamed.edits} == {"lumen.yaml", TOUR}
    asked = walks.changed(TOUR, text.replace("context.name_tries < 2", "state.", 1))
    assert {"path", "language", "place"} <= {i.text for i in complete(asked, *place(asked, TOUR, "state.|"))}
