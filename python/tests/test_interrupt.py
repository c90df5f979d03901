"""Progress, Ctrl-C, and the interpreter's lock."""
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import cloud2csg

ENDLESS = """
import cloud2csg, sys
options = cloud2csg.ExtractOptions(strategy="baseline", search=cloud2csg.GaOptions(
    idle_generations=10**9, generation_limit=10**9, listing_limit=0, trust=0))
model = cloud2csg.Model.read(sys.argv[1])
cloud = cloud2csg.sample(model, count=3000, noise=0.01)
def progress(stage, done, total):
    if stage == "search":
        print("searching", flush=True)
try:
    cloud2csg.extract(cloud, model, options{progress})
except KeyboardInterrupt:
    print("stopped", flush=True)
    sys.exit(3)
"""


@pytest.mark.parametrize("progress", ["", ", progress=progress"])
def test_ctrl_c_stops_the_search(root, progress):
    code = ENDLESS.replace("{progress}", progress)
    if not progress:
        code = code.replace("try:", "print('searching', flush=True)\ntry:")
    child = subprocess.Popen([sys.executable, "-c", code, str(root / "data/models/m0.json")],
                             stdout=subprocess.PIPE, text=True)
    try:
        assert child.stdout.readline() == "searching\n"
        if not progress:
            time.sleep(0.5)  # into the search; the test is valid for any time
        child.send_signal(signal.SIGINT)
        rest, _ = child.communicate(timeout=120)  # the search itself would take years
    finally:
        child.kill()
    assert rest.endswith("stopped\n") and child.returncode == 3


def test_progress_tells_stages(m0):
    seen = []
    cloud2csg.extract(cloud2csg.sample(m0, count=5000), m0, progress=lambda *message: seen.append(message))
    assert seen and all(isinstance(stage, str) and done >= 0 and total >= 0 for stage, done, total in seen)
    assert "search" in {stage for stage, _, _ in seen}


def test_exceptions_of_the_callback_stop_the_search(m0, endless):
    class Enough(Exception):
        pass

    def stop(stage, done, total):
        if stage == "search":
            raise Enough(stage)

    cloud = cloud2csg.sample(m0, count=3000, noise=0.01)
    with pytest.raises(Enough, match="search"):
        cloud2csg.extract(cloud, m0, endless, progress=stop)
    assert cloud2csg.extract(cloud, m0).complete


def test_callbacks_run_in_the_thread_of_the_call(m0):
    threads = set()
    cloud2csg.extract(cloud2csg.sample(m0, count=3000), m0, threads=2,
                      progress=lambda *message: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_progress_must_be_callable(m0):
    with pytest.raises(TypeError, match="progress"):
        cloud2csg.sample(m0, progress=3)


def test_other_threads_run_meanwhile(m0, endless):
    cloud = cloud2csg.sample(m0, count=3000, noise=0.01)
    turns = 0

    class Enough(Exception):
        pass

    def stop(stage, done, total):
        if turns > 20:
            raise Enough

    outcome = []

    def extract():
        try:
            cloud2csg.extract(cloud, m0, endless, progress=stop)
        except Enough as enough:
            outcome.append(enough)

    worker = threading.Thread(target=extract)
    worker.start()
    while worker.is_alive():
        time.sleep(0.001)
        turns += 1
    assert len(outcome) == 1 and turns > 20


def test_fields_release_the_lock_too(m0):
    points = np.random.default_rng(3).normal(size=(2_000_000, 3))
    done = threading.Event()

    def evaluate():
        m0.distance(points, threads=1)
        done.set()

    worker = threading.Thread(target=evaluate)
    worker.start()
    turns = 0
    while not done.is_set():
        time.sleep(0.001)
        turns += 1
    worker.join()
    assert turns > 10


def test_calls_side_by_side_agree(m0):
    cloud = cloud2csg.sample(m0, count=5000, noise=0.01)
    trees = []
    workers = [threading.Thread(target=lambda: trees.append(cloud2csg.extract(cloud, m0).model.tree))
               for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(trees) == 4 and len(set(trees)) == 1
