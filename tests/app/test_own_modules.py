"""Modules of the project's own: watched by their signs of life, started, restarted and ended for certain."""

import os
import re
import shutil
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import Mock

import pytest

from lumen.bus import Bus, connect, join
from lumen.bus.memory import MemoryBus
from lumen.cli.main import main
from lumen.clock.real import RealClock
from lumen.errors import UsageError
from lumen.language.events import Event
from lumen.language.modules import ModuleSettings
from lumen.language.projects import Project
from lumen.project import load
from lumen.run import joining
from lumen.run.claiming import refuse_rivals
from lumen.run.joining import JoinedModule
from lumen.run.parts.own_module import OwnModulePart
from lumen.run.plan import Plan
from lumen.run.presence import PRESENCE_PERIOD, PRESENCE_ROUTE, Presence
from lumen.run.services import Services
from lumen.upkeep.supervised_process import FIRST_PAUSE, MAX_LINES, SupervisedProcess
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import PIPE, STDOUT, Guarded, run_guarded
from tests.rabbitmq import RabbitMQ
from tests.waiting import APART, HANG, Collector, until

pytestmark = pytest.mark.process


class Time:
    """A clock that a test sets."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def alive(pid: int) -> bool:
    """Return whether a process runs; a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


# The process


@pytest.fixture
def time() -> Time:
    return Time()


@pytest.fixture
def processes(tmp_path: Path, time: Time) -> Iterator["Starter"]:
    starter = Starter(tmp_path, time)
    yield starter
    starter.close()


class Starter:
    """Makes processes that end with the test."""

    def __init__(self, folder: Path, time: Time) -> None:
        self.folder, self.time = folder, time
        self.made: list[SupervisedProcess] = []

    def __call__(self, *command: str) -> SupervisedProcess:
        self.made.append(SupervisedProcess("mood", command, self.folder, dict(os.environ), clock=self.time))
        return self.made[-1]

    def close(self) -> None:
        for process in self.made:
            process.close()


def ended(process: SupervisedProcess) -> str:
    reason = ""

    def over() -> str:
        nonlocal reason
        reason = process.tick()
        return reason

    until(over)
    return reason


def printed(process: SupervisedProcess, count: int) -> list[str]:
    lines: list[str] = []

    def enough() -> bool:
        lines.extend(process.lines())
        return len(lines) >= count

    until(enough)
    return lines


def test_a_program_is_started_again_with_growing_pauses(processes: "Starter", time: Time) -> None:
    process = processes("sh", "-c", "echo a line; echo the reason >&2; exit 3")
    pauses = []
    for _ in range(4):
        assert process.tick() == ""
        assert ended(process) == "ended with exit code 3: the reason"
        pauses.append(process.next - time.now)
        assert process.tick() == ""
        assert not process.running
        time.now = process.next
    assert pauses == [FIRST_PAUSE, 2 * FIRST_PAUSE, 4 * FIRST_PAUSE, 8 * FIRST_PAUSE]
    assert process.lines() == ["a line", "the reason"] * 4


def test_a_program_that_ran_long_begins_with_the_first_pause(processes: "Starter", time: Time) -> None:
    process = processes("sh", "-c", "exit 1")
    for _ in range(3):
        process.tick()
        ended(process)
        time.now = process.next
    process.tick()
    until(lambda: not process.running)
    time.now += 100.0
    ended(process)
    assert process.next - time.now == FIRST_PAUSE


def test_a_program_that_is_not_there_is_told(processes: "Starter") -> None:
    assert processes("no-such-program").tick() == "can't be started: there is no program `no-such-program`"
    assert processes("./mood").tick() == "can't be started: there is no program `./mood`"


def test_a_flood_of_lines_is_bounded(processes: "Starter") -> None:
    process = processes("sh", "-c", "head -c 3000000 /dev/zero | tr '\\0' 'x'; yes | head -n 5000")
    process.tick()
    ended(process)
    lines = process.lines()
    assert len(lines) == MAX_LINES + 1
    assert lines[-1].endswith("more lines are left out")
    assert max(map(len, lines)) <= 500


def test_close_ends_all_that_the_program_has_started(processes: "Starter") -> None:
    """`close` ends even a program that ignores SIGTERM, and its background processes."""
    process = processes("sh", "-c", "trap '' TERM; sleep 1000 & echo $$ $!; wait")
    process.tick()
    pids = [int(word) for word in printed(process, 1)[0].split()]
    assert all(map(alive, pids))
    process.close()
    until(lambda: not any(map(alive, pids)))


