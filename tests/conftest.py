"""What all tests share: programs that need root, and hypothesis that minds no machine's speed."""

import ctypes
import gc
import importlib.util
import os
import shutil
import signal
import sys
import warnings
from pathlib import Path

import hypothesis
import pytest
from quick import Quick
from repository import SUPPORT

from tandemlift.analysis.linearization.step_graph import GRAPHS
from tandemlift.core.caching import LastUsed
from tandemlift.core.plugs import PLUGS
from tandemlift.simulation.plan import LOOP_CODE

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:  # of a job in the background: processes of tests would inherit it
    signal.signal(signal.SIGINT, lambda *_: None)
os.environ.setdefault("TANDEMLIFT_OPTIMISE", "0")  # hundreds of variants fly once each: what is tested is asked for
LIBC = ctypes.CDLL(None) if os.name == "posix" else None
M_MMAP_THRESHOLD, M_ARENA_MAX = -3, -8  # names and numbers of glibc
if hasattr(LIBC, "mallopt"):  # large arrays go back to the system when they are freed, and threads share two heaps
    LIBC.mallopt(M_MMAP_THRESHOLD, 1 << 20)
    LIBC.mallopt(M_ARENA_MAX, 2)
# of `make test-learning`, which installs it
collect_ignore = [] if importlib.util.find_spec("torch") else ["analysis/linearization/test_torch_step.py"]
LOOP_CODE.most = 10  # a process tests hundreds of variants, and seldom one again
SLOW = hypothesis.HealthCheck.too_slow
hypothesis.settings.register_profile("tandemlift", deadline=None, suppress_health_check=[SLOW], derandomize=True)
hypothesis.settings.load_profile("tandemlift")


def pytest_addoption(parser):
    """Let `make quick` ask for quick tests, `make tests` and `make tests-thorough` for one tier."""
    parser.addoption("--quick", action="store_true", help="only files whose tests were quick when they ran last")
    parser.addoption("--tier", choices=("first", "thorough"), help="only tests without, or with, the mark `thorough`")


def pytest_configure(config):
    """Learn which files are quick, where that can be kept."""
    if hasattr(config, "cache"):
        config.pluginmanager.register(Quick(config))


def pytest_collection_modifyitems(config, items):
    """Leave out the tests of the other tier."""
    if tier := config.getoption("tier"):
        other = [one for one in items if (one.get_closest_marker("thorough") is None) != (tier == "first")]
        config.hook.pytest_deselected(items=other)
        left_out = set(other)
        items[:] = [one for one in items if one not in left_out]


def pytest_collection_finish():
    """Collect no garbage among the tests, which stay as long as the process."""
    gc.freeze()


def forgetting_controllers():
    """Forget afterwards the parts that users register meanwhile: what comes next may run in the same process."""
    before = {kind: dict(registry) for kind, registry in PLUGS.items()}
    yield
    for kind, registry in PLUGS.items():
        for name in [name for name in registry if registry.own(name)]:
            del registry[name]
        registry.update(before[kind])


@pytest.fixture(autouse=True, scope="module")
def _controllers_of_a_module():
    yield from forgetting_controllers()


def free_memory(module):
    """Give back what a module's tests made, and what its functions and those that tests share cached."""
    shared = [one for one in sys.modules.values() if Path(getattr(one, "__file__", None) or "").parent == SUPPORT]
    for one in (module, *shared):
        for value in vars(one).values():
            if hasattr(value, "cache_clear") and value.__module__ == one.__name__:
                value.cache_clear()
            elif isinstance(value, LastUsed):
                value.clear()
    LOOP_CODE.clear()
    GRAPHS.clear()
    if "jax" in sys.modules:
        sys.modules["jax"].clear_caches()
    gc.collect()
    if hasattr(LIBC, "malloc_trim"):
        LIBC.malloc_trim(0)


@pytest.fixture(autouse=True, scope="module")
def _memory_of_a_module(request):
    yield
    free_memory(request.module)


@pytest.fixture(autouse=True)
def _controllers_of_a_test():
    yield from forgetting_controllers()


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run the command line in an empty folder: (exit code, standard output, standard error)."""
    from tandemlift.apps.cli.main import main

    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["tandemlift", *arguments])
        with warnings.catch_warnings(), pytest.raises(SystemExit) as ended:
            main()
        return ended.value.code or 0, *capsys.readouterr()

    return call


@pytest.fixture(scope="session")
def program():
    """Path of a program that may have to be installed as root; without it the test skips by its name."""

    def find(name: str) -> str:
        path = shutil.which(name)
        if path is None:
            pytest.skip(f"{name} is not installed")
        return path

    return find


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    """Turn every skip into a failure where everything that a test may want is said to be installed."""
    outcome = yield
    report = outcome.get_result()
    if report.skipped and os.environ.get("TANDEMLIFT_REQUIRE_ALL") == "1" and not hasattr(report, "wasxfail"):
        report.outcome = "failed"


@pytest.fixture(scope="session")
def jax():
    """JAX in double precision."""
    module = pytest.importorskip("jax")
    module.config.update("jax_enable_x64", True)
    return module


@pytest.fixture(scope="session")
def casadi():
    """CasADi."""
    return pytest.importorskip("casadi")
