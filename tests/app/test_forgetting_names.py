"""Names to be forgotten that flood in keep nobody busy: one at a time, each once, and none that waits is lost."""

from lumen.app.parts.forgetting import FORGETTING_SPACING, MAX_PENDING_NAMES, ForgettingPart
from lumen.bus import connect
from lumen.language.people import PersonName
from tests.exhibits import project

KEY = "lumen.NAO.persistence.forgotten"


def test_names_are_forgotten_one_at_a_time_and_each_once() -> None:
    bus, forgotten = connect("memory://"), list[str]()

    def forget(person: PersonName) -> None:
        forgotten.append(person.key)

    part = ForgettingPart(project(), bus, forget)
    for name in ("Ani", "ani", "Ani", "Ünal", *(f"Nobody {n}" for n in range(300))):
        bus.publish(KEY, {"name": name})
        part.tick(0.0, ())
    assert len(forgotten) == 1
    part.tick(FORGETTING_SPACING, ())
    assert len(forgotten) == 2
    part.close()
    assert forgotten[:2] == ["ani", "ani"]
    assert "ünal" in forgotten
    assert len(forgotten) == MAX_PENDING_NAMES + 1
    bus.close()
