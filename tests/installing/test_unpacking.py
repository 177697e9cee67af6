"""Debian packages without root are unpacked, or listed as missing; a broker may be given by its address."""

import os
import shutil
from pathlib import Path

import pytest

from tests import ROOT, provided, rabbitmq
from tests.guarded import run_guarded
from tests.waiting import HANG

SCRIPT = ROOT / "scripts/packages.sh"
USUAL = "sh cat awk rm mkdir dirname tee id sed grep touch tail env sleep"
STATUS = """Package: openssl
Status: install ok installed
Version: 3

Package: rabbitmq-server
Status: deinstall ok config-files
"""
APT = """#!/bin/sh
echo "$@" >> "$UNPACKED.asked"
case "$*" in
*nosuch*) echo "E: Unable to locate package nosuch" >&2; exit 100 ;;
*--print-uris*) echo "'http://debian/a.deb' a.deb 7000000 SHA:a"; echo "'http://debian/b.deb' b.deb 4500000 SHA:b" ;;
*" install "*) echo "Inst erlang-base (1 Debian [amd64])"; echo "Inst rabbitmq-server (3 Debian [all])" ;;
*" download "*) touch erlang-base.deb rabbitmq-server.deb ;;
esac
"""
DPKG = """#!/bin/sh
case "$2" in
erlang-base.deb)
    mkdir -p "$3/usr/lib/erlang/bin" "$3/usr/lib/erlang/erts-1/bin"
    printf '    ROOTDIR=/usr/lib/erlang\\n' > "$3/usr/lib/erlang/bin/erl"
    ;;
rabbitmq-server.deb)
    mkdir -p "$3/usr/lib/rabbitmq/lib/rabbitmq_server-3/sbin"
    touch "$3/usr/lib/rabbitmq/lib/rabbitmq_server-3/sbin/rabbitmq-server"
    ;;
esac
"""


class Machine:
    """A machine with `openssl` and without root; `script` are more programs on its PATH besides the usual ones."""

    def __init__(self, folder: Path, **script: str) -> None:
        self.unpacked, self.programs = folder / "cache/debian", folder / "bin"
        self.programs.mkdir()
        for name in USUAL.split():
            (self.programs / name).symlink_to(shutil.which(name) or name)
        for name, text in script.items():
            program = self.programs / name.replace("_", "-")
            program.write_text(text)
            program.chmod(0o755)
        (folder / "status").write_text(STATUS)
        self.more = {"STATUS": str(folder / "status"), "UNPACKED": str(self.unpacked), "AS_USER": "1"}

    def provide(self, *packages: str) -> str:
        """Return the script's output for these packages."""
        environment = {"PATH": str(self.programs), **self.more}
        text = "\n".join(packages)
        done = run_guarded(
            ["sh", SCRIPT, "/dev/stdin"], input=text, env=environment, capture_output=True, text=True, timeout=HANG
        )
        assert done.returncode == 0, done.stderr
        return str(done.stdout + done.stderr)


def test_what_is_installed_is_not_asked_for(tmp_path: Path) -> None:
    assert Machine(tmp_path).provide("openssl") == ""


def test_what_serves_in_the_place_of_a_package_is_enough(tmp_path: Path) -> None:
    machine = Machine(tmp_path, fish="#!/bin/sh\n")
    assert machine.provide("fish  fish  completion in fish") == ""
    said = machine.provide("fish  -  completion in fish", "zsh zsh  completion in zsh # soon").splitlines()
    assert said[1:] == ["  fish             completion in fish", "  zsh              completion in zsh"]


def test_where_there_is_no_apt_it_lists_what_is_missing_and_tests_of_it_are_skipped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = Machine(tmp_path)
    said = machine.provide("openssl", "rabbitmq-server - a broker", "# for pictures", "libegl1 - pictures").splitlines()
    reason = "there is no apt-get, so install it with your system's packages"
    assert said == [
        f"Tests of these are skipped, since this machine lacks them ({reason}):",
        "  rabbitmq-server  a broker",
        "  libegl1          pictures",
    ]
    monkeypatch.setattr(rabbitmq, "ROOTS", (tmp_path / "none",))
    monkeypatch.setattr(provided, "MISSING", machine.unpacked.with_suffix(".missing"))
    with pytest.raises(pytest.skip.Exception) as skipped:
        rabbitmq.RabbitMQ()
    assert str(skipped.value) == f"rabbitmq-server is not on this machine: {reason}"
    machine.unpacked.with_suffix(".missing").unlink()
    with pytest.raises(pytest.fail.Exception, match="rabbitmq-server is not on this machine: `make setup`"):
        rabbitmq.RabbitMQ()


