"""The paths about the past and about alternatives: why, why not, days, entries, files, and a fork."""

from collections.abc import AsyncIterator, Mapping, Sequence
from datetime import date
from typing import Any

import orjson
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from lumen.errors import BusError, UsageError
from lumen.features.console.entry_clock import ToldPage
from lumen.features.console.entry_ring import EncodedEntry
from lumen.features.console.entry_words import told_of
from lumen.features.console.job_promises import MAX_SHOWN, NOTHING
from lumen.features.console.jobs import Jobs
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.people import Role
from lumen.features.console.requests import NO_STORE, DeniedError, Reception, as_json
from lumen.features.console.watch import Watch
from lumen.language.operator_requests import FORK, WHY, WHY_NOT, OperatorRequest
from lumen.run.new_passage import write_passage

MAX_REMOTE = 40_000
"""The maximum number of latest entries that are requested from an exhibition for a day."""


class JournalSource:
    """The journals of a watch's robots. All methods raise BusError if the exhibition does not answer."""

    def __init__(self, watch: Watch) -> None:
        self._watch = watch

    async def pages(self, robot: str) -> AsyncIterator[bytes]:
        """Yield a robot's last MAX_REMOTE entries as pages of JSON, without keeping them in memory."""
        view = self._watch.robots[robot]
        begin, count = max(0, (view.position or view.entries.last) - MAX_REMOTE), 0
        while count < MAX_REMOTE and (page := (await self._watch.page(robot, begin)).entries):
            count += len(page)
            begin = page[-1]["position"] + 1
            yield orjson.dumps(page)

    async def entries(self, view: KnownRobot, first: int, last: int) -> list[EncodedEntry]:
        """Return a journal's entries from `first` to `last`, ending with the page that reaches MAX_SHOWN."""
        found = list[EncodedEntry]()
        while first <= last and len(found) < MAX_SHOWN and (page := await self._watch.page(view.robot, first)).entries:
            found += [one for one in view.entries.encoded(page) if first <= one.position <= last]
            first = page.entries[-1]["position"] + 1
        return found


QUESTION_TIMEOUT = 20.0
"""The time limit for an exhibition's answer about the past [s]."""
MAX_QUESTION = 500
MAX_STORY_NAME = 200
MAX_FOUND = 200
"""The maximum number of entries that a search returns; the answer reports whether there are more."""
MAX_SEARCHED = 200_000
"""The maximum number of positions that a search covers: several busy days."""
ELSEWHERE = "this robot's files are on another machine: open the console there"
SAID = ("behavior", "state", "row", "language", "text")
"""The keys of a posted saying."""


