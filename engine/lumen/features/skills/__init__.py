"""Skills: verbs of a project's own, each a manifest `skills/NAME.yaml` and a program that performs it."""

from lumen.feature import Feature

FEATURE = Feature(
    name="skills",
    verb_files={"skills": "lumen.features.skills.manifest:build_skill"},
    codes=("lumen.features.skills.manifest",),
    rules=("lumen.features.skills.rules:check",),
    last_rules=("lumen.features.skills.unused:check",),
    pages=("lumen.features.skills.pages",),
)
