"""Word lists that are needed to understand sentences, in each language of a project that hears."""

from lumen.language.diagnostics import WARNING, Code
from lumen.lint.naming import heard_rows
from lumen.project.draft import ProjectDraft
from lumen.project.settings import said_at
from lumen.talk.speech import FILLERS, NEGATIONS, NEGATIONS_AFTER, QUESTIONS, SMALL_WORDS

MISSING_WORDS = Code(
    "missing-words",
    "hearing",
    WARNING,
    "a language of the project lacks word lists that Lumen needs to understand sentences",
)

_NEEDED = {
    FILLERS: (FILLERS,),
    SMALL_WORDS: (SMALL_WORDS,),
    NEGATIONS: (NEGATIONS, NEGATIONS_AFTER),
    QUESTIONS: (QUESTIONS,),
}
"""The lists that each language needs; of several lists in a row, one is enough."""


def check(draft: ProjectDraft) -> None:
    """Report, as one finding, the lists that have no words in each language, if a behaviour hears."""
    machines = [machine for machine in draft.behaviors.values() if any(heard_rows(machine))]
    settings, main = draft.settings, draft.main
    if not machines or settings is None or main is None or draft.words.keys() != draft.names["behaviors/words"]:
        return
    missing: dict[str, list[str]] = {}
    for language in settings.languages:
        for name, lists in _NEEDED.items():
            tables = [[machine.phrases.get(each, {}) for each in lists] for machine in machines]
            if any(not any(table.get(language) or table.get("") for table in several) for several in tables):
                missing.setdefault(language, []).append(name)
    if missing:
        language, names = next(iter(missing.items()))
        what = "; ".join(
            f"`{one}` has no word list{'s' * (len(lists) > 1)} {', '.join(f'`{name}`' for name in lists)}"
            for one, lists in missing.items()
        )
        languages = "these languages" if len(missing) > 1 else "this language"
        message = f"{what}: the robot reads {languages} word by word"
        hint = f"write `{names[0]}: {{{language}: […]}}` under `phrases` of a words file that the behaviour names"
        path = (*said_at(settings, main, "languages"), settings.languages.index(language))
        main(MISSING_WORDS, path, message, hint)
