"""Hostile files, from a `random.Random`: saved into a project, or passed to `lumen import`.

    project_file(random, files)   a path in a project, and its new content: one of `files`, damaged, or another
    foreign_file(random)          a name, and the content of a statechart, motion or controller of another tool

`files` are those of a sound project, by path (`lumen.project.files.read_files`). The content has one to three damages,
each made by a small function (`DAMAGES`), or is hostile as a whole (`MONSTERS`). It depends only on the seed, and is
never much larger than `LARGEST`.
"""

import re
from collections.abc import Callable, Mapping
from random import Random

LARGEST = 256 * 1024
"""The maximum length of a file [bytes]: enough to expose code that is slow for the size of its input."""

NUMBERS = (
    "0x" + "f" * 5_000, "0o" + "7" * 5_000, "9" * 5_000, "-" + "9" * 400, "1e999", "-1e308", "1e-320", ".nan", "-.inf",
    "NaN", "-0.0", "0x80000000000000000", "9223372036854775808", "1_000", "١٢", "0", "-1", "1e3", "1000000000",
)  # fmt: skip
TEXTS = (
    "", " ", "~", "\x00", "\ud800", "\u202e\u2066", "\x1b[2J", "İ", "ﬀ", "\U000e0001", "\ufeff", "\u2028", "\x85",
    "../../../../etc/passwd", "/dev/zero", "a" * 20_000, "a." * 10_000, "*", "**", "<<", "__proto__", "#idle", "..",
    "{{ context.asked", "}}", "{{ " * 200, "{{ context.visitor + 'x' * 9 }}", "any", "^(a+)+$", "(" * 300, "[[:^a",
    "context." * 300 + "x", "!" * 400 + "true", "(" * 400 + "1" + ")" * 400, "1" + " + 1" * 900, "a ? b : " * 300 + "c",
    "'" + "a" * 3_000, "matches(event.data.result, '(x{1,1000}){1,1000}')", "size('" + "x" * 1_900 + "')",
    "if " + " and ".join(["x is left"] * 500) + " then yaw is left", "500ms", "-1s", "1e9h", "99999999999999999h",
)  # fmt: skip
NESTS = (("[", "]"), ("{a: ", "}"), ("- ", ""), ("? ", ""), ("&a [", "]"), ("!!python/object ", ""), ('{"a":', "}"),
         ("<state>", "</state>"), ("<body>", "</body>"), ("(", ")"), ("not ", ""), ("{'if': ", "}"))  # fmt: skip
DEPTHS = (20, 95, 200, 1_000, 20_000)
_NUMBER, _WORD = re.compile(r"-?\d+(\.\d+)?"), re.compile(r"[A-Za-z_][\w.-]*")

Damage = Callable[[Random, str], str]
Monster = Callable[[Random], str]


def project_file(random: Random, files: Mapping[str, bytes]) -> tuple[str, bytes]:
    """Return the path of a project file and its new, hostile content."""
    path = random.choice(sorted(files))
    if random.random() < 0.15:
        return path, _encoded(random, random.choice(MONSTERS)(random))
    return path, _encoded(random, damaged(random, files[path].decode("utf-8", "replace")))


def foreign_file(random: Random) -> tuple[str, bytes]:
    """Return the name of a file of another tool, and its hostile content."""
    ending = random.choice(sorted(FOREIGN))
    text = random.choice(MONSTERS)(random) if random.random() < 0.1 else damaged(random, FOREIGN[ending])
    return f"attack.{ending}", _encoded(random, text)


def damaged(random: Random, text: str) -> str:
    """Return the text with one to three damages, cut at `LARGEST` characters."""
    for _ in range(random.randrange(1, 4)):
        text = random.choice(DAMAGES)(random, text)[:LARGEST]
    return text


def _encoded(random: Random, text: str) -> bytes:
    """Return the text as UTF-8, seldom in another encoding or with invalid bytes."""
    data = text.encode("utf-8", "surrogatepass")[:LARGEST]
    match random.randrange(30):
        case 0:
            return text.encode("utf-16", "surrogatepass")
        case 1:
            return b"\xef\xbb\xbf" + data
        case 2:
            at = random.randrange(len(data) + 1)
            return data[:at] + random.randbytes(random.randrange(1, 9)) + data[at:]
    return data