class Past:
    """Serves the paths about the past, from exhibitions' answers or, through jobs, from the project's own journals."""

    def __init__(self, reception: Reception, jobs: Jobs) -> None:
        self._reception, self._jobs = reception, jobs
        self._watch, self._source = reception.watch, JournalSource(reception.watch)
        self.routes = [
            Route("/api/why", self._why),
            Route("/api/why-not", self._why_not),
            Route("/api/fork", self._fork, methods=["POST"]),
            Route("/api/day", self._day),
            Route("/api/day.csv", self._csv),
            Route("/api/entries", self._entries),
            Route("/api/search", self._search),
            Route("/api/files", self._files),
            Route("/api/chart", self._chart),
            Route("/api/skills", self._skills),
            Route("/api/passages", self._passage, methods=["POST"]),
            Route("/api/sayings", self._saying, methods=["POST"]),
            Route("/api/stories", self._story, methods=["POST"]),
        ]

    async def _why(self, request: Request) -> Response:
        return await self._explained(request, WHY)

    async def _why_not(self, request: Request) -> Response:
        return await self._explained(request, WHY_NOT)

    async def _explained(self, request: Request, question: OperatorRequest) -> Response:
        view = self.asked(request, Role.SHOW)
        what = request.query_params.get("what", "")[:MAX_QUESTION]
        return as_json(await self.explained(view, question, what, request.query_params.get("at") or None))

    async def explained(self, view: KnownRobot, question: OperatorRequest, what: str, at: str | None) -> dict[str, Any]:
        """Return why something happened, or did not: from the exhibition, else from the journal.

        Raises DeniedError if neither has the answer.
        """
        try:
            said = await self._request(view, question(what=what, **({"at": at} if at else {})))
        except DeniedError:  # the journal may contain the answer
            if not self.is_ours(view):
                raise
            said = {"kept": "later"}
        if said.get("kept") == "later" and self.is_ours(view):
            said = orjson.loads(await self._jobs.do("why", self.home(view), question.ask, what, at))
        if said.get("verdict") == "refused":
            raise DeniedError(404, str(said.get("reason")))
        return said

    async def _fork(self, request: Request) -> Response:
        self._reception.person(request, Role.AUTHOR)
        data = await self._reception.posted(request)
        view = self._reception.robot(data.get("robot"))
        asked: dict[str, Any] = {key: data[key] for key in ("at", "position", "event", "bundle") if key in data}
        said = await self._request(view, FORK(**asked))
        if said.get("verdict") == "refused" or "would" not in said:
            reason = said.get("reason") if said.get("verdict") == "refused" else None
            raise DeniedError(
                400, str(reason or "this exhibition is running an older version of Lumen, which cannot do that")
            )
        for key in ("was", "would"):
            said[key] = [{**one, **told_of(one)} for one in said[key]]
        return as_json(said)

    async def _day(self, request: Request) -> Response:
        return Response(await self._day_asked(request, "page"), headers=NO_STORE, media_type="application/json")

    async def _csv(self, request: Request) -> Response:
        told = orjson.loads(await self._day_asked(request, "csv"))
        name = f'attachment; filename="lumen-{told["date"]}.csv"'
        return Response(told["text"], headers={**NO_STORE, "Content-Disposition": name}, media_type="text/csv")

    async def _day_asked(self, request: Request, form: str) -> bytes:
        view, wanted = self.asked(request, Role.OPERATOR), request.query_params.get("date", "")
        try:
            wanted = wanted and date.fromisoformat(wanted).isoformat()
        except ValueError:
            raise DeniedError(400, "`date` must be a day, such as 2026-11-23") from None
        if (
            self.is_ours(view)
            and (found := await self._jobs.do("day", self.home(view), wanted, form, "here")) != NOTHING
        ):
            return found
        try:
            return await self._jobs.do(
                "day", self.home(view), wanted, form, "told", told=self._source.pages(view.robot)
            )
        except BusError as error:
            raise DeniedError(503, f"the exhibition did not send this day: {error}") from None

    async def _entries(self, request: Request) -> Response:
        return _as_entries(await self.between(self.asked(request, Role.OPERATOR), *_positions(request)))

    async def _search(self, request: Request) -> Response:
        """Return up to MAX_FOUND entries between two positions whose line contains a text, in any case and language."""
        view, (first, last) = self.asked(request, Role.OPERATOR), _positions(request)
        text = " ".join(request.query_params.get("text", "").split()).casefold()
        if not 0 < len(text) <= MAX_QUESTION:
            raise DeniedError(400, f"`text` must be a string of 1 to {MAX_QUESTION} characters")
        found, begin = list[EncodedEntry](), first
        while begin <= min(last, first + MAX_SEARCHED) and len(found) <= MAX_FOUND:
            page = await self.between(view, begin, last)
            found += [entry for entry in page if _has(orjson.loads(entry.data), text)]
            if len(page) < MAX_SHOWN:
                break
            begin = page[-1].position + 1
        return _as_entries(found[:MAX_FOUND], more=len(found) > MAX_FOUND or begin > first + MAX_SEARCHED)

    async def between(self, view: KnownRobot, first: int, last: int) -> list[EncodedEntry]:
        """Return the first entries between two positions, at least `MAX_SHOWN` or all.

        Raises DeniedError if neither the exhibition nor this machine's journal can be read.
        """
        try:
            return await self._source.entries(view, first, last)
        except BusError as error:
            if not self.is_ours(view):
                raise DeniedError(503, f"the exhibition did not send its entries: {error}") from None
            said = orjson.loads(await self._jobs.do("entries", self.home(view), first, last))
            return view.entries.encoded(ToldPage(**said))

    async def _files(self, request: Request) -> Response:
        view = self.asked(request, Role.OPERATOR)
        said: dict[str, Any] = dict(view.files)
        last = said.get("last")
        changed = bool(said.get("staged")) or bool(said.get("waiting"))
        changed = changed or (isinstance(last, dict) and last.get("verdict") in ("refused", "dry run"))
        if self.is_ours(view) and changed:
            said["replay"] = orjson.loads(await self._jobs.do("replay", self.home(view)))
        return as_json(said)

    async def _chart(self, request: Request) -> Response:
        """Return the running behaviour's chart, found by the hash of its files."""
        return await self._of_running(request, "chart")

    async def _skills(self, request: Request) -> Response:
        """Return the skills of the running files, read from their manifests."""
        return await self._of_running(request, "skills")

    async def _of_running(self, request: Request, job: str) -> Response:
        """Return the answer of a job about the running files."""
        view = self.own(self.asked(request, Role.SHOW))
        found = await self._jobs.do(job, self.home(view), str(view.said.get("bundle") or ""))
        return Response(found, headers=NO_STORE, media_type="application/json")

    async def _passage(self, request: Request) -> Response:
        """Save an unanswered question with its answer as a passage, which is then checked like any saved file."""
        _, data = await self.posted(request)
        question, answer, language = (str(data.get(key, "")) for key in ("question", "answer", "language"))
        try:
            file = write_passage(self._jobs.root, question, answer, language, _others(data.get("also")))
        except UsageError as error:
            raise DeniedError(400, str(error)) from None
        return as_json({"file": file.as_posix()})

    async def _saying(self, request: Request) -> Response:
        """Save a visitor's sentence as a saying, with the row of `hears` that should have matched it."""
        view, data = await self.posted(request)
        return await self.written("saying", view, *(str(data.get(key, "")) for key in SAID))

    async def _story(self, request: Request) -> Response:
        """Save a recorded visit as a story, which `lumen test` plays."""
        view, data = await self.posted(request)
        position, visitor, name = (data.get(key) for key in ("position", "visitor", "name"))
        if not isinstance(position, int) or isinstance(position, bool):
            raise DeniedError(400, "`position` must be the position of an entry of the visit: a whole number")
        texts = [str(text or "")[:MAX_STORY_NAME] for text in (visitor, name)]
        return await self.written("story", view, position, *texts)

    async def written(self, job: str, view: KnownRobot, *arguments: Any) -> Response:
        """Return the answer of a job that writes a file.

        Raises DeniedError, with the status 400 if the job refuses the request.
        """
        try:
            saved = await self._jobs.do(job, self.home(view), *arguments)
        except DeniedError as error:
            raise DeniedError(400 if error.status == 404 else error.status, error.reason) from None
        return Response(saved, headers=NO_STORE, media_type="application/json")

    def asked(self, request: Request, needs: Role) -> KnownRobot:
        self._reception.person(request, needs)
        return self._reception.robot(request.query_params.get("robot"))

    async def posted(self, request: Request) -> tuple[KnownRobot, dict[str, Any]]:
        """Return the robot and the data of what an author posted about one of the project's own robots.

        Raises DeniedError if the person is no author, or for any other robot or data.
        """
        self._reception.person(request, Role.AUTHOR)
        data = await self._reception.posted(request)
        return self.own(self._reception.robot(data.get("robot"))), data

    def own(self, view: KnownRobot) -> KnownRobot:
        """Return a robot of the console's own project. Raises DeniedError for any other robot."""
        if not self.is_ours(view):
            raise DeniedError(400, ELSEWHERE)
        return view

    def is_ours(self, view: KnownRobot) -> bool:
        """Return True for a robot of the console's own project."""
        return self._watch.keys.is_ours(view.robot)

    def home(self, view: KnownRobot) -> str:
        """Return the name by which jobs find the robot's files.

        It is empty if the project has a single robot, or if the robot belongs to another project.
        """
        return self._watch.keys.home(view.robot) if self.is_ours(view) else ""

    async def _request(self, view: KnownRobot, body: dict[str, Any]) -> dict[str, Any]:
        key = self._watch.keys.of(view.robot).operator
        try:
            said = await self._watch.exchanges.request(key, body, QUESTION_TIMEOUT)
        except BusError as error:
            raise DeniedError(503, f"the exhibition does not answer: {error}") from None
        if not isinstance(said, dict):
            raise DeniedError(503, "the exhibition sent an answer that cannot be shown")
        return said


