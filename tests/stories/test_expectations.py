"""Actions and expectations of a story, and the report of one that fails."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.language.stories import Expect
from lumen.run.story_observations import StoryObservations

KNOCK = "  - event: {name: knock, data: {who: Ani}}\n"

Write = Callable[..., Path]


def test_a_story_about_another_behaviour_with_everything_in_it(story: Write) -> None:
    project = story(
        KNOCK
        + "  - expect: {state: open, said_exactly: 'Hello, Ani!', context: {name: Ani, opened: 8}}\n"
        + "  - expect: {played: goodbye}\n"
        + "  - wait: 15s\n"
        + "  - expect: {state: closed.wait, within: 1s}\n"
        + "  - event: {name: knock, data: {who: nobody}}\n"
        + "  - wait: 1s\n"
        + "  - expect: {state: closed, within: 1s}\n",
        "context: {opened: 7}\nlanguage: id\nnever: [closed.never]\n",
    )
    assert main(["test", str(project), "knocking"]) == 0


@pytest.mark.parametrize("body", ["", ", body: {who: Ani}", ", body: {times: [1, 2], at: 9}"])
def test_a_message_is_known_by_a_part_of_its_body(story: Write, body: str) -> None:
    project = story(f"{KNOCK}  - expect: {{published: {{route: journal{body}}}}}\n", 'at: "09:30"\n')
    assert main(["test", str(project), "knocking"]) == 0


@pytest.mark.parametrize(
    ("expected", "words"),
    [
        ("{state: closed}", "expected state `closed` within 30 s, but the active states are `open`"),
        ("{said: goodbye}", "expected to hear “goodbye” within 30 s, but it said “Hello, Ani!”"),
        ("{said_exactly: hello}", "expected to hear exactly “hello” within 30 s, but it said “Hello, Ani!”"),
        ("{played: dance}", "expected the motion `dance` within 30 s, but it played `goodbye`"),
        (
            "{published: fact}",
            "a message on `fact` within 30 s, but it sent {'who': 'Ani', 'at': 9, 'times': [1, 2]} on `journal`",
        ),
        (
            "{published: {route: journal, body: {who: Budi}}}",
            "a message on `journal` with {'who': 'Budi'} within 30 s, but it",
        ),
        (
            "{published: {route: journal, body: {times: [1]}}}",
            "a message on `journal` with {'times': [1]} within 30 s, but it",
        ),
        ("{context: {opened: 2}, within: 3s}", "expected opened = 2 within 3 s, but it is 1"),
    ],
)
def test_what_does_not_hold_is_told_with_its_place(
    story: Write, capsys: pytest.CaptureFixture[str], expected: str, words: str
) -> None:
    project = story(f"{KNOCK}  - expect: {expected}\n", 'at: "09:30"\n')
    door = project / "behaviors" / "door.yaml"
    door.write_text(door.read_text("utf-8").replace("20s: closed", "2min: closed"), "utf-8")
    assert main(["test", str(project), "knocking"]) == 1
    told = capsys.readouterr().out
    assert "behaviors/stories/knocking.yaml:6:5: step 2: " in told
    assert words in told
    assert "state    open  (knock)" in told
    assert "robot    “Hello, Ani!”" in told
    assert "1 story, 1 failed" in told


def test_what_was_missing_when_the_rest_held_is_told(story: Write, capsys: pytest.CaptureFixture[str]) -> None:
    project = story(f"{KNOCK}  - expect: {{place: organ, said: Hallo, within: 60s}}\n")
    door = project / "behaviors" / "door.yaml"
    walk = "do: [{walk: {to: organ}}, {say: 'Hello, {{ context.name }}!'}, {walk: {to: start}}, {say: Bye}]"
    door.write_text(re.sub(r"do: .*", walk, door.read_text("utf-8")).replace("20s: closed", "2min: closed"), "utf-8")
    main_file = project / "lumen.yaml"
    places = "places: {start: {x: 0, y: 0}, organ: {x: 0.2, y: 0.2}}\n"
    main_file.write_text(re.sub(r"(?m)^places:.*\n(?:[ #].*\n)*", "", main_file.read_text("utf-8")) + places, "utf-8")
    assert main(["test", str(project), "knocking"]) == 1
    assert "expected to hear “Hallo” within 60 s, but it said “Hello, Ani!”\n" in capsys.readouterr().out


def test_before_anything_was_seen_no_state_is_active() -> None:
    (lacking,) = StoryObservations().unmet(Expect(states=("open",)))
    assert (lacking.expected, lacking.was, lacking.state) == ("state `open`", "the active states are nothing", True)


def test_of_several_texts_the_nearest_is_told(story: Write, capsys: pytest.CaptureFixture[str]) -> None:
    again = "  - wait: 21s\n  - event: {name: knock, data: {who: Budi}}\n"
    project = story(f"{KNOCK}{again}  - expect: {{said: Helo Ani}}\n")
    assert main(["test", str(project), "knocking"]) == 1
    assert "it said “Hello, Ani!”; “Hello, Budi!”; the nearest is “Hello, Ani!”\n" in capsys.readouterr().out


def test_a_state_that_must_never_be_is_told_with_the_step_it_came_in(
    story: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    project = story("  - wait: 1s\n  - event: slam\n  - wait: 1s\n", "never: [closed.never]\n")
    assert main(["test", str(project), "knocking"]) == 1
    told = capsys.readouterr().out
    assert "knocking.yaml:7:5: step 3: expected never state `closed.never`, but it was entered" in told


def test_a_behaviour_that_never_comes_to_rest_fails_the_story(story: Write, capsys: pytest.CaptureFixture[str]) -> None:
    project = story("  - event: spin\n  - wait: 1s\n")
    assert main(["test", str(project), "knocking"]) == 1
    captured = capsys.readouterr()
    assert "never comes to rest" in captured.out
    assert captured.err == ""


def test_a_behaviour_that_can_not_begin_fails_the_story(story: Write, capsys: pytest.CaptureFixture[str]) -> None:
    project = story("  - wait: 1s\n")
    door = project / "behaviors" / "door.yaml"
    door.write_text(door.read_text("utf-8").replace("initial: closed", "initial: spinning"), "utf-8")
    assert main(["test", str(project), "knocking"]) == 1
    captured = capsys.readouterr()
    assert "step 1: `door` never comes to rest" in captured.out
    assert captured.err == ""


def test_the_time_of_day_is_ten_where_a_story_does_not_say(story: Write) -> None:
    project = story(f"{KNOCK}  - expect: {{published: {{route: journal, body: {{at: 10}}}}}}\n")
    assert main(["test", str(project), "knocking"]) == 0