@pytest.mark.parametrize("then", ["exit 3", "sleep 1000"])
def test_a_program_in_a_group_of_its_own_that_keeps_the_output_open_holds_nobody_up(
    processes: "Starter", then: str
) -> None:
    process = processes("sh", "-c", f"setsid sleep 1000 & {APART}; echo $!; {then}")
    process.tick()
    (pid,) = map(int, printed(process, 1))
    if then == "exit 3":
        assert ended(process) == f"ended with exit code 3: {pid}"
    process.close()
    assert alive(pid)
    os.kill(pid, signal.SIGKILL)


def test_the_program_ends_with_an_exhibition_that_is_killed(tmp_path: Path) -> None:
    code = (
        "import os, pathlib, time\n"
        "from lumen.upkeep.supervised_process import SupervisedProcess\n"
        "command = 'sh', '-c', 'sleep 1000 & echo $$ $!; wait'\n"
        "process = SupervisedProcess('mood', command, pathlib.Path('.'), os.environ)\n"
        "process.tick()\n"
        "while not (lines := process.lines()): time.sleep(0.01)\n"
        "print(lines[0], flush=True)\n"
        "time.sleep(1000)\n"
    )
    with Guarded([sys.executable, "-c", code], stdout=PIPE, text=True, cwd=tmp_path) as exhibition:
        assert exhibition.stdout
        pids = [int(word) for word in exhibition.stdout.readline().split()]
        assert all(map(alive, pids))
        exhibition.kill()
    until(lambda: not any(map(alive, pids)))


# The part


class Watched:
    """The part that watches a module, without an exhibition."""

    def __init__(self, project: Project, settings: ModuleSettings, time: Time, bus: Bus | None = None) -> None:
        self.project = project
        self.bus, self.time = bus or MemoryBus(), time
        self.lines: list[str] = []
        self.events: list[Event] = []
        with_module = type(project)(**{**vars(project), "modules": {"mood": settings}})
        self.part = OwnModulePart(
            "mood", with_module, self.bus, lambda _, line: self.lines.append(line), self.events.append, clock=time
        )
        self.part.begin(0.0)

    def tick(self, seconds: float = 0.0) -> list[str]:
        """Advance the clock by `seconds` and tick; return the names of the events."""
        self.time.now += seconds
        before = len(self.events)
        self.part.tick(0.0, ())
        return [event.name for event in self.events[before:]]

    def says(self, state: str = "here", session: str = "a") -> None:
        body = {"robot": self.project.robot, "parts": ["mood"], "session": session, "state": state}
        self.bus.publish(self.project.key_of("presence"), body)


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Project:
    root = tmp_path_factory.mktemp("hall") / "hall"
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen"))
    return load(root)


def test_a_program_elsewhere_is_awaited_then_lost_and_found(project: Project, time: Time) -> None:
    watched = Watched(project, ModuleSettings(command=("mood",), health=3.0), time)
    assert watched.tick(60.0) == []
    assert watched.part.status["state"] == "awaited"
    watched.says()
    assert watched.tick() == []
    assert watched.part.status["state"] == "here"
    assert watched.tick(3.0) == []
    assert watched.tick(0.1) == ["mood.lost"]
    assert watched.events[-1].data == {"seconds": 0.1, "reason": "it sent no sign of life for 3 s"}
    assert watched.part.status["state"] == "lost"
    assert watched.tick(60.0) == []
    watched.says()
    assert watched.tick() == ["mood.found"]
    assert watched.events[-1].data == {"seconds": 60.0}


def test_a_program_elsewhere_that_leaves_is_lost_at_once(project: Project, time: Time) -> None:
    watched = Watched(project, ModuleSettings(command=("mood",)), time)
    watched.says()
    assert watched.tick() == []
    watched.says("leaves")
    assert watched.tick() == ["mood.lost"]
    assert watched.events[-1].data["reason"] == "it has left"


def test_the_signs_of_another_robots_module_do_not_count(project: Project, time: Time) -> None:
    watched = Watched(project, ModuleSettings(command=("mood",), health=3.0), time)
    watched.bus.publish(
        project.key_of("presence"), {"robot": "Other", "parts": ["mood"], "session": "b", "state": "here"}
    )
    watched.tick()
    assert watched.part.status["state"] == "awaited"


