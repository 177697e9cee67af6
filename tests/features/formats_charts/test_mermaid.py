"""Diagrams: every state and arrow, in words that Mermaid 11 reads."""

from lumen.features.formats_charts.mermaid import mermaid
from lumen.statechart import Machine

CHART = {
    "id": "chart",
    "states": {
        "a:b": {
            "on": {
                "go": {"guard": 'event.data.text == "a;b" && true || false', "target": "p"},
                "hush": {"actions": {"log": "x"}},
            },
            "after": {"1.5s": "f"},
        },
        "p": {
            "type": "parallel",
            "onDone": "a:b",
            "states": {
                "r1": {"states": {"x": {"on": {"t": "y"}}, "y": {"type": "final"}}},
                "r2": {"on": {"out": "#f"}},
            },
        },
        "f": {"type": "final"},
        "h": {"type": "history", "history": "deep"},
    },
}

DIAGRAM = """\
stateDiagram-v2
  state "a#58;b<br/>hush" as s1
  state "p" as s2 {
    state "r1" as s3 {
      state "x" as s4
      state "y" as s5
      s5 --> [*]
      [*] --> s4
      s4 --> s5 : t
    }
    --
    state "r2" as s6
  }
  state "f" as s7
  s7 --> [*]
  state "h (H*)" as s8
  [*] --> s1
  s1 --> s2 : go [event.data.text == #34;a#59;b#34; && tru…]
  s1 --> s7 : after 1.5 s
  s2 --> s1 : done
  s6 --> s7 : out
"""


def test_a_diagram() -> None:
    assert mermaid(Machine.from_dict(CHART)) == DIAGRAM


def test_an_arrow_without_event_and_guard_has_no_caption() -> None:
    text = mermaid(Machine.from_dict({"states": {"a": {"always": "b"}, "b": None}}))
    assert text.splitlines()[-1] == "  s1 --> s2"


def test_a_parallel_root_stands_in_a_frame() -> None:
    text = mermaid(Machine.from_dict({"id": "tour", "type": "parallel", "states": {"a": None, "b": None}}))
    assert text.splitlines()[1:] == [
        '  state "tour" as s0 {',
        '    state "a" as s1',
        "    --",
        '    state "b" as s2',
        "  }",
    ]
