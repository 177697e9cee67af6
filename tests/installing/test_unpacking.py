"""Debian's packages without root: unpacked, or told in one line what is missing; a broker that is given."""

import os
import shutil
from pathlib import Path

import pytest

from tests import rabbitmq
from tests.guarded import run_guarded
from tests.waiting import HANG

SCRIPT = Path(__file__).parents[2] / "scripts/packages.sh"
STATUS = """Package: openssl
Status: install ok installed
Version: 3

Package: rabbitmq-server
Status: deinstall ok config-files
"""
APT = """#!/bin/sh
echo "$@" >> "$UNPACKED.asked"
case "$*" in
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
    """One on which `openssl` is installed and nobody is root; `script` are programs on its PATH besides the usual."""

    def __init__(self, folder: Path, **script: str) -> None:
        self.unpacked, self.programs = folder / "cache/debian", folder / "bin"
        self.programs.mkdir()
        for name in ("sh", "cat", "awk", "rm", "mkdir", "dirname", "tee", "id", "sed", "grep", "touch", "tail", "env"):
            (self.programs / name).symlink_to(shutil.which(name) or name)
        for name, text in script.items():
            program = self.programs / name.replace("_", "-")
            program.write_text(text)
            program.chmod(0o755)
        (folder / "status").write_text(STATUS)
        self.more = {"STATUS": str(folder / "status"), "UNPACKED": str(self.unpacked), "AS_USER": "1"}

    def provide(self, *packages: str) -> str:
        """What the script says of these."""
        environment = {"PATH": str(self.programs), **self.more}
        text = "\n".join(packages)
        done = run_guarded(
            ["sh", SCRIPT, "/dev/stdin"], input=text, env=environment, capture_output=True, text=True, timeout=HANG
        )
        assert done.returncode == 0, done.stderr
        return str(done.stdout + done.stderr)


def test_what_is_installed_is_not_asked_for(tmp_path: Path) -> None:
    assert Machine(tmp_path).provide("openssl") == ""


def test_where_there_is_no_apt_one_line_says_what_is_missing_and_tests_of_it_are_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = Machine(tmp_path)
    (said,) = machine.provide("openssl", "rabbitmq-server", "libegl1").splitlines()
    assert said.startswith(
        "not on this machine, so tests that need it are left out: rabbitmq-server libegl1 (there is no"
    )
    monkeypatch.setattr(rabbitmq, "ROOTS", (tmp_path / "none",))
    monkeypatch.setattr(rabbitmq, "UNPACKED", machine.unpacked)
    with pytest.raises(pytest.skip.Exception) as skipped:
        rabbitmq.RabbitMQ()
    assert str(skipped.value) == said
    machine.unpacked.with_suffix(".missing").unlink()
    with pytest.raises(pytest.fail.Exception, match="RabbitMQ is not installed: `make packages`"):
        rabbitmq.RabbitMQ()


def test_where_there_is_apt_what_is_missing_is_unpacked_once(tmp_path: Path) -> None:
    machine = Machine(tmp_path, apt_get=APT, dpkg=DPKG)
    assert "unpacking rabbitmq-server into .cache/debian, without root" in machine.provide("openssl", "rabbitmq-server")
    erl = machine.unpacked / "root/usr/lib/erlang/bin/erl"
    assert erl.read_text() == f"    ROOTDIR={machine.unpacked}/root/usr/lib/erlang\n"
    assert not list((machine.unpacked / "archives").glob("*.deb"))
    asked = Path(f"{machine.unpacked}.asked").read_text()
    assert "download erlang-base rabbitmq-server" in asked
    assert machine.provide("openssl", "rabbitmq-server") == ""
    assert Path(f"{machine.unpacked}.asked").read_text() == asked


def test_what_apt_says_stands_in_the_line(tmp_path: Path) -> None:
    machine = Machine(tmp_path, apt_get="#!/bin/sh\necho 'E: no route' >&2\nexit 100\n", dpkg=DPKG)
    assert "rabbitmq-server (apt-get could not fetch it: E: no route)" in machine.provide("rabbitmq-server")


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
    """Fetched as on a machine without it: it and Erlang are taken from the list of what is installed."""
    blocks = Path("/var/lib/dpkg/status").read_text().split("\n\n")
    left = [block for block in blocks if not block.startswith(("Package: rabbitmq-server", "Package: erlang-"))]
    (tmp_path / "status").write_text("\n\n".join(left))
    more = {"STATUS": str(tmp_path / "status"), "UNPACKED": str(tmp_path / "debian"), "AS_USER": "1"}
    run_guarded(["sh", SCRIPT, "/dev/stdin"], input=b"rabbitmq-server", env=os.environ | more, timeout=HANG, check=True)
    monkeypatch.setattr(rabbitmq, "ROOTS", (tmp_path / "debian/root",))
    broker = rabbitmq.RabbitMQ()
    broker.start()
    broker.stop()
