"""A rule: an action sprays from a nozzle that lumen.yaml lists."""

from lumen.language.commands import Do
from lumen.language.diagnostics import ERROR, Code
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft
from lumen_sprayer.settings import Sprayer

NO_NOZZLE = Code("no-nozzle", "robot", ERROR, "an action sprays from a nozzle that lumen.yaml does not list")


def check(draft: ProjectDraft) -> None:
    """Report each `spray` with such a nozzle; a nozzle that an expression computes is not checked."""
    if draft.settings is None:
        return
    nozzles = draft.settings.section(Sprayer).nozzles
    for name, machine in draft.behaviors.items():
        for site in action_sites(machine):
            match site.step.action:
                case Do("spray", {"nozzle": nozzle}) if "{{" not in nozzle and nozzle not in nozzles:
                    hint = f"choose one of {', '.join(nozzles)}" if nozzles else "add `sprayer` to lumen.yaml"
                    path = (*site.step.where, "spray", "nozzle")
                    draft.report("behaviors", name)(NO_NOZZLE, path, f"there is no nozzle `{nozzle}`", hint)
