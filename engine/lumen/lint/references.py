"""Names in one file that another file must have: behaviours, stories, motions, controllers, postures, routes."""

from lumen.language.actions import PublishBody
from lumen.language.built_in_routes import BUILT_IN_ROUTES
from lumen.language.commands import VerbCommand
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, Related, did_you_mean, nearest
from lumen.language.routes import Direction
from lumen.language.routing_keys import SHARED_ROUTES
from lumen.language.verbs import verb_of
from lumen.lint.lookups import References, first
from lumen.lint.walk import ActionSite, action_sites
from lumen.project.building import MISSING_FILE
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.packaged_models import in_package
from lumen.project.poses import UNKNOWN_POSTURE
from lumen.project.settings import said_at

UNKNOWN_ROUTE = Code("unknown-route", "references", ERROR, "a name refers to a route that is not in lumen.yaml")
WRONG_DIRECTION = Code("wrong-direction", "routes", WARNING, "a route is used in the wrong direction")


def check(draft: ProjectDraft) -> None:
    """Report unknown names in lumen.yaml and in the behaviours' actions, and publishing on incoming routes."""
    references = References(draft)
    _main(draft, references)
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for site in action_sites(machine):
            _action(draft, report, references, site)


def known_route(draft: ProjectDraft, report: DocumentReport, path: NodePath, route: str, *, key: bool = False) -> bool:
    """Return whether lumen.yaml has that route; if not, report the name, unless an unreadable part could have it."""
    if draft.settings is None or draft.main is None:
        return False
    if route in draft.settings.routes:
        return True
    by_use = route in BUILT_IN_ROUTES and route not in draft.settings.removed_routes
    if route not in draft.main.lost and (draft.whole_behaviors or not by_use):
        own = [name for name, row in draft.settings.routes.items() if not row.built_in]
        hint, cause = did_you_mean(route, own, "lumen.yaml has"), f"name {route}"
        if route in draft.settings.removed_routes:
            hint = f"delete the row `{route}: null` in lumen.yaml, which removes the route"
        elif route in BUILT_IN_ROUTES:
            hint = f"add a row `{route}:` to `routes`; without it, the route exists only if a behaviour uses it"
        elif "mean" not in hint and (near := nearest(route, SHARED_ROUTES)):
            hint = f"did you mean `{near}`, which comes with Lumen?"
        elif not own:
            hint, cause = "add it under `routes` in lumen.yaml", "no routes"
        report(UNKNOWN_ROUTE, path, f"there is no route `{route}`", hint, key=key, cause=cause)
    return False


def _main(draft: ProjectDraft, references: References) -> None:
    settings, report = draft.settings, draft.main
    if settings is None or report is None:
        return
    if settings.behavior:
        references.look_up(report, said_at(settings, report, "behavior"), "behavior", settings.behavior)
    if settings.story:
        references.look_up(report, said_at(settings, report, "story"), "story", settings.story)
    model, body = settings.model, draft.body
    if model and references.look_up(report, said_at(settings, report, "model"), "model", model) and body and body.mjcf:
        _model_file(draft, draft.report("models", model), ("mjcf",), body.mjcf)
    if settings.hall and "models" not in draft.missing:
        _model_file(draft, report, ("hall",), settings.hall)


def _published(draft: ProjectDraft, report: DocumentReport, path: NodePath, name: str) -> None:
    assert draft.settings is not None
    assert draft.main is not None
    route = draft.settings.routes[name]
    if route.direction is Direction.IN:
        message = f"`{name}` is a route for incoming messages"
        hint = "publish on a route with `direction: out`"
        declared = Related(draft.main.document.place(route.where, key=True), "it is declared here")
        related = () if route.built_in else (declared,)
        report.diagnostics.append(WRONG_DIRECTION.at(report.document.place(path), message, hint, related))


def _model_file(draft: ProjectDraft, report: DocumentReport, path: NodePath, name: str) -> None:
    if in_package(name):
        if draft.looks.package_file(name) is None:
            package, _, inner = name.partition(":")
            hint = "write PACKAGE:PATH, with the path inside the folder of the package"
            report(MISSING_FILE, path, f"no installed package `{package}` has a file `{inner}`", hint)
        return
    files = (*draft.files, *draft.lent)
    there = [file.removeprefix("models/") for file in files if file.startswith("models/") and file.endswith(".xml")]
    if name not in there:
        report(MISSING_FILE, path, f"there is no file models/{name}", did_you_mean(name, there, "models/ has"))


def _action(draft: ProjectDraft, report: DocumentReport, references: References, site: ActionSite) -> None:
    where, action = site.step.where, site.step.action
    if isinstance(action, PublishBody):
        path = first(report, (*where, "publish", "route"), (*where, "publish"))
        if known_route(draft, report, path, action.route):
            _published(draft, report, path, action.route)
    elif isinstance(action, VerbCommand):
        _names(draft, report, references, where, action)


def _names(
    draft: ProjectDraft, report: DocumentReport, references: References, where: NodePath, command: VerbCommand
) -> None:
    """Check each name in the fields of a command, whether it is written after the verb or under its own key."""
    verb = verb_of(command)
    for field in (field for field in verb.fields if field.names != "place"):
        name = getattr(command, field.name)
        short, long = (*where, verb.name), (*where, verb.name, name if verb.pair else field.name)
        path = first(report, long, short)
        if field.names == "posture":
            _posture(draft, report, path, name)
        elif field.names in ("motion", "controller"):
            references.look_up(report, path, field.names, name, key=verb.pair and path == long)


def _posture(draft: ProjectDraft, report: DocumentReport, path: NodePath, name: str) -> None:
    if draft.body is None or name in draft.body.postures:
        return
    hint = did_you_mean(name, draft.body.postures, f"{draft.body.name} has")
    lost = draft.report("models", draft.settings.model).lost if draft.settings else set()
    if name not in lost:
        report(UNKNOWN_POSTURE, path, f"there is no posture `{name}`", hint, cause=f"posture {name}")