def test_a_program_that_ends_is_lost_and_found_once_it_runs_again(project: Project, time: Time) -> None:
    watched = Watched(project, ModuleSettings(here=True, command=("sh", "-c", "echo hello; exit 7")), time)
    assert watched.tick() == []
    until(lambda: watched.tick() == ["mood.lost"])
    assert watched.events[-1].data["reason"] == "ended with exit code 7: hello"
    assert watched.lines == ["hello", "ended with exit code 7: hello; the next attempt is in 1 s"]
    watched.part.close()


def test_a_program_that_hangs_is_killed_and_started_again(project: Project, time: Time) -> None:
    command = ("sh", "-c", "echo $$; sleep 1000")
    watched = Watched(project, ModuleSettings(here=True, command=command, health=2.0), time)
    watched.tick()
    until(lambda: watched.tick() or watched.lines)
    first = int(watched.lines[0])
    watched.says()
    assert watched.tick() == []
    assert watched.tick(2.5) == ["mood.lost"]
    until(lambda: not alive(first))
    until(lambda: watched.tick() or any(line.startswith("was ended by SIGKILL") for line in watched.lines))
    assert watched.tick(1.5) == []
    until(lambda: watched.tick() or watched.lines[-1].isdecimal())
    watched.says(session="c")
    assert watched.tick() == ["mood.found"]
    second = int(next(line for line in reversed(watched.lines) if line.isdecimal()))
    watched.part.close()
    until(lambda: not alive(second))


# The program


def test_a_program_shows_that_it_lives_once_per_period(
    monkeypatch: pytest.MonkeyPatch, time: Time, tmp_path: Path
) -> None:
    monkeypatch.setattr(joining, "time", Mock(monotonic=time))
    monkeypatch.setattr(joining, "signal", Mock())
    bus, seen = MemoryBus(str(tmp_path)), Collector()
    bus.subscribe("lumen.NAO.presence", seen)
    with JoinedModule("mood", "NAO", MemoryBus(str(tmp_path)), None) as module:
        module.alive()
        module.alive()
        time.now += PRESENCE_PERIOD
        assert module.wait(0.0)
    assert [body["state"] for body in seen.bodies] == ["here", "here", "leaves"]
    assert {tuple(body["parts"]) for body in seen.bodies} == {("mood",)}


TERMINATED_IN_A_WAIT = """
import signal, sys, threading, time
from lumen.bus.memory import MemoryBus
from lumen.run.joining import JoinedModule

def end(main):
    while sys._current_frames()[main].f_code is not JoinedModule.wait.__code__:
        time.sleep(0.01)
    signal.pthread_kill(main, signal.SIGTERM)

def wait(*arguments):  # of an Event, which has its lock here
    signal.raise_signal(signal.SIGTERM)
    return inside(*arguments)

ending = threading.Thread(target=end, args=[threading.get_ident()])
with JoinedModule("mood", "NAO", MemoryBus("terminated"), None) as module:
    ending.start()
    inside, threading.Condition.wait = threading.Condition.wait, wait
    print(module.wait(1000.0), module.wait(1000.0), flush=True)
    threading.Condition.wait = inside
"""


def test_sigterm_ends_a_program_at_any_moment_of_its_wait() -> None:
    done = run_guarded([sys.executable, "-c", TERMINATED_IN_A_WAIT], capture_output=True, text=True, timeout=HANG)
    assert (done.stdout, done.stderr, done.returncode) == ("False False\n", "", 0)


# The exhibition


def test_an_exhibition_starts_its_module_and_hears_of_its_loss(tmp_path: Path) -> None:
    root = tmp_path / "hall"
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen"))
    (root / "mood.py").write_text(
        "import os\n"
        "from lumen.bus import join\n"
        "with join() as module:\n"
        "    print('joined as', module.name, 'of', module.robot)\n"
        "    module.wait(1.0)\n"
        "    if os.path.exists('again'):\n"
        "        module.wait(1000.0)\n"
        "    open('again', 'w').close()\n"
        "    raise ValueError('a bad mood')\n"
    )
    with (root / "lumen.yaml").open("a") as file:
        file.write("modules: {mood: {command: [python3, mood.py], here: true, health: 60s}}\n")
    behavior = root / "behaviors/hello.yaml"
    text = behavior.read_text().replace("\nentry:", "\non: {mood.found: {actions: {log: all is well again}}}\nentry:")
    behavior.write_text(text)
    line = [sys.executable, "-m", "lumen", "run", str(root), "--robot", "recording", "--for", "10min"]
    with Guarded(line, stdin=PIPE, stdout=PIPE, stderr=STDOUT, text=True) as run:
        assert run.stdout
        said = []
        for each in run.stdout:
            said.append(each)
            if "all is well again" in each:
                break
        run.terminate()
        said += run.stdout
    shown = re.sub(r"\s+", " ", "".join(said))
    assert "mood joined as mood of NAO" in shown
    assert "mood ValueError: a bad mood" in shown
    assert "mood ended with exit code 1: ValueError: a bad mood; the next attempt is in 1 s" in shown
    assert "mood is found again, after" in shown


