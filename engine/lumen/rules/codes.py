"""Every code that a finding can have, by family: how bad it is, and in a line what it means.

`pages/CODE.md` says the rest: why it matters, and an example of what is wrong and of what is right.
"""

from collections.abc import Mapping
from typing import NamedTuple

from lumen.language.diagnostics import Severity

ERROR, WARNING, INFO = Severity.ERROR, Severity.WARNING, Severity.INFO


class Code(NamedTuple):
    """How bad a finding of this code is, and what it means."""

    severity: Severity
    summary: str


FAMILIES: Mapping[str, Mapping[str, Code]] = {
    "text": {
        "complex-key": Code(ERROR, "a key is a list or a map"),
        "duplicate-key": Code(ERROR, "a key stands twice in the same place"),
        "empty-file": Code(ERROR, "a file holds nothing"),
        "json-syntax": Code(ERROR, "a message schema is not JSON"),
        "merge-conflict": Code(ERROR, "both sides of a merge stand in the file"),
        "missing-file": Code(ERROR, "a file that is needed is not there"),
        "missing-folder": Code(ERROR, "something is named that should be in a folder in which nothing is"),
        "not-read": Code(WARNING, "a file ends in .yml and is not read"),
        "not-utf8": Code(ERROR, "a file is not UTF-8 text"),
        "tab": Code(ERROR, "a tab stands in the indentation"),
        "too-large": Code(ERROR, "a file is too large, or nested too deeply"),
        "unreadable-file": Code(ERROR, "a file can't be opened"),
        "curly-quotes": Code(WARNING, "quotes of a printed text stand where YAML's should"),
        "looks-like-number": Code(WARNING, "a number or text is not the number that it looks like"),
        "looks-like-truth": Code(WARNING, "`yes`, `no`, `on` or `off` is a text, and looks like true or false"),
        "yaml-syntax": Code(ERROR, "a file is not YAML"),
        "yaml-tag": Code(ERROR, "a tag stands before a value"),
    },
    "shape": {
        "missing-key": Code(ERROR, "a key that is needed is not there"),
        "one-verb": Code(ERROR, "an item says nothing, or two things at once"),
        "unknown-key": Code(ERROR, "a key that means nothing here"),
        "wrong-key": Code(ERROR, "a name has a form that is not allowed"),
        "wrong-type": Code(ERROR, "a text, a number, a list or a map stands where another is wanted"),
        "wrong-value": Code(ERROR, "a value is not one of those allowed"),
        "bad-duration": Code(ERROR, "a duration can't be read"),
        "extreme-number": Code(ERROR, "a number is too large or too small to count with"),
        "not-a-number": Code(ERROR, "a number is infinite or none"),
        "empty-range": Code(ERROR, "a range holds nothing"),
    },
    "references": {
        "unknown-behavior": Code(ERROR, "a behaviour is named that is not in behaviors/"),
        "unknown-context-key": Code(ERROR, "a key is used that `context` does not declare"),
        "unknown-controller": Code(ERROR, "a controller is named that is not in fuzzy/"),
        "unknown-event": Code(ERROR, "a behaviour waits for an event that nothing raises"),
        "unknown-field": Code(ERROR, "a field is named that the messages of the route do not have"),
        "unknown-joint": Code(ERROR, "the robot has no joint of that name"),
        "unknown-language": Code(ERROR, "a language is named that the project does not speak"),
        "unknown-message": Code(ERROR, "a message schema is named that is not in schemas/messages/"),
        "unknown-model": Code(ERROR, "a robot's body is named that is not in models/"),
        "unknown-motion": Code(ERROR, "a motion is named that is not in motions/"),
        "unknown-pose": Code(ERROR, "a pose is named that the motion does not define"),
        "unknown-posture": Code(ERROR, "the robot knows no posture of that name"),
        "unknown-route": Code(ERROR, "a route is named that is not in lumen.yaml"),
        "unknown-sensor": Code(ERROR, "the robot has no tactile sensor of that name"),
        "unknown-state": Code(ERROR, "a state is named that does not exist"),
        "unknown-story": Code(ERROR, "a story is named that is not in behaviors/stories/"),
        "same-but-case": Code(WARNING, "two names differ in capital letters only"),
        "unused-answers": Code(WARNING, "answers are written that nothing looks up"),
        "unused-context-key": Code(WARNING, "a key of the context is never read"),
        "unused-file": Code(INFO, "a motion, behaviour or controller is named nowhere"),
        "unused-phrases": Code(WARNING, "phrases are written that nothing listens for"),
    },
    "statecharts": {
        "conflicting-targets": Code(ERROR, "the states of a target can't be active together"),
        "duplicate-id": Code(ERROR, "two states, or two behaviours that are invoked at once, have the same id"),
        "endless-always": Code(ERROR, "an `always` would run for ever"),
        "final-in-parallel": Code(ERROR, "a final state is a region of a parallel state"),
        "invoke-cycle": Code(ERROR, "a behaviour would invoke itself in the end"),
        "misplaced-key": Code(ERROR, "a key stands in a kind of state that does not have it"),
        "no-states": Code(ERROR, "a compound or parallel state has no states"),
        "not-within": Code(ERROR, "a state is named that does not lie in the one meant"),
        "never-done": Code(ERROR, "an `onDone` stands in a state that has no `do`"),
        "still-there": Code(ERROR, "something is said to be renamed that still has its old name"),
        "only-in-do": Code(ERROR, "a verb that waits stands outside `do`"),
        "always-loop": Code(WARNING, "an `always` would run for ever while its guard is true"),
        "dead-end": Code(WARNING, "nothing leads on from a state"),
        "no-way-back": Code(WARNING, "no way leads back from a state to where the behaviour begins"),
        "history-of-end": Code(WARNING, "a history is gone to that remembers the end of its state"),
        "cut-short": Code(WARNING, "an `after` comes before the `do` beside it can be done"),
        "waits-for-ever": Code(WARNING, "a state is left only if a visitor does something"),
        "constant-guard": Code(WARNING, "a guard is always true, or never"),
        "overlapping-guards": Code(INFO, "phrases are taken for others that are asked for earlier"),
        "shadowed-transition": Code(WARNING, "a transition is never taken, because one before it always is"),
        "unreachable-state": Code(WARNING, "no transition leads to a state"),
        "unsupported": Code(ERROR, "something that can't be run yet"),
        "no-effect": Code(WARNING, "something that is read, and has no effect yet"),
        "unused-event": Code(WARNING, "an event is raised that nothing waits for"),
    },
    "reload": {
        "reload-forgets": Code(WARNING, "a reload would lose a value (`--against`)"),
        "reload-moves": Code(INFO, "a reload would lead from a state that is gone to another (`--against`)"),
        "reload-refused": Code(ERROR, "a reload would be refused while a state is active (`--against`)"),
    },
    "expressions": {
        "expression-syntax": Code(ERROR, "an expression can't be read"),
        "type-mismatch": Code(ERROR, "values stand together in an expression that can't go together"),
        "unguarded-field": Code(ERROR, "a field is read that not every event has"),
        "unknown-answers": Code(ERROR, "an answers table is named that the file does not have"),
        "unknown-function": Code(ERROR, "an expression calls a function that does not exist"),
        "unknown-name": Code(ERROR, "an expression uses a name that does not exist"),
        "unknown-phrase": Code(ERROR, "phrases are named that the file does not have"),
        "unsafe-pattern": Code(ERROR, "a pattern of `matches` could take for ever"),
        "wrong-argument": Code(ERROR, "a function is given something it can't use"),
        "wrong-argument-count": Code(ERROR, "a function is given too few or too many arguments"),
    },
    "speech": {
        "not-filled-in": Code(WARNING, "the name of a value is said in place of the value"),
        "shadowed-answer": Code(WARNING, "an answer is never given, because one before it always is"),
        "missing-language": Code(WARNING, "a text is missing in one of the project's languages"),
    },
    "controllers": {
        "duplicate-variable": Code(ERROR, "an input and an output have the same name"),
        "empty-term": Code(ERROR, "a term covers nothing"),
        "no-rules": Code(ERROR, "a controller has no rules"),
        "no-shape": Code(ERROR, "a term has no shape"),
        "not-an-output": Code(ERROR, "a rule concludes something of a variable that is no output"),
        "not-ascending": Code(ERROR, "the corners of a term do not rise"),
        "not-finite": Code(ERROR, "a number is infinite where it can't be"),
        "not-positive": Code(ERROR, "a width is not more than 0"),
        "reserved-name": Code(ERROR, "a variable or term is called like a word of the rules"),
        "rule-syntax": Code(ERROR, "a rule can't be read"),
        "term-without-set": Code(ERROR, "a term has no set, and the defuzzifier needs one"),
        "term-without-value": Code(ERROR, "a term has no value, and the defuzzifier needs one"),
        "two-shapes": Code(ERROR, "a term has two shapes"),
        "unbound-input": Code(ERROR, "an input of a bound controller has no message field to come from"),
        "unbound-output": Code(ERROR, "an output of a bound controller moves no joint"),
        "unknown-term": Code(ERROR, "a rule names a term that the variable does not have"),
        "unknown-variable": Code(ERROR, "a rule or a binding names a variable that does not exist"),
        "wrong-parameters": Code(ERROR, "a term has too few or too many numbers"),
    },
    "motions": {
        "angle-out-of-range": Code(ERROR, "an angle lies outside the joint's limits"),
        "hand-out-of-range": Code(ERROR, "a hand is opened to less than 0 or more than 1"),
        "handles-without-key": Code(ERROR, "handles are given for a joint that has no key there"),
        "mixed-keyframe": Code(ERROR, "a keyframe is a block and a pose at once"),
        "motion-cycle": Code(ERROR, "a motion plays itself in the end"),
        "no-tempo": Code(ERROR, "beats are counted without a tempo"),
        "no-time": Code(ERROR, "a keyframe has no time"),
        "shared-drive": Code(ERROR, "two joints with one motor stand at different angles"),
        "time-not-increasing": Code(ERROR, "a keyframe comes before the one above it"),
        "too-fast": Code(ERROR, "a joint would have to move faster than it can"),
        "too-many-keys": Code(ERROR, "a motion is longer than can be played"),
        "two-times": Code(ERROR, "a keyframe has a time and a beat"),
        "zero-duration": Code(ERROR, "a motion takes no time"),
    },
    "robot": {
        "incomplete-posture": Code(ERROR, "a posture leaves out a joint"),
        "joint-in-two-parts": Code(ERROR, "a joint stands in two parts of the body"),
        "joint-without-part": Code(ERROR, "a joint stands in no part of the body"),
        "unsorted-rows": Code(ERROR, "the rows of a table do not rise"),
        "broken-model": Code(ERROR, "a model is no MJCF, or lacks a file or a joint"),
        "wrong-unit": Code(WARNING, "an angle or a length is given in another unit than the file's"),
        "bad-stage": Code(ERROR, "the stage does not hold the place where the robot starts"),
    },
    "routes": {
        "duplicate-route": Code(ERROR, "two routes carry the same key to the same event"),
        "endless-reference": Code(ERROR, "a reference in a message schema leads back to itself"),
        "foreign-reference": Code(ERROR, "a message schema refers to something outside itself"),
        "missing-route": Code(WARNING, "a route is missing that something the behaviour does needs"),
        "no-ttl": Code(WARNING, "a command may come late, and is done all the same"),
        "wrong-direction": Code(WARNING, "a route is used the other way round than it goes"),
        "route-key": Code(ERROR, "a routing key has a form that no message could have"),
        "unused-route": Code(WARNING, "the messages of a route become an event that nothing waits for"),
    },
    "comments": {
        "ignore-without-reason": Code(WARNING, "an ignore comment does not say why"),
        "ignored-error": Code(WARNING, "an ignore comment names a code that is an error"),
        "unknown-code": Code(WARNING, "an ignore comment names a code that does not exist, or none"),
        "unused-ignore": Code(WARNING, "an ignore comment hides nothing"),
    },
}
"""The codes of each family, in the order in which they are listed."""

CODES: Mapping[str, Code] = {code: entry for family in FAMILIES.values() for code, entry in family.items()}
