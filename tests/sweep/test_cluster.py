"""Sweeps on a cluster: a real scheduler and workers, which are killed, started anew and left."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from aidl_lang.common import processes as cluster_module
from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.processes import Broke, Cluster, Crew, EngineError, Limit
from aidl_lang.tools.cli import main
from tests.sweep.cluster import LocalCluster, free_port
from tests.sweep.here import PLATE
from tests.sweep.test_crew import obey

LIBRARY = 'let tall = 30mm\nlet style_of = "round"\n'
PROGRAM = 'import "lib.aidl"\n' + PLATE.replace("height: 30mm", "height: tall")


@pytest.fixture(scope="module")
def shared() -> Iterator[str]:
    """The address of a cluster that nobody kills, with one worker for two calls at a time."""
    distributed = pytest.importorskip("distributed")
    settings = {"DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False"}
    with distributed.LocalCluster(1, 2, dashboard_address=None, env=settings) as cluster:
        yield cluster.scheduler_address


@pytest.fixture
def two(tmp_path: Path) -> Iterator[LocalCluster]:
    (tmp_path / "logs").mkdir()
    cluster = LocalCluster(tmp_path / "logs", workers=2)
    yield cluster
    cluster.close()


def write_programs(folder: Path) -> None:
    (folder / "lib.aidl").write_text(LIBRARY)
    (folder / "plate.aidl").write_text(PROGRAM)


def words_for(table: str, count: int, *more: str) -> list[str]:
    varied = ["-D", f"width=40..120/{count // 2}", "-D", "style=*"]
    outputs = ["-o", table, "-o", f"{table.removesuffix('.csv')}/{{n}}.svg"]
    return ["sweep", "plate.aidl", *varied, *outputs, "--no-timings", "--progress", "json", *more]


def begin(folder: Path, table: str, count: int, *more: str) -> subprocess.Popen[str]:
    write_programs(folder)
    command = [sys.executable, "-m", "aidl_lang", *words_for(table, count, *more)]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)


def table_of(folder: Path, name: str) -> bytes:
    stem = name.removesuffix(".csv").encode()
    return (folder / name).read_bytes().replace(b",%s/" % stem, b",out/").replace(b" %s/" % stem, b" out/")


def same(folder: Path, one: str, other: str, count: int) -> None:
    """Asserts that two sweeps have the same table and drawings, of each variant one."""
    assert table_of(folder, one) == table_of(folder, other)
    lines = table_of(folder, one).decode().splitlines()[1:]
    assert [line.split(",")[0] for line in lines] == [str(k) for k in range(1, count + 1)]
    for path in (folder / one.removesuffix(".csv")).iterdir():
        assert path.read_bytes() == (folder / other.removesuffix(".csv") / path.name).read_bytes()


def wait_until_done(run: subprocess.Popen[str], done: int) -> None:
    """Waits until a sweep has done so many variants."""
    assert run.stderr is not None
    for line in run.stderr:
        if line.startswith("{") and json.loads(line)["done"] >= done:
            return
    raise AssertionError("the sweep ended before")


def finish(crew: Crew[str, str]) -> None:
    while crew:
        crew.came(60)


def ended(run: subprocess.Popen[str], code: int = 1) -> str:
    """What a sweep has said at its end; those wider than the sheet fail."""
    said = run.communicate(timeout=600)[1]
    assert run.returncode == code, said
    return said


def test_a_sweep_on_a_cluster_equals_one_here(folder: Path, shared: str) -> None:
    write_programs(folder)
    assert main(words_for("local.csv", 6)) == 1
    assert main(words_for("remote.csv", 6, "--on", shared)) == 1
    same(folder, "local.csv", "remote.csv", 6)


@pytest.mark.slow
def test_three_hundred_variants_and_a_worker_killed_in_the_middle(tmp_path: Path, two: LocalCluster) -> None:
    ended(begin(tmp_path, "local.csv", 300))
    ended(begin(tmp_path, "remote.csv", 300, "--on", two.address))
    same(tmp_path, "local.csv", "remote.csv", 300)
    run = begin(tmp_path, "killed.csv", 300, "--on", two.address)
    wait_until_done(run, 40)
    two.kill_worker()
    two.add_worker()
    ended(run)
    same(tmp_path, "local.csv", "killed.csv", 300)


@pytest.mark.slow
def test_the_scheduler_may_be_started_anew(tmp_path: Path, two: LocalCluster) -> None:
    ended(begin(tmp_path, "local.csv", 120))
    run = begin(tmp_path, "remote.csv", 120, "--on", two.address)
    wait_until_done(run, 20)
    two.restart()
    assert "had to be begun again, as what compiled them was gone" in ended(run)
    same(tmp_path, "local.csv", "remote.csv", 120)


@pytest.mark.slow
def test_a_client_that_is_interrupted_leaves_nothing_behind_and_goes_on(
    tmp_path: Path, two: LocalCluster
) -> None:
    ended(begin(tmp_path, "local.csv", 120))
    run = begin(tmp_path, "remote.csv", 120, "--on", two.address)
    wait_until_done(run, 20)
    os.kill(run.pid, signal.SIGINT)
    said = ended(run, 130)
    assert "`remote.csv.sweep` has what is done; the same command with `--resume` goes on" in said
    from distributed import Client

    with Client(two.address, set_as_default=False) as client:
        until = time.monotonic() + 60
        while any(client.processing().values()) and time.monotonic() < until:
            time.sleep(0.5)
        assert not any(client.processing().values())
    assert "known before" in ended(begin(tmp_path, "remote.csv", 120, "--on", two.address, "--resume"))
    same(tmp_path, "local.csv", "remote.csv", 120)


def test_limits_hold_on_a_cluster(tmp_path: Path, shared: str) -> None:
    engine = Cluster(shared, "aidl_lang.common.processes")
    try:
        crew: Crew[str, str] = Crew(engine)
        for word in ("well", "die", "hang", "raise", "too"):
            crew.give(word, 1.0 if word == "hang" else 60.0, obey, word, str(tmp_path))
        found: dict[str, str | Broke] = {}
        while crew:
            found |= dict(crew.came(60))
        assert (found["well"], found["too"]) == ("well 1", "too 1")
        limits = {word: each.limit for word, each in found.items() if isinstance(each, Broke)}
        assert limits == {"die": Limit.DEATH, "hang": Limit.TIME, "raise": None}
        assert engine.places == 2
    finally:
        engine.close()


def test_a_worker_with_another_package_is_told(shared: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = cluster_module.package()
    monkeypatch.setattr(cluster_module, "package", lambda: "0.0.1+feed")
    engine = Cluster(shared, "aidl_lang.common.processes")
    try:
        crew: Crew[str, str] = Crew(engine)
        crew.give("it", 10.0, obey, "well", "/nowhere")
        with pytest.raises(EngineError) as raised:
            finish(crew)
    finally:
        engine.close()
    told = raised.value.diagnostic
    assert (told.code, told.message.partition("127.0.0.1")[0]) == ("E0977", "the worker at tcp://")
    assert told.message.endswith(f"has another package: {mine}, and here is 0.0.1+feed")


def test_a_scheduler_that_is_not_there_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster_module, "_CONNECTING", 0.3)
    address = f"tcp://127.0.0.1:{free_port()}"
    with pytest.raises(AidlError) as raised:
        Cluster(address, "aidl_lang.common.processes")
    assert raised.value.diagnostic.message.startswith(f"no scheduler answers at `{address}`: ")


@pytest.mark.slow
def test_a_scheduler_that_stays_away_is_told(
    tmp_path: Path, two: LocalCluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster_module, "_RECONNECTING", 3.0)
    engine = Cluster(two.address, "aidl_lang.common.processes")
    try:
        crew: Crew[str, str] = Crew(engine)
        crew.give("it", 60.0, obey, "hang", str(tmp_path))
        crew.came(5)
        two.close()
        with pytest.raises(EngineError) as raised:
            finish(crew)
    finally:
        engine.close()
    told = raised.value.diagnostic
    message = f"the scheduler at `{two.address}` is gone, and did not come back within 3 s"
    assert (told.code, told.message) == ("E0978", message)