def test_where_there_is_apt_what_is_missing_is_unpacked_once(tmp_path: Path) -> None:
    machine = Machine(tmp_path, apt_get=APT, dpkg=DPKG)
    said = machine.provide("openssl", "rabbitmq-server  -  a broker").splitlines()
    assert said == [
        "asking apt-get for rabbitmq-server …",
        "Unpacking Debian packages into .cache/debian, without root, 12 MB to download (once):",
        "  rabbitmq-server  a broker",
    ]
    erl = machine.unpacked / "root/usr/lib/erlang/bin/erl"
    assert erl.read_text() == f"    ROOTDIR={machine.unpacked}/root/usr/lib/erlang\n"
    assert not list((machine.unpacked / "archives").glob("*.deb"))
    asked = Path(f"{machine.unpacked}.asked").read_text()
    assert "download erlang-base rabbitmq-server" in asked
    assert machine.provide("openssl", "rabbitmq-server") == ""
    assert Path(f"{machine.unpacked}.asked").read_text() == asked


def test_what_apt_does_not_know_is_left_out_and_the_rest_is_provided(tmp_path: Path) -> None:
    machine = Machine(tmp_path, apt_get=APT, dpkg=DPKG)
    said = machine.provide("nosuch - none", "rabbitmq-server - a broker").splitlines()
    reason = "apt-get does not find it: Unable to locate package nosuch"
    assert said[1] == f"Tests of these are skipped, since this machine lacks them ({reason}):"
    assert said[-1] == "  rabbitmq-server  a broker"
    assert (machine.unpacked / "rabbitmq-server").exists()
    assert machine.unpacked.with_suffix(".missing").read_text() == f"nosuch is not on this machine: {reason}\n"


@pytest.mark.parametrize(
    ("failing", "said"),
    [
        ("", "apt-get does not find it: no route"),
        ('case "$*" in *" download "*) ;; *) echo Inst a; exit 0 ;; esac', "apt-get could not fetch it: no route"),
    ],
    ids=["looking", "fetching"],
)
def test_what_apt_complains_of_is_the_reason(tmp_path: Path, failing: str, said: str) -> None:
    machine = Machine(tmp_path, apt_get=f"#!/bin/sh\n{failing}\necho 'E: no route' >&2\nexit 100\n", dpkg=DPKG)
    machine.provide("rabbitmq-server")
    missing = machine.unpacked.with_suffix(".missing").read_text()
    assert missing == f"rabbitmq-server is not on this machine: {said}\n"


LOCK = "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)"
HELD = """case "$*" in *" VERB"*)
    echo try >> "$UNPACKED.tries"
    if [ "$(grep -c try "$UNPACKED.tries")" -lt 4 ]; then echo 'LOCK' >&2; exit 100; fi
esac
"""


@pytest.mark.parametrize("verb", ["update", "download"])
def test_a_lock_that_another_program_has_is_waited_for(tmp_path: Path, verb: str) -> None:
    held = HELD.replace("VERB", verb).replace("LOCK", LOCK)
    machine = Machine(tmp_path, apt_get=APT.replace("\n", f"\n{held}", 1), dpkg=DPKG)
    machine.more["PAUSE"] = "0"
    said = machine.provide("rabbitmq-server - a broker").splitlines()
    assert said.count(f"waiting until apt's lock is free: {LOCK[3:]} …") == 1
    assert (machine.unpacked / "rabbitmq-server").exists()
    assert Path(f"{machine.unpacked}.tries").read_text() == "try\n" * 4


def test_a_lock_that_is_never_free_is_the_reason(tmp_path: Path) -> None:
    machine = Machine(tmp_path, apt_get=f"#!/bin/sh\necho '{LOCK}' >&2\nexit 100\n", dpkg=DPKG)
    machine.more["PAUSE"] = "0"
    machine.provide("rabbitmq-server")
    assert LOCK[3:] in machine.unpacked.with_suffix(".missing").read_text()


def test_a_broker_that_is_given_is_used_for_what_needs_no_more() -> None:
    given = rabbitmq.GivenBroker("amqp://a:b@127.0.0.1:5/")
    assert given.url == given.url_of("guest") == "amqp://a:b@127.0.0.1:5/"
    for name in ("kill", "secure", "mqtt"):
        with pytest.raises(pytest.skip.Exception, match="LUMEN_TEST_BROKER names a broker that is not ours"):
            getattr(given, name)
    with pytest.raises(pytest.skip.Exception):
        given.url_of("visual")


@pytest.mark.soak
@pytest.mark.broker
def test_rabbitmq_starts_from_where_it_was_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Fetched as on a machine without RabbitMQ: it and Erlang are removed from the list of installed packages."""
    blocks = Path("/var/lib/dpkg/status").read_text().split("\n\n")
    left = [block for block in blocks if not block.startswith(("Package: rabbitmq-server", "Package: erlang-"))]
    (tmp_path / "status").write_text("\n\n".join(left))
    more = {"STATUS": str(tmp_path / "status"), "UNPACKED": str(tmp_path / "debian"), "AS_USER": "1"}
    run_guarded(["sh", SCRIPT, "/dev/stdin"], input=b"rabbitmq-server", env=os.environ | more, timeout=HANG, check=True)
    monkeypatch.setattr(rabbitmq, "ROOTS", (tmp_path / "debian/root",))
    broker = rabbitmq.RabbitMQ()
    broker.start()
    broker.stop()