def _positions(request: Request) -> tuple[int, int]:
    """Return the positions of the first and last requested entries.

    Raises DeniedError if one is not a whole number.
    """
    first, last = (request.query_params.get(name, "") for name in ("from", "to"))
    if not (first.isdigit() and last.isdigit() and len(first + last) < 36):
        raise DeniedError(400, "`from` and `to` must be positions of entries: whole numbers")
    return int(first), int(last)


def _has(entry: Mapping[str, Any], text: str) -> bool:
    """Return True if an entry's line, in English or another language, contains the case-folded `text`."""
    lines = (entry.get("text", ""), *(entry.get("texts") or {}).values())
    return any(text in str(line).casefold() for line in lines)


def _as_entries(found: Sequence[EncodedEntry], *, more: bool = False) -> Response:
    head = b'{"more":' + orjson.dumps(more) + b',"entries":['
    data = head + b",".join(entry.data for entry in found) + b"]}"
    return Response(data, headers=NO_STORE, media_type="application/json")


def _others(said: Any) -> dict[str, tuple[str, str]]:
    """Return pairs of question and answer by language code, empty for null. Raises UsageError for other data."""
    if not isinstance(said, dict | None):
        raise UsageError("`also` must be an object with a `question` and an `answer` for each language")
    found = {}
    for language, texts in (said or {}).items():
        one = texts if isinstance(texts, dict) else {}
        found[str(language)] = str(one.get("question", "")), str(one.get("answer", ""))
    return found
