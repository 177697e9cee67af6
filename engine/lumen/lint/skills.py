"""Actions for which the robot's body lacks roles: they are left out at run time."""

from dataclasses import replace

from lumen.language.diagnostics import NodePath
from lumen.language.motions import skill_of
from lumen.language.skills import lack_of, tracked, tracking_lack
from lumen.language.verbs import verb_of
from lumen.lint.lookups import first
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import MOTIONS
from lumen.project.roles import LEFT_OUT


def check(draft: ProjectDraft) -> None:
    """Report each action and each skill of a motion that this body leaves out, at its verb."""
    body = draft.body
    if body is None:
        return
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for site in action_sites(machine):
            action = site.step.action
            controller = draft.controllers.get(tracked(action))
            if lack := tracking_lack(controller, body) if controller else lack_of(action, body):
                verb = verb_of(action).name  # type: ignore[arg-type]
                path: NodePath = first(report, (*site.step.where, verb), site.step.where)
                report(LEFT_OUT, path, f"{lack.message}, so it leaves out `{verb}`", lack.hint, key=True)
    for name, motion in draft.motions.items():
        for cue in motion.cues:
            begun = skill_of(cue.kind, cue.value)
            own = begun and cue.where[-1:] == (begun.skill,)  # not a skill of another motion that this motion plays
            row = draft.verbs.rows.get(begun.skill) if begun else None
            if begun and own and (lack := lack_of(replace(begun, row=row), body)):
                message = f"{lack.message}, so it leaves out `{begun.skill}`"
                draft.report(MOTIONS, name)(LEFT_OUT, cue.where, message, lack.hint, key=True)
