"""Writes the files of a new skill: its manifest, its code, and a behaviour and a story that try it."""

import re
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.verbs import is_built_in
from lumen.project.added_verbs import usable_verbs

_MANIFEST = """\
{schema}description: {title}
in:
  required: [times]
  properties:
    times: {{type: integer, minimum: 1, maximum: 20, description: How often}}
out:
  properties:
    done: {{type: integer, default: 1, description: How often it was done}}
takes: "{{{{ times }}}}s"
performed-by: {{python: skills/{name}.py}}
"""
_CODE = """\
from lumen.skills import skill


@skill
def {name}(call, times):
    done = 0
    while done < times and call.wait(1):  # by the robot's clock; False at once if the call is cancelled
        done += 1
        print(f"{name}: {{done}} of {{times}}")  # the transcript shows this
    return {{"done": done}}
"""
_BEHAVIOR = """\
# Tries the skill `{name}`.
context: {{done: 0}}
states:
  trying:
    do: {{{name}: 2}}
    onDone: {{target: tried, actions: {{assign: {{done: event.data.done}}}}}}
    onError: failed
  tried: {{entry: {{log: "done: {{{{ context.done }}}}"}}, after: {{60s: trying}}}}
  failed: {{after: {{60s: trying}}}}
"""
_STORY = """\
# The skill `{name}`: `lumen test {story}` lets only its time pass, and with --real-skills its code runs.
behavior: {story}
steps:
  - expect: {{state: tried, did: {{{name}: 2}}}}
never: [failed]
"""


def write_skill(root: Path, name: str) -> list[str]:
    """Write the files of a skill into a project; return their paths relative to `root`.

    Raises UsageError if the skill can't have that name, or if any of the files exists.
    """
    if is_built_in(name) or name in usable_verbs() or name == "if":
        raise UsageError(f"there is a verb `{name}` already: give the skill another name")
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        raise UsageError(f"`{name}` can't be the name of a skill: use small letters, digits and `_`, as in `blink`")
    story = f"try_{name}"
    title = name.replace("_", " ").capitalize()
    own = "schemas/skill.schema.json"
    schema = f"# yaml-language-server: $schema=../{own}\n" if (root / own).is_file() else ""
    texts = {
        f"skills/{name}.yaml": _MANIFEST,
        f"skills/{name}.py": _CODE,
        f"behaviors/{story}.yaml": _BEHAVIOR,
        f"behaviors/stories/{story}.yaml": _STORY,
    }
    if there := next((file for file in texts if (root / file).exists()), ""):
        raise UsageError(f"{there} exists already: give the skill another name")
    for file, text in texts.items():
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        filled = text.format(name=name, story=story, title=title, schema=schema)
        (root / file).write_text(filled, encoding="utf-8")
    return list(texts)
