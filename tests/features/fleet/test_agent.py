"""The agent of a robot: what it applies, refuses and reports, and its recovery after each fault."""

import base64
import json
import random
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from lumen.errors import UsageError
from lumen.features.fleet.bundle import messages_of, packed
from lumen.features.fleet.bundle_trial import at_home
from lumen.features.fleet.installing import BundleFolder, all_have, finish, install
from lumen.features.fleet.memory import AgentMemory, keep, remember
from lumen.features.fleet.rollouts.presence import presence_from
from lumen.features.fleet.signing import BUNDLE, ORDER, Signer, generate, verified
from lumen.project.files import FLEET_FILE, fingerprint, read_files
from lumen.project.home import Home, home_of
from tests.features.fleet.houses import House, changed, ordered, project


@pytest.fixture(scope="session")
def signer(tmp_path_factory: pytest.TempPathFactory) -> Signer:
    file = tmp_path_factory.mktemp("keys") / "centre.key"
    generate(file)
    return Signer(file)


@pytest.fixture(scope="session")
def stranger(tmp_path_factory: pytest.TempPathFactory) -> Signer:
    file = tmp_path_factory.mktemp("keys") / "stranger.key"
    generate(file)
    return Signer(file)


@pytest.fixture
def house(tmp_path: Path, signer: Signer) -> House:
    return House(tmp_path, signer)


def test_a_bundle_is_fetched_checked_taken_proved_and_installed(house: House) -> None:
    files = changed(house.root)
    hash = fingerprint(files)
    house.agent.order(ordered(house.signer, hash))
    house.agent.tick()
    assert (house.agent.state, house.agent.wants) == ("fetching", hash)
    house.agent.bundle(only(files, house.signer))
    house.agent.tick()
    assert house.agent.state == "checking"
    house.taker.offered[-1][1]({"verdict": "waiting", "reason": "a visit is under way"})
    assert house.agent.state == "waiting"
    house.taker.take(house.agent)
    said = house.agent.presence(10.0, {"falls": 0})
    assert (said.bundle, said.state, said.version, said.played, said.same) == (hash, "proved", 1, 9, 7)
    assert {*house.taker.installed} == {house.taker.running}
    assert FLEET_FILE not in house.taker.offered[-1][0]


def test_a_bundle_is_tried_and_not_taken(house: House) -> None:
    """A dry run fetches the bundle, fits it to the house, and reports the verdict; the robot runs the same files as
    before.
    """
    files, before = changed(house.root), house.taker.running
    hash = fingerprint(files)
    house.agent.order(ordered(house.signer, "", trying=hash))
    house.agent.tick()
    assert house.agent.presence(1.0, {}).wants == hash
    house.agent.bundle(only(files, house.signer))
    house.agent.tick()
    ((tried, answer),) = house.taker.tried
    assert tried["behaviors/hello.yaml"] == files["behaviors/hello.yaml"]
    assert FLEET_FILE not in tried
    answer({"verdict": "dry run", "visits": {"visits": 9, "same": 7, "differing": 2}})
    house.agent.tick()
    said = house.agent.presence(1.0, {})
    assert said.tried == {"bundle": hash, "verdict": "differ", "played": 9, "same": 7, "why": ""}
    assert presence_from(said.robot, json.loads(json.dumps(said.to_json()))) == said
    assert (said.bundle, said.state, said.wants, house.taker.offered) == (before, "proved", "", [])
    house.agent.order(ordered(house.signer, "", version=2))
    house.agent.tick()
    assert house.agent.presence(1.0, {}).tried == {}
    answer({"verdict": "dry run"})  # too late: the order no longer requests a dry run
    assert house.agent.presence(1.0, {}).tried == {}