def _matched(random: Random, pattern: re.Pattern[str], text: str, new: str) -> str:
    """Return the text with `new` in place of a random match, or at its end without a match."""
    found = list(pattern.finditer(text))
    if not found:
        return text + new
    match = random.choice(found)
    return text[: match.start()] + new + text[match.end() :]


def _cut(random: Random, text: str) -> str:
    return text[: random.randrange(len(text) + 1)]


def _number(random: Random, text: str) -> str:
    return _matched(random, _NUMBER, text, random.choice(NUMBERS))


def _word(random: Random, text: str) -> str:
    return _matched(random, _WORD, text, random.choice((*TEXTS, *NUMBERS, *_WORD.findall(text)[:200])))


def _quoted(random: Random, text: str) -> str:
    new = random.choice(TEXTS).replace("\\", "\\\\").replace('"', '\\"')
    return _matched(random, _WORD, text, f'"{new}"')


def _lines(random: Random, text: str) -> str:
    """Return the text with a line doubled, removed, moved or indented further."""
    lines = text.split("\n")
    at, other = random.randrange(len(lines)), random.randrange(len(lines))
    new: tuple[list[str], ...] = (
        [],
        [lines[at]] * 2,
        [lines[other]],
        ["  " + lines[at]],
        [lines[at].lstrip()],
        ["\t" + lines[at]],
    )
    lines[at : at + 1] = random.choice(new)
    return "\n".join(lines)


def _repeated(random: Random, text: str) -> str:
    """Return the text with a part of it repeated 3, 100 or 3,000 times."""
    at, length = random.randrange(len(text) + 1), random.choice((1, 5, 40, 400))
    return text[:at] + text[at : at + length] * random.choice((3, 100, 3_000)) + text[at:]


def _sign(random: Random, text: str) -> str:
    at = random.randrange(len(text) + 1)
    return (
        text[:at]
        + random.choice("{}[]<>&*!|%@`'\"#:,-?.\\\t\r\x00\x7f\u2029$^~=/;()")
        + text[at + random.randrange(2) :]
    )


def _nested(random: Random, text: str) -> str:
    (before, after), depth = random.choice(NESTS), random.choice(DEPTHS)
    return _matched(
        random, random.choice((_WORD, _NUMBER)), text, before * depth + random.choice(("1", "")) + after * depth
    )


DAMAGES: tuple[Damage, ...] = (_cut, _number, _word, _quoted, _lines, _repeated, _sign, _nested)
"""The kinds of damage that a file may have."""


def _bomb(random: Random) -> str:
    """Return YAML with aliases of aliases, which would expand to at most 10^11 entries."""
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, random.randrange(2, 12))]
    return "\n".join(lines)


def _circle(random: Random) -> str:
    return random.choice(("&a [*a]", "states: &s {a: {states: *s}}", "&a {*a : *a}", "a: &a\n  b: *a\n<<: *a"))


def _wide(random: Random) -> str:
    """Return a text that repeats one element very often."""
    one = random.choice(
        ("- 1\n", "a, ", "x: 1\n", "%TAG !a! b:\n", "&a ", "!t ", "---\n", "<a/>", "{}", '"', "'", "\n", "é")
    )
    return random.choice(("", "[", "{", "states:\n", "<mujoco>", "<scxml>")) + one * random.choice((100, 20_000))


def _entities(random: Random) -> str:
    bomb = "".join(f'<!ENTITY a{i} "&a{i - 1};&a{i - 1};">' for i in range(1, 30))
    entity = random.choice((f'<!ENTITY a0 "ha">{bomb}', '<!ENTITY a29 SYSTEM "file:///etc/passwd">'))
    root = random.choice(("scxml", "mujoco", "ChoregrapheProject"))
    return f"<!DOCTYPE {root} [{entity}]><{root}><state id='s'/>&a29;</{root}>"


def _deep(random: Random) -> str:
    (before, after), depth = random.choice(NESTS), random.choice(DEPTHS)
    return before * depth + after * random.choice((0, depth))


def _noise(random: Random) -> str:
    return random.randbytes(random.randrange(200)).decode("latin-1")


MONSTERS: tuple[Monster, ...] = (_bomb, _circle, _wide, _entities, _deep, _noise)
"""Makers of texts that are hostile as a whole."""

