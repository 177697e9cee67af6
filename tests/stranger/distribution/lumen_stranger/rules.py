"""Names of exhibitions begin with a capital letter."""

from lumen.language.diagnostics import WARNING, Code, Diagnostic
from lumen.lint.fixes import Edit, FileText, Fix
from lumen.project.draft import ProjectDraft

SMALL_NAME = Code("small-name", "names", WARNING, "the name of an exhibition begins with a small letter")


def check(draft: ProjectDraft) -> None:
    """Report the name in lumen.yaml if it begins with a small letter."""
    if draft.main and draft.settings and draft.settings.name[:1].islower():
        name = draft.settings.name
        draft.main(SMALL_NAME, ("name",), f"the name `{name}` begins with a small letter", f"write `{name.title()}`")


def enlarged(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Propose the name with capital letters."""
    text = source.at(diagnostic.place).title()
    return [Fix(f"write {text}", (Edit(diagnostic.place, text),))]