def test_what_would_be_refused_is_told_by_place_and_code(house: House) -> None:
    files = changed(house.root)
    house.agent.order(ordered(house.signer, "", trying=fingerprint(files)))
    house.agent.tick()
    house.agent.bundle(only(files, house.signer))
    house.agent.tick()
    wrong = {"severity": "error", "file": "behaviors/hello.yaml", "line": 7, "code": "unknown-state", "message": "Budi"}
    house.taker.tried[0][1]({"verdict": "refused", "diagnostics": [wrong]})
    said = house.agent.presence(1.0, {}).tried
    assert (said["verdict"], said["why"]) == ("refused", "behaviors/hello.yaml:7: unknown-state")


def test_what_is_the_houses_own_in_lumen_yaml_stays(house: House) -> None:
    files = changed(house.root)
    files["lumen.yaml"] = files["lumen.yaml"].replace(b"name: nao1", b"name: other") + b"timezone: Asia/Tokyo\n"
    house.send(files)
    taken = house.taker.offered[-1][0]["lumen.yaml"]
    assert b"name: nao1" in taken
    assert b"Tokyo" not in taken
    house.taker.take(house.agent)
    assert house.agent.running == fingerprint(files)


def test_keys_of_the_house_are_put_in_place_of_the_bundles() -> None:
    shared = b"# a museum\nname: Museum\nrobot: {name: a}\nroutes:\n  face: {key: x}\nbus: memory://\n"
    own = b"name: old\nrobots:\n  nao1: {model: nao}\nhouse: itb"
    expected = b"# a museum\nname: Museum\nroutes:\n  face: {key: x}\nrobots:\n  nao1: {model: nao}\nhouse: itb\n"
    assert at_home(shared, own) == expected
    with pytest.raises(UsageError, match="a key is expected at the left edge"):
        at_home(b"{name: x}", own)


def only(files: Mapping[str, bytes], signer: Signer) -> dict[str, Any]:
    """Return the only message of a small bundle."""
    (body,) = messages_of(files, signer)
    return body