@pytest.mark.parametrize(
    ("only", "here", "said"),
    [
        ("mod", "", "there is no part `mod`: did you mean `mood`?"),
        ("mood", ", here: true", "the process of the brain starts `mood` already"),
    ],
)
def test_only_a_program_that_no_other_process_starts_can_be_a_part(
    only: str, here: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    (root / "mood.py").write_text("")
    with (root / "lumen.yaml").open("a") as file:
        file.write(f"modules: {{mood: {{command: [python3, mood.py]{here}}}}}\n")
    assert main(["run", str(root), "--only", only]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("broken", ["modules: {mood: {command: [python3, mood.py]}}\nrobot: [\n", "modules: 3\n"])
def test_if_lumen_yaml_is_broken_its_errors_come_before_an_unknown_part(
    broken: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    with (root / "lumen.yaml").open("a") as file:
        file.write(broken)
    assert main(["run", str(root), "--only", "mood"]) == 1
    said = capsys.readouterr().err
    assert "error [" in said
    assert "there is no part" not in said


@pytest.mark.parametrize("only", ["mood", "memory", "brain,mood", "visitor"])
def test_each_part_starts_with_the_last_good_files_if_lumen_yaml_is_broken(
    only: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    (root / "mood.py").write_text("")
    main_file = root / "lumen.yaml"
    main_file.write_text(f"{main_file.read_text()}modules: {{mood: {{command: [python3, mood.py]}}}}\n")
    assert main(["run", str(root), "--robot", "recording", "--speed", "max", "--for", "1s"]) == 0
    main_file.write_text(f"{main_file.read_text()}robot: [\n")
    capsys.readouterr()
    assert main(["run", str(root), "--only", only]) == 1
    assert main(["run", str(root), "--only", only, "--last-good"]) == 2
    said = capsys.readouterr().err
    assert "THE FILES HAVE ERRORS: IT STARTS WITH THE LAST GOOD ONES" in said
    assert "several processes need a common bus" in said
    assert main(["run", str(root), "--only", "mod", "--last-good"]) == 2
    assert "there is no part `mod`: did you mean `mood`?" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("roles", "here", "parts"),
    [
        (("mood",), "", ("host of mood",)),
        (("brain", "mood"), "", ("brain", "host of mood")),
        (("brain",), ", here: true", ("brain", "host of mood")),
        (("brain",), "", ("brain",)),
        (("eyes",), ", here: true", ("eyes",)),
    ],
)
def test_a_process_claims_the_programs_that_it_starts(
    roles: tuple[str, ...], here: str, parts: tuple[str, ...], tmp_path: Path
) -> None:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    (root / "mood.py").write_text("")
    with (root / "lumen.yaml").open("a") as file:
        file.write(f"modules: {{mood: {{command: [python3, mood.py]{here}}}}}\n")
    project, bus = load(root), MemoryBus()
    first, second = (_claiming(project, bus, roles) for _ in range(2))
    assert first.parts == second.parts == parts
    first.settle()
    for each in (second, first, second):
        each.tick()
    with pytest.raises(UsageError, match=f"is already the {parts[0]} of .* on this bus"):
        refuse_rivals(second)
    other = Presence(bus, project.robot, ("visitor",), key=project.key_of(PRESENCE_ROUTE))
    other.tick()
    refuse_rivals(other)


def _claiming(project: Project, bus: Bus, roles: tuple[str, ...]) -> Presence:
    """The presence of a process with these roles."""
    presence = Services(Plan(project, None, bus, roles=roles, clock=RealClock())).presence
    assert presence
    return presence


def test_a_program_on_another_machine_shows_that_it_lives_over_a_broker(
    project: Project, time: Time, broker: RabbitMQ
) -> None:
    """Arguments give the module what `lumen run` would set in its environment."""
    bus = connect(broker.url)
    watched = Watched(project, ModuleSettings(command=("mood",), health=60.0), time, bus)
    with join("mood", robot=project.robot, bus=broker.url) as module:
        until(lambda: watched.tick() == [] and watched.part.status["state"] == "here", meanwhile=module.alive)
    until(lambda: watched.tick() == ["mood.lost"])
    assert watched.events[-1].data["reason"] == "it has left"
    bus.close()
