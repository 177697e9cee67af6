"""Make a `Project` of a draft without errors."""

from pathlib import PurePosixPath

from lumen.language.projects import Project
from lumen.project.draft import ProjectDraft
from lumen.project.files import fingerprint


def assemble(found: ProjectDraft, root: str) -> Project:
    """Return the project that a draft without errors describes."""
    settings, body = found.settings, found.body
    assert settings is not None
    assert body is not None
    return Project(
        root=root,
        name=settings.name or PurePosixPath(root.replace("\\", "/")).name,
        robot=settings.robot,
        robots=settings.robots,
        told_apart=settings.told_apart,
        house=settings.house,
        body=body,
        hall=settings.hall,
        behavior=settings.behavior,
        behaviors=found.behaviors,
        knowledge=found.knowledge,
        questions=found.questions,
        controllers=found.controllers,
        motions=found.motions,
        life=found.life,
        gestures=found.gestures,
        routes=settings.routes,
        stories=found.stories,
        sayings=found.sayings,
        functions=found.functions,
        messages=found.messages,
        languages=settings.languages,
        timezone=settings.timezone,
        story=settings.story,
        stage=settings.stage,
        bus=settings.bus,
        patience=settings.patience,
        modules=settings.modules,
        aliases=settings.aliases,
        sections=settings.sections,
        verbs={name: row._replace(root=root, robot=settings.robot) for name, row in found.verbs.rows.items()},
        hash=fingerprint(found.files),
        documents={file: report.document for file, report in found.reports.items()},
    )
