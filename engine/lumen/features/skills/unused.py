"""Reports skills that neither a behaviour nor a motion uses."""

from lumen.language.commands import Do
from lumen.language.diagnostics import INFO, Code, Place, has_errors
from lumen.language.motions import skill_of
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft

UNUSED_SKILL = Code("unused-skill", "skills", INFO, "no behaviour uses a skill")


def check(draft: ProjectDraft) -> None:
    """Report each skill that neither a behaviour nor a motion uses, but only in projects without errors."""
    if not draft.verbs.rows or not draft.whole_behaviors or has_errors(draft.diagnostics):
        return
    actions = (site.step.action for machine in draft.behaviors.values() for site in action_sites(machine))
    used = {action.skill for action in actions if isinstance(action, Do)}
    cues = (skill_of(cue.kind, cue.value) for motion in draft.motions.values() for cue in motion.cues)
    used |= {begun.skill for begun in cues if begun}
    for name in draft.verbs.rows:
        if name not in used:
            message = f"no behaviour uses the skill `{name}`"
            hint = f"write `{name}:` in a `do`, or delete this file and its program"
            draft.loose.append(UNUSED_SKILL.at(Place(f"skills/{name}.yaml"), message, hint))
