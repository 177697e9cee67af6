"""Lint of files of sayings: unknown names are found at their places."""

from lumen.lint import check_files
from lumen.project.files import read_files
from tests.lint.spans import assert_marks_what_is_spoken_of
from tests.lint.test_cases import HERE, changed, said
from tests.tables import for_each

HEARING = {
    "behaviors/tour.yaml": [
        "dance: {en: [dance, dancing], id: [menari]}",
        "dance: {en: [dance, 'dance {number:n}'], id: [menari]}",
        "        after: {20s: bye}\n",
        "        after: {20s: bye}\n        hears: {dance: bye, faq: bye}\n",
        "    on:\n      over: idle\n",
        "    hears: {not dance: idle, else: idle}\n    on:\n      over: idle\n",
    ]
}
A = "behaviors/sayings/a.yaml"
SOUND = """\
tour:
  talk.ask:
    dance: {en: [dance please, {say: dance two, n: 2}]}
    faq: {en: [{say: how tall, answer: I am small.}]}
    not dance: {id: [jangan menari]}
    else: {en: [hello]}
"""
UNKNOWN = """\
tuor: {talk: {else: {en: [a]}}}
tour:
  talk.aks: {dance: {en: [b]}}
  talk.ask:
    danse: {en: [c, d]}
    dance:
      en: [{say: dance two, nn: 2}]
      fr: [danse]
    faq: {en: [{say: how tall, answers: small}]}
    not dance: {en: [{say: e, answer: f}]}
"""
BROKEN = """\
tour:
  talk:
    else: {en: hello}
    not dance: {en: [3, {n: 2}, {say: a, n: [2]}], id: []}
"""


ROWS: dict[str, tuple[dict[str, str], dict[str, list[str]], list[str]]] = {
    "rows of a state and of one around it": ({A: SOUND}, HEARING, []),
    "names that are not there": (
        {A: UNKNOWN},
        HEARING,
        [
            "1:1 unknown-behavior | did you mean `tour`?",
            "3:3 unknown-state | did you mean `talk.ask`? states with `hears`: `talk`, `talk.ask`",
            "5:5 unknown-row | did you mean `dance`? available: `dance`, `else`, `faq`, `not dance`",
            "7:29 unknown-slot | did you mean `n`?",
            "8:7 unknown-language | it speaks `en`, `id`",
            "9:32 unknown-slot | did you mean `answer`?",
            "10:31 unknown-slot | they have `n`",
        ],
    ),
    "a state that hears nothing": (
        {A: "tour:\n  idle: {else: {en: [a, b]}, dance: {en: [c]}}\n"},
        HEARING,
        ["2:3 unknown-row | states with `hears`: `talk`, `talk.ask`"],
    ),
    "a behaviour that hears nothing": (
        {A: "tour: {idle: {else: {en: [a]}}}\n"},
        {},
        ["1:8 unknown-row | give it `hears`"],
    ),
    "rows that are perhaps in what is broken": (
        {A: "tour: {talk.ask: {dance: {en: [dance]}}}\n"},
        {"behaviors/tour.yaml": ["        after: {20s: bye}\n", "        hears: {dance: 3}\n"]},
        [],
    ),
    "sayings that are none": (
        {A: BROKEN},
        HEARING,
        [
            "3:16 wrong-type | write it in brackets: `[hello]`",
            '4:22 wrong-type | put it in quotes: "3"',
            "4:25 missing-key | add it, as in `say: I'm Budi`",
            "4:45 wrong-type | write it as in `n: Budi`",
            "4:56 wrong-value | What visitors say in a language",
        ],
    ),
    "states that are a list": (
        {A: "tour: [talk]\n"},
        {},
        ["1:7 wrong-type | write it as in `tour: {offer: {dance: {en: [Dance, please.]}}}`"],
    ),
    "a story among them": (
        {A: "title: A\nsteps: [{wait: 1s}]\n"},
        {},
        ["2:1 misplaced-file | move it to behaviors/stories/"],
    ),
    "words among them": ({A: "phrases: {yes: [b]}\n"}, {}, ["1:1 misplaced-file | move it to behaviors/words/"]),
    "another ending": (
        {"behaviors/sayings/a.yml": "tour: {}\n"},
        {},
        ["1:1 not-read | rename it to a.yaml, or delete it"],
    ),
    "another folder": (
        {"sayings/a.yaml": "tour: {}\n"},
        {},
        ["1:1 not-read | move the files that belong to the exhibition to behaviors/sayings/"],
    ),
}


@for_each(
    ("files", "edit", "expected"),
    ROWS.values(),
    ids=ROWS,
)
def test_what_is_wrong_in_a_file_of_sayings(
    files: dict[str, str], edit: dict[str, list[str]], expected: list[str]
) -> None:
    base = read_files(HERE / "base")
    written = changed(base, {"edit": edit, "write": {"behaviors/words/common.yaml": "description: None.\n", **files}})
    (file,) = files
    found = [one for one in check_files(HERE / "base", written)[1] if one.place.file == file]
    for line, wanted in zip(map(said, found), expected, strict=True):
        assert line.startswith(f"{file}:{wanted}"), line
    for one in found:
        assert_marks_what_is_spoken_of(one, written)
