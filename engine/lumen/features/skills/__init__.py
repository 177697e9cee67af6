"""Skills: a project's own verbs, each with a manifest `skills/NAME.yaml` and a program that performs it."""

from lumen.feature import Feature, PartRow, Phase

FEATURE = Feature(
    name="skills",
    new_files={"skill": "lumen.features.skills.new_skill:write_skill"},
    parts=(
        PartRow("skills", Phase.WORLD, "lumen.features.skills.part:skills", "whole", after="robot"),
        PartRow("hosted skills", Phase.WORLD, "lumen.features.skills.part:skills", "role:robot", after="hosted robot"),
    ),
    verb_files={"skills": "lumen.features.skills.manifest:build_skill"},
    codes=("lumen.features.skills.manifest",),
    rules=("lumen.features.skills.rules:check",),
    last_rules=("lumen.features.skills.unused:check",),
    pages=("lumen.features.skills.pages",),
)