_KEYS = "names = list()\ntimes = list()\nkeys = list()\nnames.append('HeadYaw')\ntimes.append([1, 2.5])\n"
FOREIGN: Mapping[str, str] = {
    "scxml": """<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" datamodel="ecmascript" initial="a">
<datamodel><data id="n" expr="1 + 2"/></datamodel>
<parallel id="a"><state id="b"><onentry><send event="e" delay="1s" id="t"/><log expr="'n ' + n"/></onentry>
<transition event="e f.*" cond="n &gt; 2 &amp;&amp; In('b')" target="c"><assign location="n" expr="n + 1"/></transition>
</state><state id="d"><history id="h" type="deep"><transition target="d1"/></history><state id="d1"/></state></parallel>
<final id="c"><donedata><param name="x" expr="n"/></donedata></final></scxml>""",
    "json": """{"id": "m", "initial": "a", "context": {"n": 1}, "states": {"a": {"entry": [{"type": "xstate.raise",
"params": {"event": {"type": "e"}}}], "on": {"e": [{"target": "b.c", "guard": "more"}], "f.*": {"target": "#x"}},
"after": {"1000": "b"}}, "b": {"id": "x", "initial": "c", "type": "compound", "states": {"c": {"type": "final"},
"h": {"type": "history", "history": "deep"}}, "onDone": "a", "invoke": {"src": "quiz", "id": "q"}}}}""",
    "fll": """Engine: e
InputVariable: x
  enabled: true
  range: 0.000 1.000
  term: low Triangle 0.000 0.250 0.500
  term: high Function x*2+sin(x)
OutputVariable: y
  enabled: true
  range: 0.000 1.000
  aggregation: Maximum
  defuzzifier: Centroid 100
  default: nan
  term: up Gaussian 0.500 0.200
RuleBlock: r
  conjunction: Minimum
  disjunction: Maximum
  implication: Minimum
  activation: General
  rule: if x is low or not (x is very high) then y is up with 0.500
""",
    "fcl": """FUNCTION_BLOCK b (* one *)
VAR_INPUT x : REAL; END_VAR
VAR_OUTPUT y : REAL; END_VAR
FUZZIFY x
  TERM low := (0, 1) (4.5, 0);
  TERM high := trian 1 2 3;
  RANGE := (0 .. 9);
END_FUZZIFY
DEFUZZIFY y
  TERM up := 5;
  METHOD : COGS; DEFAULT := 0;
END_DEFUZZIFY
RULEBLOCK r
  AND : MIN; ACT : MIN; ACCU : MAX;
  RULE 1 : IF x IS low AND NOT x IS high THEN y IS up WITH 0.5;
END_RULEBLOCK
END_FUNCTION_BLOCK
""",
    "fis": """[System]
Name='t'
Type='mamdani'
AndMethod='prod'
OrMethod='probor'
ImpMethod='min'
AggMethod='max'
DefuzzMethod='centroid'
[Input1]
Name='the service'
Range=[0 10]
NumMFs=2
MF1='poor':'gaussmf',[1.5 0]
MF2='good':'gbellmf',[2 4 9]
[Output1]
Name='tip'
Range=[0 30]
NumMFs=1
MF1='cheap':'trimf',[0 5 10]
[Rules]
1, 1 (1) : 2
-2, 1 (0.5) : 1
""",
    "motion": "#WEBOTS_MOTION,V1.0,RShoulderPitch,HeadYaw\n00:00:500,Pose1,-1.0,0.2\n00:01:000,Pose2,*,-0.2\n",
    "py": f"{_KEYS}keys.append([[0.5, [3, -0.25, 0], [3, 0.2, 0.1]], [-0.5, [3, -0.3, 0], [3, 0, 0]]])\n",
    "xar": """<?xml version="1.0" encoding="UTF-8"?>
<ChoregrapheProject xmlns="http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd" xar_version="3">
<Box name="root" id="-1"><Timeline enable="0"><BehaviorLayer name="l"><BehaviorKeyframe name="k" index="1"><Diagram>
<Box name="wave" id="1"><Timeline enable="1" fps="20" start_frame="1" end_frame="-1" size="40"><ActuatorList model="n">
<ActuatorCurve name="value" actuator="HeadYaw" mute="0" unit="0"><Key frame="20" value="10">
<Tangent side="left" interpType="bezier" abscissaParam="-5" ordinateParam="1.5"/></Key><Key frame="40" value="-10"/>
</ActuatorCurve></ActuatorList></Timeline></Box>
</Diagram></BehaviorKeyframe></BehaviorLayer></Timeline></Box></ChoregrapheProject>""",
}
"""A sound file of each kind, by its ending."""
