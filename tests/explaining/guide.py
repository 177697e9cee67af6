"""A guide that hears wishes, questions, numbers and names, and a project around it."""

from pathlib import Path
from typing import Any

import yaml

from lumen.language.machines import MachineDefinition
from lumen.project.standalone import machine_from_dict

GUIDE = """\
words: common
phrases:
  dance: {en: [dance], id: [menari]}
  sing: {en: [sing], id: [menyanyi]}
  tour_of: {en: ["show me the {exhibits}", "exhibit {number:n}"]}
answers:
  faq:
    - {phrases: {en: [how tall are you], id: [tinggi kamu]}, value: {en: Small., id: Kecil.}}
lists:
  exhibits:
    - {phrases: {en: [pipe organ, organ]}, right: [wood]}
    - {phrases: {en: [clock]}, right: [gold]}
context: {tries: 0}
initial: ask_name
states:
  ask_name:
    hears:
      my_name: offer
      else: [{guard: context.tries < 2, target: .}, offer]
  offer:
    states:
      choice:
        id: choice
        hears:
          dance: .
          sing: {guard: context.tries > 2, target: .}
          not dance|sing: "#bye"
          asked dance: .
          tour_of: .
          faq: {guard: 1 / context.tries > 0, target: .}
      quiet: {on: {heard: choice, "*": quiet}, hears: {dance: choice}}
    hears:
      no|done: bye
      else: .
  quiz:
    for: {each: lists.exhibits, as: exhibit}
    states:
      ask: {hears: {exhibit.right: told, else: told}}
      told: {type: final}
    onDone: offer
  bye:
    id: bye
    after: {20s: ask_name}
"""
SETTINGS = """\
name: Guide
behavior: guide
languages: [en, id, de]
robot: {name: NAO, model: nao}
routes:
  heard: {key: "lumen.{robot}.heard", direction: in, schema: speech.recognition, event: heard, ttl: 5s}
"""


def guide(**changes: Any) -> MachineDefinition:
    """Return the machine of the guide; `changes` replace keys of its file."""
    return machine_from_dict({**yaml.safe_load(GUIDE.replace("on:", "'on':")), **changes}, "guide", {})


def guide_in(folder: Path, **sayings: str) -> Path:
    """Write a project of the guide, with files of sayings by name; return its folder."""
    (folder / "behaviors" / "sayings").mkdir(parents=True)
    (folder / "lumen.yaml").write_text(SETTINGS, "utf-8")
    (folder / "behaviors" / "guide.yaml").write_text(GUIDE, "utf-8")
    for name, text in sayings.items():
        (folder / "behaviors" / "sayings" / f"{name}.yaml").write_text(text, "utf-8")
    return folder