def damage(body: dict[str, Any], how: str, stranger: Signer) -> dict[str, Any]:
    data = base64.b64decode(body["zip"])
    match how:
        case "half":
            return {**body, "zip": base64.b64encode(data[: len(data) // 2]).decode()}
        case "bits":
            content = 30 + int.from_bytes(data[26:28], "little")  # after the header and the name of the first file
            return {**body, "zip": base64.b64encode(data[:content] + b"\xff" + data[content + 1 :]).decode()}
        case "nobody":
            return {**body, "signature": stranger.sign(BUNDLE, body["hash"].encode())}
        case "order's":
            return {**body, "signature": stranger.sign(ORDER, body["hash"].encode())}
        case "other files":
            return {**body, "zip": base64.b64encode(packed({"lumen.yaml": b"name: x\n"})).decode()}
        case "outside":
            return {**body, "zip": base64.b64encode(packed({"behaviors/../../x.yaml": b"x"})).decode()}
        case _:
            return {**body, "zip": "%%%"}


@pytest.mark.parametrize("how", ["half", "bits", "nobody", "order's", "other files", "outside", "no base64"])
def test_a_bundle_that_is_not_the_one_signed_is_refused_and_told(house: House, stranger: Signer, how: str) -> None:
    files = changed(house.root)
    house.agent.order(ordered(house.signer, fingerprint(files)))
    house.agent.tick()
    house.agent.bundle(damage(only(files, house.signer), how, stranger))
    house.agent.tick()
    assert house.agent.state == "fetching"
    assert house.told
    assert house.agent.presence(1.0, {}).trouble
    assert house.taker.offered == []
    house.agent.bundle(only(files, house.signer))
    house.agent.tick()
    assert house.agent.state == "checking"


def test_orders_of_strangers_other_houses_other_centres_and_older_ones_are_refused(
    house: House, stranger: Signer
) -> None:
    other = "b" * 64
    house.agent.order(ordered(house.signer, "", 5))
    assert house.told == []
    for body, said in [
        (ordered(stranger, other, 9), "not signed"),
        (ordered(house.signer, other, 9, house="museum"), "not for this house"),
        (ordered(house.signer, other, 9, centre="two"), "two centres"),
        (ordered(house.signer, other, 5), "differs from the one that arrived first"),
        (ordered(house.signer, other, 9, term=0), "is over"),
        ({"order": 3}, "an order is not valid"),
        ("x", "an order is not valid"),
    ]:
        house.agent.order(body)
        house.agent.tick()
        assert house.agent.memory.followed.wanted == ""
        assert said in " | ".join(house.told)
    house.agent.order(ordered(house.signer, other, 4))
    assert house.agent.memory.followed.wanted == ""
    house.agent.order(ordered(house.signer, other, 1, centre="two", term=2))
    assert house.agent.memory.followed.wanted == other


def test_what_lint_finds_is_told_by_its_place_and_not_taken_again_until_another_order(house: House) -> None:
    files = changed(house.root)
    house.send(files)
    found = [{"file": "behaviors/hello.yaml", "line": 7, "code": "unknown-state", "severity": "error"}]
    house.taker.offered[-1][1]({"verdict": "refused", "diagnostics": found, "lines": ["Budi said hello"]})
    house.agent.tick()
    said = house.agent.presence(1.0, {})
    assert (said.state, said.trouble) == ("refused", "behaviors/hello.yaml:7: unknown-state")
    assert len(house.taker.offered) == 1
    assert house.incidents == [("refused", "behaviors/hello.yaml:7: unknown-state")]
    house.agent.order(ordered(house.signer, fingerprint(files), 2))
    house.agent.tick()
    assert len(house.taker.offered) == 2


def test_one_that_fails_in_its_probation_is_told_and_counts_as_rolled_back(house: House) -> None:
    before = house.taker.running
    house.send(changed(house.root))
    files, answer = house.taker.offered[-1]
    house.taker.running, house.taker.on_probation = fingerprint(files), True
    answer({"verdict": "applied", "before": before})
    house.taker.running, house.taker.on_probation = before, False
    house.agent.tick()
    assert house.agent.presence(1.0, {}).state == "rolled back"
    assert house.taker.installed == []


def test_aborted_it_goes_back_to_the_very_files_that_ran_before(house: House) -> None:
    before = house.taker.running
    hash = house.send(changed(house.root))
    house.taker.take(house.agent)
    house.agent.order(ordered(house.signer, f"!{hash}", 2))
    house.agent.tick()
    assert fingerprint(house.taker.offered[-1][0]) == before
    house.taker.take(house.agent)
    assert house.agent.presence(1.0, {}).bundle == before
    house.agent.order(ordered(house.signer, f"!{'c' * 64}", 3))
    house.agent.tick()
    assert house.agent.state == "proved"


def test_an_abort_that_comes_during_the_probation_is_heeded_after_it(house: House) -> None:
    before = house.taker.running
    hash = house.send(changed(house.root))
    files, answer = house.taker.offered[-1]
    house.taker.running, house.taker.on_probation = fingerprint(files), True
    answer({"verdict": "applied", "before": before})
    house.agent.order(ordered(house.signer, f"!{hash}", 2))
    house.agent.tick()
    assert house.agent.state == "probation"
    house.taker.on_probation = False
    house.agent.tick()
    assert fingerprint(house.taker.offered[-1][0]) == before
    house.taker.take(house.agent)
    assert house.agent.presence(1.0, {}).bundle == before


def test_a_bundle_under_which_the_process_ends_twice_is_given_up(house: House) -> None:
    before = house.taker.running
    house.send(changed(house.root))
    for _ in range(2):
        house.taker.offered[-1][1]({"verdict": "applied", "before": before})
        house.taker.running, house.taker.on_probation = before, False
        house.begin()
        house.agent.tick()
    assert house.agent.state == "rolled back"
    assert "ended 2 times" in house.agent.trouble


def test_files_that_somebody_changes_in_the_house_are_left_and_told(house: House) -> None:
    house.send(changed(house.root))
    house.taker.take(house.agent)
    house.taker.running = "d" * 64
    house.agent.tick()
    assert house.agent.presence(1.0, {}).state == "edited"
    assert len(house.taker.offered) == 1


def test_files_that_are_changed_after_an_order_for_those_that_run_are_left_and_told(house: House) -> None:
    house.agent.order(ordered(house.signer, house.taker.running))
    house.agent.tick()
    assert house.agent.presence(1.0, {}).state == "proved"
    house.taker.running = "d" * 64
    house.agent.tick()
    assert (house.agent.state, house.agent.wants) == ("edited", "")


def test_after_three_weeks_the_last_order_counts(house: House) -> None:
    first, last = changed(house.root), changed(house.root, new="Good day! I am Nao.")
    house.agent.order(ordered(house.signer, fingerprint(last), 40))
    house.agent.order(ordered(house.signer, fingerprint(first), 7))
    house.agent.tick()
    house.agent.bundle(only(first, house.signer))
    assert house.agent.wants == fingerprint(last)
    house.agent.bundle(only(last, house.signer))
    house.agent.tick()
    house.taker.take(house.agent)
    assert house.agent.running == fingerprint(last)


def test_after_a_restart_on_the_files_before_it_is_taken_again(house: House) -> None:
    before = house.taker.running
    house.send(changed(house.root))
    house.taker.take(house.agent)
    house.taker.running = before
    house.begin()
    house.agent.tick()
    assert house.agent.state == "checking"


def test_what_a_run_has_chosen_besides_stays_chosen(house: House) -> None:
    files = house.taker.known[house.taker.running]
    files["models/.chosen"] = b"greeter"
    house.send(changed(house.root))
    offered, _ = house.taker.offered[-1]
    assert offered["models/.chosen"] == b"greeter"


def test_files_of_several_robots_are_written_when_all_have_them(tmp_path: Path, signer: Signer) -> None:
    root = project(tmp_path / "house", signer.public)
    files = changed(root)
    homes = {name: Home(home_of(root) / name) for name in ("nao1", "nao2")}
    memories = {name: AgentMemory(counted="x") for name in homes}
    for name, home in homes.items():
        home.hold()
        keep(home, name, memories[name])
    BundleFolder(home_of(root) / "fleet").keep(files)
    memories["nao1"].counted = memories["nao1"].writing = fingerprint(files)
    keep(homes["nao1"], "nao1", memories["nao1"])
    assert not all_have(root, fingerprint(files), homes)
    finish(root)
    assert read_files(root)["behaviors/hello.yaml"] != files["behaviors/hello.yaml"]
    memories["nao2"].counted = fingerprint(files)
    keep(homes["nao2"], "nao2", memories["nao2"])
    assert all_have(root, fingerprint(files), homes)
    (root / "motions" / "old.yaml").write_text("x: 1\n")
    finish(root)
    assert fingerprint(read_files(root)) == fingerprint(files)
    assert (root / FLEET_FILE).exists()
    assert remember(homes["nao1"], "nao1").writing == ""
    for home in homes.values():
        home.release()


def test_files_that_the_disk_refuses_change_nothing_and_are_tried_again(tmp_path: Path, signer: Signer) -> None:
    root = project(tmp_path / "house", signer.public)
    files = changed(root) | {"motions/a_new_one.yaml": b"duration: 1\n"}
    home, memory = Home(home_of(root)), AgentMemory(writing=fingerprint(files))
    home.hold()
    keep(home, "nao1", memory)
    BundleFolder(home_of(root) / "fleet").keep(files)
    before, obstacle = read_files(root), root / "behaviors/.hello.yaml.restored"
    obstacle.mkdir()
    assert install(root, files) == "hello.yaml can't be written: is a directory"
    finish(root)
    assert read_files(root) == before
    assert not list(root.rglob(".a_new_one*"))
    assert remember(home, "nao1").writing == fingerprint(files)
    obstacle.rmdir()
    finish(root)
    assert read_files(root) == files
    assert remember(home, "nao1").writing == ""
    home.release()


def test_a_folder_that_cannot_be_written_is_told_once_until_it_has_the_files(house: House) -> None:
    house.send(changed(house.root))
    house.taker.take(house.agent)
    house.taker.unwritten = "hello.yaml can't be written: no space left on device"
    said = [house.agent.presence(10.0, {}).trouble for _ in range(3)]
    assert said == 3 * [house.taker.unwritten]
    assert sum("no space left" in line for line in house.told) == 1
    assert house.incidents == [("folder", house.taker.unwritten)]
    house.taker.unwritten = ""
    assert house.agent.presence(10.0, {}).trouble == ""


def test_a_folder_of_bundles_that_cannot_be_written_is_told(house: House) -> None:
    house.send(changed(house.root))
    house.agent._folder._path(fingerprint(house.taker.offered[-1][0])).mkdir()
    house.taker.take(house.agent)
    assert house.agent.presence(10.0, {}).trouble == "fleet can't be written: is a directory"


def test_counts_begin_anew_with_other_files_and_those_before_are_kept(house: House) -> None:
    house.agent.presence(3600.0, {"falls": 2})
    house.send(changed(house.root))
    house.taker.take(house.agent)
    said = house.agent.presence(1800.0, {"falls": 1})
    assert said.now == {"hours": 0.5, "falls": 1}
    assert said.before == {"hours": 1.0, "falls": 2}


def test_a_key_is_written_for_its_owner_alone_and_never_over(tmp_path: Path) -> None:
    file = tmp_path / "centre.key"
    public = generate(file)
    assert file.stat().st_mode & 0o077 == 0
    assert verified(public, ORDER, b"x", Signer(file).sign(ORDER, b"x"))
    assert not verified(public, BUNDLE, b"x", Signer(file).sign(ORDER, b"x"))
    assert not verified("no key", ORDER, b"x", "no signature")
    with pytest.raises(UsageError, match="already exists"):
        generate(file)
    file.write_text("nothing")
    with pytest.raises(UsageError, match="contains no private key"):
        Signer(file)


def test_the_same_files_make_the_same_zip(house: House) -> None:
    files = read_files(house.root)
    assert packed(files) == packed(dict(reversed(files.items())))


def test_a_kept_bundle_that_was_torn_is_written_again(house: House, tmp_path: Path) -> None:
    files, kept = read_files(house.root), BundleFolder(tmp_path / "bundles")
    kept.keep(files)
    (tmp_path / "bundles" / f"{fingerprint(files)}.zip").write_bytes(b"PK")
    assert kept.keep(files) == ""
    assert fingerprint(kept.files(fingerprint(files)) or {}) == fingerprint(files)


def test_only_its_owner_can_read_a_kept_bundle(house: House, tmp_path: Path) -> None:
    BundleFolder(tmp_path / "bundles").keep(read_files(house.root))
    (file,) = (tmp_path / "bundles").glob("*.zip")
    assert file.stat().st_mode & 0o777 == 0o600


def test_a_large_bundle_comes_in_parts_in_whatever_order_and_more_than_once(house: House) -> None:
    noise = random.Random(1).randbytes(900_000).hex().encode()
    files = {**changed(house.root), "models/large.xml": b"<x>" + noise + b"</x>"}
    bodies = messages_of(files, house.signer)
    assert len(bodies) > 1
    house.agent.order(ordered(house.signer, fingerprint(files)))
    house.agent.tick()
    for body in [bodies[-1], bodies[0], bodies[-1], *bodies[1:]]:
        house.agent.bundle(body)
    assert house.agent.wants == ""
    house.agent.tick()
    assert house.agent.state == "checking"
